"""The stage: which pairs are cut, at which poses, and when not."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from manifold3d import Manifold

from ...articulation import Articulation, Joint
from ...asset import Hull
from ...config import SeparateConfig
from ...mesh import FloatArray
from ..decompose.convex import depth_below, limit_vertices
from ..decompose.decompose import PartHulls
from .clip import PlanedHull, cut_apart, meeting
from .overlap import overlap, part_solids

Pair = tuple[str, str]


@dataclass(frozen=True)
class SeparationRefusal:
    """Why the hulls of two parts were left alone.

    Attributes:
        reason: a sentence with the number in it.
        meshes: True where the parts' own solids are at fault; False where it may be their hulls
            only.
    """

    reason: str
    meshes: bool


@dataclass(frozen=True)
class Separation:
    """What came of cutting.

    Attributes:
        pieces: one per part, in their order.
        refused: pair of part names -> why its hulls were left alone.
        hidden: pair of part names -> how deep the parts themselves overlap at rest [m],
            where that is more than decomposition explains and what is hidden was taken out of the
            collision geometry.
    """

    pieces: tuple[PartHulls, ...]
    refused: Mapping[Pair, SeparationRefusal]
    hidden: Mapping[Pair, float]


def separate(
    articulation: Articulation,
    pieces: tuple[PartHulls, ...],
    pairs: Iterable[Pair],
    config: SeparateConfig,
    max_vertices: int,
) -> Separation:
    """Cut the hulls of some pairs of parts apart.

    Args:
        articulation: whose parts they are.
        pieces: hulls per part, object frame at rest.
        pairs: names of the parts concerned.
        config: clearances, tolerance, and how much may be cut away.
        max_vertices: most corners of a hull; a cut adds some, and those that matter least are left
            out again.
    """
    wanted = sorted({(min(pair), max(pair)) for pair in pairs})
    if not wanted:
        return Separation(pieces, {}, {})
    index = {part.name: number for number, part in enumerate(articulation.parts)}
    solids = part_solids(articulation)
    hulls = [list(piece.hulls) for piece in pieces]
    refused: dict[Pair, SeparationRefusal] = {}
    hidden: dict[Pair, float] = {}
    for pair in wanted:
        a = index[pair[0]]
        b = index[pair[1]]
        poses = _relative_poses(articulation, a, b, config.poses)
        rest, reason = _allowed(solids[a], solids[b], hulls[a], hulls[b], poses, config)
        if reason is None and rest > config.tolerance_m and not _jointed(articulation, a, b):
            reason = (
                f"they overlap by {rest * 1000:.2f} mm at rest and no joint holds one in the other"
            )
        if reason is not None:
            refused[pair] = SeparationRefusal(
                reason, solids[a] is not None and solids[b] is not None
            )
            continue
        reason, hulls[a], hulls[b] = _cut_as_far_as_may_be(pair, hulls[a], hulls[b], poses, config)
        if reason is not None:
            refused[pair] = SeparationRefusal(
                reason,
                rest > config.tolerance_m and solids[a] is not None and solids[b] is not None,
            )
        elif rest > config.tolerance_m:
            hidden[pair] = rest
    after = tuple(
        _with_hulls(piece, tuple(kept), max_vertices)
        for piece, kept in zip(pieces, hulls, strict=True)
    )
    return Separation(after, refused, hidden)


def _jointed(articulation: Articulation, a: int, b: int) -> bool:
    return any({joint.parent, joint.child} == {a, b} for joint in articulation.joints)


def _with_hulls(piece: PartHulls, hulls: tuple[Hull, ...], max_vertices: int) -> PartHulls:
    if len(hulls) == len(piece.hulls) and all(
        a is b for a, b in zip(hulls, piece.hulls, strict=True)
    ):
        return piece
    return replace(
        piece, hulls=tuple(limit_vertices(hull, max_vertices) for hull in hulls), exact=False
    )


def _relative_poses(articulation: Articulation, a: int, b: int, count: int) -> list[FloatArray]:
    """Where part ``b`` is as seen from ``a``, [4, 4] each.

    Closed, as modelled, and along each joint between them.
    """
    lower = {joint.name: joint.lower for joint in articulation.movable_joints}
    values: list[dict[str, float]] = [lower, {}]
    for joint in joints_between(articulation, a, b):
        values += [
            {**lower, joint.name: float(q)}
            for q in np.linspace(joint.lower, joint.upper, count)[1:]
        ]
    relative = []
    for given in values:
        poses = articulation.poses(given)
        relative.append(np.asarray(np.linalg.inv(poses[a]) @ poses[b]))
    return relative


def joints_between(articulation: Articulation, a: int, b: int) -> list[Joint]:
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


def _allowed(
    a: Manifold | None,
    b: Manifold | None,
    hulls_a: list[Hull],
    hulls_b: list[Hull],
    poses: list[FloatArray],
    config: SeparateConfig,
) -> tuple[float, str | None]:
    """How deep two parts overlap at rest [m], and why they may not be cut apart, if so.

    What is hidden at rest may go. What only meets along the way is the joint's fault, and a cut
    would hide it.
    """
    known = a is not None and b is not None
    rest = 0.0
    stride = max(1, (len(poses) - 2) // config.overlap_poses)
    for number, pose in enumerate([*poses[:2], *poses[2::stride], poses[-1]]):
        depth = (
            overlap(a, b, pose).depth_m
            if a is not None and b is not None
            else _hull_depth(hulls_a, hulls_b, pose)
        )
        if number < 2:
            rest = max(rest, depth)
        elif depth > rest + config.tolerance_m:
            what = "meshes" if known else "hulls"
            return rest, (
                f"as the joint moves, their {what} penetrate {(depth - rest) * 1000:.2f} mm deeper "
                f"than at rest; up to {config.tolerance_m * 1000:g} mm may be cut away"
            )
    return rest, None


def _hull_depth(a: list[Hull], b: list[Hull], pose: FloatArray) -> float:
    solids_a: list[PlanedHull | None] = [PlanedHull.of(hull) for hull in a]
    solids_b: list[PlanedHull | None] = [PlanedHull.of(hull) for hull in b]
    depths = [0.0]
    for i, j in _near(solids_a, solids_b, pose, 0.0):
        one = solids_a[i]
        other = solids_b[j]
        if one is not None and other is not None:
            depths.append(meeting(one, other, pose).depth)
    return max(depths)


def _cut_as_far_as_may_be(
    pair: Pair, a: list[Hull], b: list[Hull], poses: list[FloatArray], config: SeparateConfig
) -> tuple[str | None, list[Hull], list[Hull]]:
    """The widest configured clearance that takes little enough; else the reason and given hulls."""
    reason = None
    for clearance_m in config.clearances_m:
        cut_a, cut_b = cut_apart_along(a, b, poses, clearance_m)
        reason = _overdone(pair, (a, b), (cut_a, cut_b), config)
        if reason is None:
            return None, cut_a, cut_b
    return reason, a, b


def cut_apart_along(
    a: list[Hull], b: list[Hull], poses: list[FloatArray], clearance_m: float
) -> tuple[list[Hull], list[Hull]]:
    """Both lists with every pair of hulls cut to the clearance at every pose.

    Args:
        a: hulls of one part, object frame at rest.
        b: hulls of another.
        poses: where the second part is as seen from the first, [4, 4] each.
        clearance_m: to be left between them [m].
    """
    solids_a: list[PlanedHull | None] = [PlanedHull.of(hull) for hull in a]
    solids_b: list[PlanedHull | None] = [PlanedHull.of(hull) for hull in b]
    for pose in poses:
        for i, j in _near(solids_a, solids_b, pose, clearance_m):
            one = solids_a[i]
            other = solids_b[j]
            if one is None or other is None:
                continue
            met = meeting(one, other, pose)
            if met.depth > -clearance_m:
                solids_a[i], solids_b[j] = cut_apart(one, other, pose, met, clearance_m)
    return [solid.hull for solid in solids_a if solid], [solid.hull for solid in solids_b if solid]


def _near(
    a: list[PlanedHull | None], b: list[PlanedHull | None], pose: FloatArray, margin: float
) -> list[tuple[int, int]]:
    """Indices of hulls whose boxes come within ``margin`` [m] of one another."""
    low_a, high_a = _boxes(a, np.eye(4))
    low_b, high_b = _boxes(b, pose)
    apart = (low_a[:, None] > high_b[None] + margin) | (high_a[:, None] < low_b[None] - margin)
    return [(int(i), int(j)) for i, j in np.argwhere(~apart.any(axis=2))]


def _boxes(solids: list[PlanedHull | None], pose: FloatArray) -> tuple[FloatArray, FloatArray]:
    low = np.full((len(solids), 3), np.inf)
    high = np.full((len(solids), 3), -np.inf)
    for number, solid in enumerate(solids):
        if solid is not None:
            points = solid.hull.vertices @ pose[:3, :3].T + pose[:3, 3]
            low[number] = points.min(axis=0)
            high[number] = points.max(axis=0)
    return low, high


def _overdone(
    pair: Pair,
    before: tuple[list[Hull], list[Hull]],
    after: tuple[list[Hull], list[Hull]],
    config: SeparateConfig,
) -> str | None:
    """Why a cut takes too much, or what can be seen; ``None`` if it does neither."""
    for name, old, new, other in zip(pair, before, after, reversed(before), strict=True):
        lost = 1.0 - sum(hull.volume for hull in new) / sum(hull.volume for hull in old)
        if lost > config.most_cut or not new:
            return (
                f"cutting them apart would take {lost:.0%} of {name!r}; "
                f"at most {config.most_cut:.0%} may go"
            )
        bared = _bared(old, new, other, config.visible_m)
        if bared > config.visible_m:
            return (
                f"cutting them apart would take {bared * 1000:.1f} mm off {name!r} that is not "
                "hidden in the other; "
                f"at most {config.visible_m * 1000:g} mm may go"
            )
    return None


def _bared(old: list[Hull], new: list[Hull], other: list[Hull], near_m: float) -> float:
    """Farthest corner of the old hulls from the new ones [m].

    Corners in or beside the other part are not counted.
    """
    corners = np.concatenate([hull.vertices for hull in old])
    outside = -np.max([depth_below(hull, corners) for hull in new], axis=0)
    corners = corners[outside > near_m]
    outside = outside[outside > near_m]
    if not len(corners):
        return 0.0
    hidden = np.max([depth_below(hull, corners) for hull in other], axis=0) > -near_m
    return float(outside[~hidden].max(initial=0.0))
