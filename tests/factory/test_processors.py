"""The same input gives the same files on processors that round sums of products differently."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

LAPTOP = Path(__file__).parents[2] / "examples" / "meshes" / "laptop.glb"
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

pytestmark = [
    pytest.mark.skipif(platform.machine() != "x86_64", reason="the settings are of x86"),
    pytest.mark.skipif(not LAPTOP.exists(), reason="the examples are not there"),
]


def test_two_processors_write_the_same_files(tmp_path: Path) -> None:
    running = {}
    for name, settings in (("old", OLD), ("new", NEW)):
        words = ["build", "--input", str(LAPTOP), "--output", str(tmp_path / name), "--sim", ""]
        command = [sys.executable, "-m", "asset_factory.factory.cli", *words, "--workers", "1"]
        environment = {**os.environ, **settings}
        running[name] = subprocess.Popen(
            command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
    for process in running.values():
        said, _ = process.communicate(timeout=120.0)
        assert process.returncode == 0, said
    old, new = (files_of(tmp_path / name / "assets") for name in ("old", "new"))
    assert sorted(old) == sorted(new)
    assert [name for name in old if old[name] != new[name]] == []
    assert any(name.endswith("asset.urdf") for name in old)


def files_of(root: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(root)): path.read_bytes()
        for path in sorted(root.rglob("*"))
        if path.is_file()
    }
