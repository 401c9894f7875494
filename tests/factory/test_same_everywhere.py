"""Neither a cache, nor threads, nor a busy machine change a verdict, or a byte of an asset."""

import os
import platform
import shutil
import subprocess
import sys
from dataclasses import replace

import numpy as np
from command_line import COMMAND, ran
from repository import MESHES

from asset_factory.factory.build import build_asset
from asset_factory.factory.config import BuildConfig, ReadingsConfig, RepairConfig
from asset_factory.factory.registry import Registry
from asset_factory.factory.runtime.layout import CACHE
from asset_factory.factory.runtime.store import folder_digests
from asset_factory.sim_checks.processes.threads import VARIABLES

#: What numpy would use beyond what every processor has.
DISPATCHED = " ".join(np._core._multiarray_umath.__cpu_dispatch__)
#: OpenBLAS's kernels of two processors ten years apart, and everybody else without what is new.
OLD = {
    "OPENBLAS_CORETYPE": "Prescott",
    "ATEN_CPU_CAPABILITY": "default",
    "NPY_DISABLE_CPU_FEATURES": DISPATCHED,
    "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F,-FMA4",
}
NEW = {"OPENBLAS_CORETYPE": "Haswell"}
if platform.machine() != "x86_64":
    OLD = NEW = {}
CONFIG = BuildConfig(simulators=("mujoco",))
#: The cabinet counts 275 and more a round, and passes after three.
SHRUNKEN = replace(CONFIG, repair=RepairConfig(most_work=300), readings=ReadingsConfig(most_work=0))


def registered(output):
    """Status, reason and the digest of every file of the one entry."""
    registry = Registry(output)
    (entry,) = registry.entries()
    return entry.status, entry.reason, folder_digests(registry.folder(entry))


def test_a_warm_cache_changes_nothing_however_small_the_budgets(tmp_path):
    for name, config in (("full", CONFIG), ("shrunken", SHRUNKEN)):
        build_asset(MESHES / "cabinet.glb", tmp_path / name, config)
    # From its own cache, and from one of somebody who went further.
    for cold, cache, config in (
        ("full", "full", CONFIG),
        ("shrunken", "full", SHRUNKEN),
    ):
        warm = tmp_path / f"{cold} from {cache}"
        shutil.copytree(tmp_path / cache / CACHE, warm / CACHE)
        result = build_asset(MESHES / "cabinet.glb", warm, config)
        assert {"decompose", "finish", "inspect"} & set(result.reused)
        assert registered(warm) == registered(tmp_path / cold)
    assert registered(tmp_path / "full")[0] == "passed"
    assert registered(tmp_path / "shrunken")[0] == "rejected"


def built_with(output, **settings):
    asked = ["--input", MESHES / "laptop.glb", "--output", output, "--quiet", "--no-report"]
    ran(*COMMAND, "build", "--sim", "mujoco", *asked, env={**os.environ, **settings})
    return registered(output)


def test_neither_threads_nor_a_busy_machine_nor_its_processor_change_anything(tmp_path):
    alone = built_with(tmp_path / "alone", **dict.fromkeys(VARIABLES, "1"), **NEW)
    with subprocess.Popen([sys.executable, "-c", "while True: pass"]) as busy:
        try:
            assert built_with(tmp_path / "busy", **dict.fromkeys(VARIABLES, "3"), **OLD) == alone
        finally:
            busy.kill()
    assert alone[0] == "passed"
    assert {"asset.urdf", "asset.xml"} <= set(alone[2])
