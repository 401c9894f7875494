"""What works on this machine: every engine and library tried in a child process, not only found."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import StrEnum
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

from asset_factory.sim_checks.judge import Judge
from asset_factory.sim_checks.processes.isolation import Limits, processors, run_isolated
from asset_factory.sim_checks.simulators.catalog import SIMULATORS, install_line, installed_version

#: Longest that one trial may take [s].
TRIAL_S = 120.0
#: A registry of some hundred assets with their cache [bytes].
ENOUGH_DISK = 5 * 1024**3
#: A drawer in a rail: the least that an engine must be able to move.
SLIDER = """<robot name="slider">
  <link name="rail"><inertial><mass value="1"/>
    <inertia ixx="0.0034" ixy="0" ixz="0" iyy="0.0034" iyz="0" izz="0.0067"/></inertial>
    <collision><geometry><box size="0.2 0.2 0.02"/></geometry></collision></link>
  <link name="drawer"><inertial><mass value="1"/>
    <inertia ixx="0.0017" ixy="0" ixz="0" iyy="0.0017" iyz="0" izz="0.0017"/></inertial>
    <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <joint name="slide" type="prismatic"><parent link="rail"/><child link="drawer"/>
    <origin xyz="0 0 0.07"/><axis xyz="0 -1 0"/>
    <limit lower="0" upper="0.2" effort="100" velocity="1"/>
    <dynamics damping="2" friction="1"/></joint>
</robot>
"""


class Health(StrEnum):
    """How something is: as it should be; not installed; installed, and of no use."""

    WORKS = "works"
    MISSING = "missing"
    BROKEN = "broken"


@dataclass(frozen=True)
class Ability:
    """One thing that this machine can or cannot do.

    Attributes:
        name: what it is.
        serves: what it is for.
        health: how it is.
        detail: version or number, or why not.
        remedy: what would help; empty where nothing need be done.
    """

    name: str
    serves: str
    health: Health
    detail: str
    remedy: str = ""


def abilities(output: Path) -> Iterator[Ability]:
    """Yield everything that a build may need, each tried when it is asked for.

    ``output``, where assets are to go, is there, or a folder above it.
    """
    yield _processors()
    yield _disk(output)
    yield from _engines()
    for library in LIBRARIES:
        yield _tried(library)


@dataclass(frozen=True)
class Library:
    """Something to import and try.

    Attributes:
        name, serves: see :class:`Ability`.
        module: to import.
        trial: runs in a child; says what it found, or raises.
        extra: of ours, that installs it.
        remedy: what helps where it is installed and fails; by default to install it again.
    """

    name: str
    serves: str
    module: str
    trial: Callable[[], str]
    extra: str
    remedy: str = ""


def _processors() -> Ability:
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1024**3
    detail = f"{processors()} processors, {memory:.0f} GiB of memory"
    return Ability("machine", "everything", Health.WORKS, detail)


def _disk(output: Path) -> Ability:
    there = next(path for path in (output.absolute(), *output.absolute().parents) if path.exists())
    free = shutil.disk_usage(there).free
    health = Health.WORKS if os.access(there, os.W_OK) and free >= ENOUGH_DISK else Health.BROKEN
    detail = f"{free / 1024**3:.0f} GiB free in {there}"
    remedy = "" if health is Health.WORKS else "choose another --output, or make room: want 5 GiB"
    return Ability("disk", "assets and the cache", health, detail, remedy)


def _engines() -> Iterator[Ability]:
    with TemporaryDirectory() as folder, Judge() as judge:
        file = Path(folder) / "slider.urdf"
        file.write_text(SLIDER, encoding="utf-8")
        for name in SIMULATORS:
            serves = f"--sim {name}"
            version = installed_version(name)
            if version is None:
                yield Ability(name, serves, Health.MISSING, "not installed", install_line(name))
                continue
            report = judge.check(file, (name,))
            if report.passed:
                yield Ability(name, serves, Health.WORKS, version)
            else:
                why = report.findings[0].message if report.findings else report.status
                remedy = f"reinstall it: {install_line(name)}"
                yield Ability(name, serves, Health.BROKEN, f"{version}: {why}", remedy)


def _tried(library: Library) -> Ability:
    install = f"pip install 'asset-factory[{library.extra}]'"
    if find_spec(library.module) is None:
        return Ability(library.name, library.serves, Health.MISSING, "not installed", install)
    outcome = run_isolated(library.trial, limits=Limits(wall_s=TRIAL_S))
    if outcome.value is not None:
        return Ability(library.name, library.serves, Health.WORKS, outcome.value)
    remedy = library.remedy or f"reinstall it: {install}"
    return Ability(library.name, library.serves, Health.BROKEN, outcome.detail, remedy)


def _coacd() -> str:
    import coacd
    import trimesh

    box = trimesh.creation.box()
    coacd.set_log_level("error")
    hulls = coacd.run_coacd(coacd.Mesh(box.vertices, box.faces))
    return f"a box is {len(hulls)} hull"


def _network() -> str:
    import torch

    from ..config import ParticulateConfig
    from ..models.particulate.device import AUTO, device_for
    from ..models.particulate.loading import load_network

    device = device_for(AUTO)
    load_network(ParticulateConfig(device=device))
    if device == "cpu":
        return f"torch {torch.__version__}; no GPU: builds ask it on the CPU"
    name = torch.cuda.get_device_name() if device == "cuda" else "Apple GPU"
    return f"torch {torch.__version__}; builds ask it on {device}, {name}"


def _vulkan() -> str:
    import sapien

    sapien.render.RenderSystem()
    return "SAPIEN can render"


def _version(module: str) -> str:
    from importlib import import_module

    return str(getattr(import_module(module), "__version__", "installed"))


def _usd() -> str:
    from pxr import Usd

    return ".".join(str(number) for number in Usd.GetVersion()[1:])


_maniskill = partial(_version, "mani_skill")
_DRIVER = "a GPU with its Vulkan driver; tasks that use no camera run without"
LIBRARIES = (
    Library("coacd", "hulls of parts", "coacd", _coacd, "build"),
    Library("network", "parts and joints of meshes", "torch", _network, "particulate"),
    Library("usd", "--formats usd", "pxr", _usd, "usd"),
    Library("maniskill", "tasks over a registry", "mani_skill", _maniskill, "maniskill"),
    Library("rendering", "cameras in ManiSkill tasks", "sapien", _vulkan, "sapien", _DRIVER),
    Library("ray", "--executor ray", "ray", partial(_version, "ray"), "ray"),
)
