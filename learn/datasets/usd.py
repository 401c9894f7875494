"""USD assets with rigid bodies and physics joints, as GRScenes and Lightwheel ship them.

The schema: https://openusd.org/release/api/usd_physics_page_front.html. Geometry and joints are
taken at the authored pose, whatever the physics engine would do with them (gravity, drives).
"""

from __future__ import annotations

import importlib.util
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from asset_factory.factory.articulate.annotated import AnnotatedArticulator
from asset_factory.factory.articulation import Articulation
from asset_factory.factory.errors import ConfigError, InputRejected
from asset_factory.factory.intake.discover import MAIN_LAYERS
from asset_factory.factory.intake.importers.usd import read_annotated
from asset_factory.sim_checks.read.usd.layers import is_usd

from .item import SourceItem, find_items
from .settings import SourceSettings


def find_usd(root: Path) -> tuple[SourceItem, ...]:
    """Return the objects of a folder of folders, or of a folder of files complete in themselves.

    Raises:
        ConfigError: the library that reads USD is not installed.
    """
    if importlib.util.find_spec("pxr") is None:
        raise ConfigError("reading USD needs usd-core: pip install 'asset-factory[train]'")
    return find_items(root, _mains)


def read_usd(item: SourceItem, settings: SourceSettings) -> Articulation:
    """Return one object in metres, z up, lower = closed, bodies held by fixed joints one part.

    Native code reads the file: call it where it may crash.

    Raises:
        InputRejected: ``external_reference``, ``missing_file``, ``too_large``, ``unreadable``,
            ``empty``, ``not_a_tree``, ``unsupported_joint``, ``no_limits``, ``bad_axis``,
            ``no_movable_joint``.
    """
    found = read_annotated(item.main, item.folder, settings.max_bytes, settings.max_faces)
    mesh = found.mesh
    told = (found.annotation, found.frame, np.arange(len(mesh.faces)))
    articulation = AnnotatedArticulator(*told).articulate(mesh)
    if not articulation.movable_joints:
        message = f"{item.name}: nothing moves; want a joint to learn from"
        raise InputRejected("no_movable_joint", message, value=0.0)
    return articulation


def _mains(files: Sequence[Path]) -> list[Path]:
    """Return the file called like its folder first, then the names that asset packs use."""

    def rank(path: Path) -> tuple[bool, int, str]:
        place = (*MAIN_LAYERS, path.stem).index(path.stem)
        return path.stem != path.parent.name, place, path.name

    return sorted((path for path in files if is_usd(path)), key=rank)
