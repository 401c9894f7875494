"""A body and a mover that a joint holds in it, and the two cut apart."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import trimesh
from plain_solids import parted

from asset_factory.factory.articulation import Articulation, Joint
from asset_factory.factory.asset import Hull
from asset_factory.factory.config import SeparateConfig
from asset_factory.factory.manufacture.decompose.convex import hull_of
from asset_factory.factory.manufacture.decompose.pieces import SolidPieces
from asset_factory.factory.manufacture.poses import relative_poses
from asset_factory.factory.manufacture.separate import Separation, separate
from asset_factory.factory.manufacture.separate.along import hull_depth
from asset_factory.factory.mesh import Mesh, concatenate

CONFIG = SeparateConfig()
PAIR = ("body", "mover")
#: Whatever has vertices and faces and is convex.
Solid = Any


def box(low: Sequence[float], high: Sequence[float]) -> trimesh.Trimesh:
    """A box between two corners [m]."""
    return trimesh.creation.box(bounds=[low, high])


def cylinder(radius: float, low: float, high: float, sections: int) -> trimesh.Trimesh:
    """An upright cylinder about the z axis between two heights [m]."""
    made = trimesh.creation.cylinder(radius, high - low, sections=sections)
    return made.apply_translation([0.0, 0.0, (low + high) / 2.0])


def mesh_of(solids: Sequence[Solid]) -> Mesh:
    return concatenate([Mesh.from_triangles(each.vertices, each.faces) for each in solids])


def hulls_of(solids: Sequence[Solid]) -> tuple[Hull, ...]:
    return tuple(hull_of(np.array(each.vertices)) for each in solids)


def held(body: Sequence[Solid], mover: Sequence[Solid], joint: Joint) -> Articulation:
    """The two as parts of one object."""
    return parted({"body": [mesh_of(body)], "mover": [mesh_of(mover)]}, joint)


def cut(
    body: Sequence[Solid], mover: Sequence[Solid], joint: Joint
) -> tuple[Articulation, tuple[SolidPieces, ...], Separation]:
    """The object, its hulls before, and what became of them."""
    tree = held(body, mover, joint)
    before = tuple(SolidPieces(hulls_of(solids), "exact") for solids in (body, mover))
    return tree, before, separate(tree, before, [PAIR], CONFIG, 64)


def cut_free(
    body: Sequence[Solid], mover: Sequence[Solid], joint: Joint, poses: int = 150
) -> tuple[Articulation, tuple[SolidPieces, ...], Separation]:
    """The same of two that afterwards touch nowhere on the way."""
    tree, before, result = cut(body, mover, joint)
    assert result.refused == {}
    assert deepest(tree, result, poses) == 0.0
    return tree, before, result


def require_refused(body: Sequence[Solid], mover: Sequence[Solid], joint: Joint) -> None:
    """The two are left as they are, one in the other: no cut hides that."""
    tree, _, result = cut(body, mover, joint)
    assert PAIR in result.refused
    assert deepest(tree, result) > 0.001


def deepest(
    tree: Articulation, result: Separation, poses: int = 150, gap: float = 0.0, **way: float
) -> float:
    """How deep the two lie in one another anywhere on the way, or nearer than a gap [m]."""
    hulls = [list(piece.hulls) for piece in result.pieces if piece.hulls]
    last = len(result.pieces) - 1
    met = relative_poses(tree, 0, last, poses, **way)
    return max(hull_depth(*hulls, pose, gap) for pose in met)
