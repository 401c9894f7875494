"""A USD asset with physics joints, at its authored pose.

The schema: https://openusd.org/release/api/usd_physics_page_front.html.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from asset_factory.sim_checks.geometry.placing import placed
from asset_factory.sim_checks.processes.isolation import WarmChild
from asset_factory.sim_checks.read.native import ask_of
from asset_factory.sim_checks.read.usd.layers import require_inside
from asset_factory.sim_checks.read.usd.shapes import PhysicsSurface
from asset_factory.sim_checks.read.usd.stage import PhysicsStage, read_stage, require_library

from ...config import IntakeConfig
from ...errors import InputRejected
from ...geometry.clean import clean
from ...geometry.soup import plain_soup
from ...mesh import Mesh
from ..limits import require_at_most
from ..orientation import rotation_to_z_up
from ..reads import ReadLog
from ..rejecting import rejecting
from .imported import Imported
from .usd_tree import hang_pieces

_COLLIDER_WORDS = frozenset({"collision", "collider", "collisions", "colliders"})


def import_usd(path: Path, config: IntakeConfig, log: ReadLog) -> Imported:
    """Return the shown surfaces of an articulated USD asset, its parts and its joints.

    ``path`` is the root layer's; everything that it is composed of lies in or below its folder.

    Raises:
        InputRejected: ``unsupported``: the library that reads USD is not installed, or value clips
            and computed references, whose files cannot be known beforehand;
            ``external_reference``, ``missing_file``, ``too_large``, ``unreadable``, ``empty``,
            ``not_a_tree``, ``unsupported_joint``.
        TimeoutError, ChildProcessError: what reads it hung or was killed, which is no verdict.
    """
    with WarmChild() as child, rejecting(path.name, path.parent, log):
        require_library(path.name)
        layers = ask_of(child, path.name, require_inside, path, path.parent, config.max_bytes)
        digests = tuple(log.digest(layer) for layer in layers)
        stage = ask_of(child, path.name, _read_leniently, path)
    return replace(_imported(stage, path.name, config.max_faces), digests=digests)


def _read_leniently(path: Path) -> PhysicsStage:
    return read_stage(path, lenient=True)


def _imported(stage: PhysicsStage, name: str, max_faces: int) -> Imported:
    pieces = _pieces(stage, name, max_faces)
    if not pieces:
        raise InputRejected("empty", f"{name}: holds no surface that is shown")
    frame = np.eye(4)
    frame[:3, :3] = stage.metres * rotation_to_z_up(stage.up)
    return hang_pieces(stage, pieces, frame, name)


def _pieces(stage: PhysicsStage, name: str, max_faces: int) -> list[tuple[str, Mesh]]:
    """Return body and shown surface [m], z up; of a body that has others, not its colliders."""
    found: list[tuple[str, bool, Mesh]] = []
    faces = 0
    for surface in stage.surfaces:
        vertices = placed(surface.vertices, stage.bodies[surface.body].pose)
        try:
            mesh = clean(plain_soup(vertices[surface.faces]), surface.name).mesh
        except InputRejected as error:
            if error.code in ("empty", "zero_size"):
                continue
            raise
        faces += len(mesh.faces)
        require_at_most(name, faces, max_faces, "faces")
        found.append((surface.body, _is_collider(surface), mesh))
    seen = {body for body, collider, _ in found if not collider}
    return [(body, mesh) for body, collider, mesh in found if not collider or body not in seen]


def _is_collider(surface: PhysicsSurface) -> bool:
    """Return whether a surface lies in a group called after collisions, or is called so itself."""
    words = surface.path.lower().replace("/", "_").split("_")
    return not _COLLIDER_WORDS.isdisjoint(words)
