"""Input file -> Intake: a plain mesh, or a description whose parts and joints come with it."""

from __future__ import annotations

from pathlib import Path

from asset_factory.sim_checks.read.usd.layers import SUFFIXES as USD_SUFFIXES
from asset_factory.sim_checks.read.xacro import SUFFIX as XACRO

from ..config import IntakeConfig
from ..runtime.keys import Stage
from .importers.load import load_description
from .intake import Intake
from .loading import load_mesh
from .reads import ReadLog

LOAD = Stage(
    "load",
    code=(__name__,),
    settings=("intake",),
    libraries=("numpy", "scipy", "trimesh", "manifold3d", "pillow", "mujoco", "xacro"),
    data=("categories.toml",),
)
DESCRIPTION_SUFFIXES = frozenset({".urdf", ".xml", XACRO}) | USD_SUFFIXES


def load(path: Path, config: IntakeConfig, log: ReadLog | None = None) -> Intake:
    """Load a mesh file, a URDF, also as xacro, an MJCF or a USD layer.

    ``log`` of the files that are read is filled also where it raises.

    Raises:
        InputRejected: with a reason code.
    """
    if path.suffix.lower() in DESCRIPTION_SUFFIXES:
        return load_description(path, config, log)
    return load_mesh(path, config, log)
