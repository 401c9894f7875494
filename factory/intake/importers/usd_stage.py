"""What a USD stage says of surfaces, rigid bodies and joints, in its frame, units and pose."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from asset_factory.sim_checks.read.native import READER_BYTES, memory_bounded
from asset_factory.sim_checks.read.usd.prims import (
    is_joint_in_use,
    is_rigid_body,
    is_shown,
    list_prims,
)

from ...mesh import Mesh
from ..limits import require_at_most, unreadable
from .usd_joints import BodyFrames, UsdJoint, joint_of
from .usd_layers import rejecting
from .usd_meshes import mesh_of

STATIC = ""
"""Stands for everything that is no rigid body, the world included, among body paths."""
_COLLIDER_WORDS = ("collision", "collider", "collisions", "colliders")


@dataclass(frozen=True)
class UsdStage:
    """A stage, read.

    Attributes:
        pieces: body and surface, stage frame and units, in the order of the stage.
        joints: between bodies.
        roots: bodies that an articulation begins with.
        metres: per unit.
        up: axis, ``y`` or ``z``.
    """

    pieces: tuple[tuple[str, Mesh], ...]
    joints: tuple[UsdJoint, ...]
    roots: frozenset[str]
    metres: float
    up: str


def read_stage(path: Path, max_faces: int) -> UsdStage:
    """Compose a stage and read it, in a killable child; see :func:`require_own_layers` before.

    Args:
        path: of the root layer.
        max_faces: most triangles.

    Raises:
        InputRejected: ``unreadable``, ``too_large``, ``unsupported_joint``, whatever its library
            raises.
    """
    with rejecting(path), memory_bounded(READER_BYTES):
        return _composed(path, max_faces)


def _composed(path: Path, max_faces: int) -> UsdStage:
    from pxr import Usd, UsdGeom, UsdPhysics

    stage = Usd.Stage.Open(str(path.resolve()))
    metres = float(UsdGeom.GetStageMetersPerUnit(stage))
    if not 0.0 < metres < float("inf"):
        raise unreadable(path.name, f"metersPerUnit is {metres}, want a positive number")
    prims = list_prims(stage, path.name)
    joints = [prim for prim in prims if is_joint_in_use(prim)]
    bodies = _Bodies(prims, joints)
    frames = BodyFrames(stage, UsdGeom.XformCache(), bodies.of)
    return UsdStage(
        pieces=_pieces(prims, bodies, path.name, max_faces),
        joints=tuple(joint_of(prim, frames) for prim in joints),
        roots=frozenset(
            bodies.of(prim)
            for prim in prims
            if prim.HasAPI(UsdPhysics.ArticulationRootAPI) and prim not in joints
        )
        - {STATIC},
        metres=metres,
        up=str(UsdGeom.GetStageUpAxis(stage)).lower(),
    )


class _Bodies:
    """Which rigid body a prim belongs to: the nearest one above it, itself included.

    Where no prim at all is called a rigid body, what the joints hold is taken for bodies.
    """

    def __init__(self, prims: list[Any], joints: list[Any]) -> None:
        from pxr import UsdPhysics

        rigid = {str(prim.GetPath()) for prim in prims if is_rigid_body(prim)}
        if not rigid:
            ends = (UsdPhysics.Joint(prim) for prim in joints)
            rels = (rel for joint in ends for rel in (joint.GetBody0Rel(), joint.GetBody1Rel()))
            rigid = {str(target) for rel in rels for target in rel.GetForwardedTargets()} - {"/"}
        self._rigid = rigid

    def of(self, prim: Any) -> str:
        """Return the path of its body, or ``STATIC``."""
        path = prim.GetPath()
        while not path.isEmpty and str(path) != "/":
            if str(path) in self._rigid:
                return str(path)
            path = path.GetParentPath()
        return STATIC


def _pieces(
    prims: list[Any], bodies: _Bodies, file: str, max_faces: int
) -> tuple[tuple[str, Mesh], ...]:
    """Return the surfaces that are shown; of a body that has others, not its colliders."""
    from pxr import UsdGeom

    cache = UsdGeom.XformCache()
    found: list[tuple[str, bool, Mesh]] = []
    faces = 0
    for prim in prims:
        if not prim.IsA(UsdGeom.Gprim) or not is_shown(prim):
            continue
        mesh = mesh_of(prim, cache)
        if mesh is not None:
            faces += len(mesh.faces)
            require_at_most(file, faces, max_faces, "faces")
            found.append((bodies.of(prim), _is_collider(prim), mesh))
    seen = {body for body, collider, _ in found if not collider}
    return tuple((body, mesh) for body, collider, mesh in found if not collider or body not in seen)


def _is_collider(prim: Any) -> bool:
    """Return whether a surface lies in a group called after collisions, or is called so itself."""
    return any(
        word in _COLLIDER_WORDS
        for name in str(prim.GetPath()).lower().split("/")
        for word in name.split("_")
    )
