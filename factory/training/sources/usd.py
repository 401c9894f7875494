"""USD assets with rigid bodies and physics joints, as GRScenes and Lightwheel ship them.

The schema: https://openusd.org/release/api/usd_physics_page_front.html. Geometry and joints are
taken at the authored pose; what the physics engine would do with them afterwards (gravity, drives)
does not matter here.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...articulate.annotated import AnnotatedArticulator
from ...articulation import Articulation
from ...errors import ConfigError, InputRejected
from ...intake.importers.usd_layers import SUFFIXES, require_own_layers
from ...intake.importers.usd_stage import read_stage
from ...intake.importers.usd_tree import annotation_of
from ...intake.limits import require_at_most
from ...intake.orientation import rotation_to_z_up
from ...mesh import concatenate
from .categories import categories_of
from .item import SourceItem, find_items
from .settings import SourceSettings


def find_usd(root: Path) -> tuple[SourceItem, ...]:
    """The objects of a folder of folders, or of a folder of files complete in themselves.

    Raises:
        ConfigError: the library that reads USD is not installed.
    """
    if importlib.util.find_spec("pxr") is None:
        raise ConfigError("reading USD needs usd-core: pip install 'asset-factory[train]'")
    return find_items(root, _mains, categories_of(root))


def read_usd(item: SourceItem, settings: SourceSettings) -> Articulation:
    """One object in metres, z up, lower = closed, bodies held by fixed joints one part.

    Native code reads the file: call it where it may crash.

    Raises:
        InputRejected: ``external_reference``, ``missing_file``, ``too_large``, ``unreadable``,
            ``empty``, ``not_a_tree``, ``unsupported_joint``, ``no_limits``, ``bad_axis``,
            ``no_movable_joint``.
    """
    require_own_layers(item.main, item.folder, settings.max_bytes)
    stage = read_stage(item.main, settings.max_faces)
    if not stage.pieces:
        raise InputRejected("empty", f"{item.main.name}: holds no surface that is shown")
    whole = concatenate([mesh for _, mesh in stage.pieces])
    require_at_most(item.main.name, len(whole.faces), settings.max_faces, "faces")
    transform = np.eye(4)
    transform[:3, :3] = stage.metres * rotation_to_z_up(stage.up)
    annotation = annotation_of(stage, item.main.name)
    articulator = AnnotatedArticulator(annotation, transform, np.arange(len(whole.faces)))
    articulation = articulator.articulate(whole.transformed(transform))
    if not articulation.movable_joints:
        raise InputRejected(
            "no_movable_joint", f"{item.name}: nothing moves; want a joint to learn from", value=0.0
        )
    return articulation


def _mains(files: Sequence[Path]) -> list[Path]:
    """The file called like its folder first, then the names that asset packs use."""
    usual = ("instance", "model", "asset")

    def rank(path: Path) -> tuple[bool, int, str]:
        return (
            path.stem != path.parent.name,
            usual.index(path.stem) if path.stem in usual else len(usual),
            path.name,
        )

    return sorted((path for path in files if path.suffix.lower() in SUFFIXES), key=rank)
