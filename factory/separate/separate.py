"""The stage: which pairs are cut, at which poses, and when not."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from manifold3d import Manifold

from ..articulation import Articulation, Joint
from ..asset import Hull
from ..config import SeparateConfig
from ..decompose.decompose import PartHulls
from ..mesh.mesh import FloatArray
from .clip import Solid, clipped, meeting
from .overlap import overlap, part_solids

Pair = tuple[str, str]


@dataclass(frozen=True)
class Separation:
    """What came of cutting.

    Attributes:
        pieces: one per part, in their order.
        refused: pair of part names -> why its hulls were left alone, with the number.
    """

    pieces: tuple[PartHulls, ...]
    refused: Mapping[Pair, str]


def separate(
    articulation: Articulation, pieces: tuple[PartHulls, ...], pairs: Iterable[Pair], config: SeparateConfig
) -> Separation:
    """Cut the hulls of some pairs of parts apart.

    Args:
        articulation: whose parts they are.
        pieces: hulls per part, object frame at rest.
        pairs: names of the parts concerned.
        config: clearances, tolerance, and how much may be cut away.
    """
    wanted = sorted({(min(pair), max(pair)) for pair in pairs})
    if not wanted:
        return Separation(pieces, {})
    index = {part.name: number for number, part in enumerate(articulation.parts)}
    solids = part_solids(articulation)
    hulls = [list(piece.hulls) for piece in pieces]
    refused: dict[Pair, str] = {}
    for pair in wanted:
        a, b = index[pair[0]], index[pair[1]]
        poses = _relative_poses(articulation, a, b, config.poses)
        reason = _real_overlap(solids[a], solids[b], poses, config)
        if reason is None:
            known = solids[a] is not None and solids[b] is not None
            reason, hulls[a], hulls[b] = _cut_as_far_as_may_be(pair, hulls[a], hulls[b], poses, known, config)
        if reason is not None:
            refused[pair] = reason
    after = tuple(_with_hulls(piece, tuple(kept)) for piece, kept in zip(pieces, hulls, strict=True))
    return Separation(after, refused)


def _with_hulls(piece: PartHulls, hulls: tuple[Hull, ...]) -> PartHulls:
    untouched = len(hulls) == len(piece.hulls) and all(a is b for a, b in zip(hulls, piece.hulls, strict=True))
    return piece if untouched else replace(piece, hulls=hulls, exact=False)


def _relative_poses(articulation: Articulation, a: int, b: int, count: int) -> list[FloatArray]:
    """Where part ``b`` is as seen from ``a``, [4, 4] each: closed, as modelled, and along each joint between them."""
    lower = {joint.name: joint.lower for joint in articulation.movable_joints}
    values: list[dict[str, float]] = [lower, {}]
    for joint in _joints_between(articulation, a, b):
        values += [{**lower, joint.name: float(q)} for q in np.linspace(joint.lower, joint.upper, count)[1:]]
    relative = []
    for given in values:
        poses = articulation.poses(given)
        relative.append(np.asarray(np.linalg.inv(poses[a]) @ poses[b]))
    return relative


def _joints_between(articulation: Articulation, a: int, b: int) -> list[Joint]:
    """The joints that move one of two parts and not the other."""

    def above(part: int) -> set[str]:
        names: set[str] = set()
        joint = articulation.parent_joint(part)
        while joint is not None:
            names.add(joint.name)
            joint = articulation.parent_joint(joint.parent)
        return names

    between = above(a) ^ above(b)
    return [joint for joint in articulation.movable_joints if joint.name in between]


def _real_overlap(
    a: Manifold | None, b: Manifold | None, poses: list[FloatArray], config: SeparateConfig
) -> str | None:
    """Why the meshes themselves forbid a cut; ``None`` if they do not, or cannot say."""
    if a is None or b is None:
        return None
    stride = max(1, (len(poses) - 2) // config.overlap_poses)
    for number, pose in enumerate([*poses[:2], *poses[2::stride], poses[-1]]):
        found = overlap(a, b, pose)
        if found.depth_m > config.tolerance_m:
            when = "with the joints at rest" if number < 2 else "along the joint"
            return (
                f"their meshes overlap by {found.depth_m * 1000:.2f} mm {when} ({found.volume_m3 * 1e6:.3g} cm3); "
                f"hulls are cut apart up to {config.tolerance_m * 1000:g} mm"
            )
    return None


def _cut_as_far_as_may_be(
    pair: Pair, a: list[Hull], b: list[Hull], poses: list[FloatArray], known: bool, config: SeparateConfig
) -> tuple[str | None, list[Hull], list[Hull]]:
    """The widest of the configured clearances that does not take too much; else the reason, and the hulls as given."""
    reason = None
    for clearance_m in config.clearances_m:
        cut_a, cut_b, deepest = _cut_apart(a, b, poses, clearance_m)
        if not known and deepest > config.tolerance_m:
            reason = (
                f"their hulls meet {deepest * 1000:.2f} mm deep and a mesh with open surfaces cannot say whether "
                f"they may; they are cut apart up to {config.tolerance_m * 1000:g} mm"
            )
            break
        reason = _overdone(pair, (a, b), (cut_a, cut_b), config)
        if reason is None:
            return None, cut_a, cut_b
    return reason, a, b


def _cut_apart(
    a: list[Hull], b: list[Hull], poses: list[FloatArray], clearance_m: float
) -> tuple[list[Hull], list[Hull], float]:
    """Both lists with every hull pair cut to the clearance at every pose, and the deepest meeting [m]."""
    solids_a: list[Solid | None] = [Solid.of(hull) for hull in a]
    solids_b: list[Solid | None] = [Solid.of(hull) for hull in b]
    deepest = 0.0
    for pose in poses:
        for i, j in _near(solids_a, solids_b, pose, clearance_m):
            one, other = solids_a[i], solids_b[j]
            if one is None or other is None:
                continue
            met = meeting(one, other, pose)
            if met.reach <= -clearance_m:
                continue
            deepest = max(deepest, met.reach)
            # Half from each: neither board loses more than it must.
            middle = (met.first_end + met.second_start) / 2.0
            half = clearance_m / 2.0
            solids_a[i] = _resolid(one, met.direction, middle - half)
            back = met.direction @ pose[:3, :3]
            start = middle + half - float(met.direction @ pose[:3, 3])
            solids_b[j] = _resolid(other, -back, -start)
    return [s.hull for s in solids_a if s], [s.hull for s in solids_b if s], deepest


def _resolid(solid: Solid, normal: FloatArray, offset: float) -> Solid | None:
    left = clipped(solid.hull, normal, offset)
    if left is solid.hull:
        return solid
    return None if left is None else Solid.of(left)


def _near(a: list[Solid | None], b: list[Solid | None], pose: FloatArray, margin: float) -> list[tuple[int, int]]:
    """Indices of hulls whose boxes come within ``margin`` [m] of one another."""
    low_a, high_a = _boxes(a, np.eye(4))
    low_b, high_b = _boxes(b, pose)
    apart = (low_a[:, None] > high_b[None] + margin) | (high_a[:, None] < low_b[None] - margin)
    return [(int(i), int(j)) for i, j in np.argwhere(~apart.any(axis=2))]


def _boxes(solids: list[Solid | None], pose: FloatArray) -> tuple[FloatArray, FloatArray]:
    low, high = np.full((len(solids), 3), np.inf), np.full((len(solids), 3), -np.inf)
    for number, solid in enumerate(solids):
        if solid is not None:
            points = solid.hull.vertices @ pose[:3, :3].T + pose[:3, 3]
            low[number], high[number] = points.min(axis=0), points.max(axis=0)
    return low, high


def _overdone(
    pair: Pair, before: tuple[list[Hull], list[Hull]], after: tuple[list[Hull], list[Hull]], config: SeparateConfig
) -> str | None:
    """Why a cut takes too much; ``None`` if it does not."""
    for name, old, new in zip(pair, before, after, strict=True):
        volume = sum(hull.volume for hull in old)
        lost = 1.0 - sum(hull.volume for hull in new) / volume
        if lost > config.most_cut or not new:
            return f"cutting them apart would take {lost:.0%} of {name!r}; at most {config.most_cut:.0%} may go"
    return None
