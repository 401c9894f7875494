"""Which engines there are, by name, without importing any of them."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from importlib.metadata import PackageNotFoundError, version
from types import MappingProxyType

from .mujoco_backend import MujocoSimulator
from .newton_backend import NewtonSimulator
from .pybullet_backend import PybulletSimulator
from .sapien_backend import SapienSimulator
from .simulator import Simulator

_ENGINES = (SapienSimulator, MujocoSimulator, PybulletSimulator, NewtonSimulator)
SIMULATORS: Mapping[str, Simulator] = MappingProxyType({each.name: each() for each in _ENGINES})
"""Every engine, in the order in which they are asked."""
USUAL = ("sapien", "mujoco", "pybullet")
"""Those that ``all`` means; others are asked by name."""


def simulator(name: str) -> Simulator:
    """Return the engine of this name.

    Raises:
        ValueError: naming those that exist, and the nearest.
    """
    if name in SIMULATORS:
        return SIMULATORS[name]
    near = difflib.get_close_matches(name, SIMULATORS, n=1)
    hint = f"; did you mean {near[0]!r}?" if near else ""
    raise ValueError(f"no simulator {name!r}, there are {', '.join(SIMULATORS)}{hint}")


def installed(name: str) -> bool:
    """Return whether the engine's package is installed, without importing it."""
    return installed_version(name) is not None


def installed_version(name: str) -> str | None:
    """Return the installed engine's version, without importing it; ``None`` if not installed."""
    try:
        return version(simulator(name).distribution)
    except PackageNotFoundError:
        return None


def install_line(name: str) -> str:
    """Return the command that installs the engine."""
    return f"pip install 'asset-factory[{simulator(name).name}]'"
