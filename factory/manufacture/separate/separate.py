"""The stage: which pairs are cut, how far that may go, and when not."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property, partial

import numpy as np
from manifold3d import Manifold

from ...articulation import Articulation, Joint
from ...asset import Hull
from ...config import SeparateConfig
from ...mesh import FloatArray
from ..decompose.decompose import PartHulls
from ..hinges import is_crooked
from ..poses import held_by, jointed, joints_between, relative_poses
from .along import carved_apart_along, cut_apart_along, hull_depth
from .between import Cut, Sides, cut_between, poses_between
from .budget import CutLimits, Excuse, Loss, SeenSurface, loss, overdone, too_bare
from .clip import SHEET_M
from .hung import HUB_SHARE, ROUND_SHARE, at_an_edge, planed_limit, seat_roundness, well_hung
from .outcome import Pair, Planed, Separation, SeparationRefusal
from .overlap import overlap, part_solids, thickness_m
from .pits import TURNED_ROOM, Pit, stands_out_m, swept_share
from .rejoin import with_hulls
from .turned import Turned

#: Hulls that get so much deeper along a joint are in each other's way, however fat they are [m].
HOPELESS_M = 0.06
#: A slide no longer than this is a button, which is pressed into what it stands on [m].
PRESSED_M = 0.012
#: A part of whose surface a cut would bare more than this is kept whole in a socket, of so many
#: pieces more at most, and so little of what is seen around it, as deep as what may be planed or
#: this share of the part's diagonal: a toaster of four metres has a slot as large.
SOCKET_SHARE = 0.05
SOCKET_PIECES = 24
SOCKET_RIM = 0.01
SOCKET_DEEP = 0.01
#: What is nearer than the clearance by less is so by rounding [m].
ROUNDING_M = 1e-5


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
        config: clearance, tolerance, and how much may be cut away.
        max_vertices: most corners of a hull; a cut adds some, and those that matter least are left
            out again.
    """
    wanted = sorted({(min(pair), max(pair)) for pair in pairs})
    if not wanted:
        return Separation(pieces)
    bench = _Bench(articulation, [list(piece.hulls) for piece in pieces], config)
    for pair in wanted:
        bench.cut(pair)
    # A sheet between two others that made way for the second may have come too near to the first.
    for pair in filter(bench.nears, wanted):
        bench.cut(pair)
    after = tuple(
        with_hulls(piece, kept, max_vertices)
        for piece, kept in zip(pieces, bench.hulls, strict=True)
    )
    return Separation(after, bench.refused, bench.hidden, bench.planed)


@dataclass
class _Bench:
    """The parts that are worked on, and what was done.

    Attributes:
        articulation: whose parts they are.
        hulls: of each part; a cut replaces those of two.
        config: how far a cut may go.
        refused, hidden, planed: as in :class:`Separation`.
    """

    articulation: Articulation
    hulls: list[list[Hull]]
    config: SeparateConfig
    refused: dict[Pair, SeparationRefusal] = field(default_factory=dict)
    hidden: dict[Pair, float] = field(default_factory=dict)
    planed: dict[Pair, tuple[Planed, ...]] = field(default_factory=dict)

    @cached_property
    def solids(self) -> tuple[Manifold | None, ...]:
        """Return each part as one solid; ``None`` if its surfaces enclose nothing."""
        return part_solids(self.articulation)

    @cached_property
    def surfaces(self) -> tuple[SeenSurface | None, ...]:
        """Return what is seen of each part; ``None`` of a carrier."""
        return tuple(
            SeenSurface.of(self.articulation.part_mesh(index)) if len(part.faces) else None
            for index, part in enumerate(self.articulation.parts)
        )

    def cut(self, pair: Pair) -> None:
        """Cut two parts apart on all of their way, else at rest, if that takes no more than may."""
        a, b = (self._index(name) for name in pair)
        poses = relative_poses(self.articulation, a, b, self.config.poses)
        at_rest, reason = self._deepening(a, b, poses)
        if reason is None:
            reason = self._cut_along(pair, poses, cut_apart_along)
            for cut_otherwise in self._finer_cuts(a, b, at_rest):
                if reason is not None:
                    reason = self._cut_along(pair, poses, cut_otherwise)
            if reason is not None and self._pressed(a, b) > 0.0:
                dug = self._cut_along(pair, poses, self._carved_by_share(a, b))
                reason = None if dug is None else reason
            if reason is not None and self._dug(pair, poses):
                reason = None
        cut = reason is None

        if reason is not None:
            # What is in the way along it is for the judge to see, and for other repairs.
            cut = self._cut_along(pair, poses[:2], cut_apart_along) is None
            hidden = at_rest > self.config.tolerance_m
            if hidden and not jointed(self.articulation, a, b):
                reason = (
                    f"they overlap by {at_rest * 1000:.2f} mm at rest and no joint holds one in "
                    f"the other; {reason}"
                )
            known = self.solids[a] is not None and self.solids[b] is not None
            self.refused[pair] = SeparationRefusal(reason, known and hidden, cut)
        if cut and at_rest > self.config.tolerance_m:
            self.hidden[pair] = at_rest

    def nears(self, pair: Pair) -> bool:
        """Return whether two parts that were cut apart are nearer at rest than they may be."""
        if pair in self.refused:
            return False
        a, b = (self._index(name) for name in pair)
        least = self.config.clearance_m
        poses = relative_poses(self.articulation, a, b, 1)
        hulls = self.hulls[a], self.hulls[b]
        return max(hull_depth(*hulls, pose, least) for pose in poses) > ROUNDING_M - least

    def _finer_cuts(self, a: int, b: int, at_rest: float) -> list[Cut]:
        """What takes less than planes of parts that a joint connects, ``at_rest`` [m] deep."""
        if not jointed(self.articulation, a, b):
            return []
        between = joints_between(self.articulation, a, b)
        straight = not any(is_crooked(joint.axis) for joint in between)
        deep = straight and at_rest > self.config.tolerance_m
        share = HUB_SHARE if deep else ROUND_SHARE
        seated = [joint for joint in between if self._seat_roundness(joint) > share]
        return [*map(Turned, seated[:1]), carved_apart_along]

    def _seat_roundness(self, joint: Joint) -> float:
        surface = self.surfaces[joint.child]
        if not joint.turns or surface is None:
            return 0.0
        near = self.config.clearance_m
        return seat_roundness(surface, joint, self._holding(joint), near)

    def _holding(self, joint: Joint) -> list[Hull]:
        """Return the hulls of what holds the part that a joint moves."""
        holder = held_by(self.articulation, joint.child)
        return [] if holder is None else self.hulls[holder]

    def _carved_by_share(self, a: int, b: int) -> Cut:
        """Carving that takes as small a share of either part as can be: a pit behind a button."""
        whole_a, whole_b = (sum(h.volume for h in self.hulls[part]) for part in (a, b))
        return partial(carved_apart_along, whole=(whole_a, whole_b))

    def _dug(self, pair: Pair, poses: list[FloatArray]) -> bool:
        """Dig a pit, if that takes no more than may."""
        a, b = map(self._index, pair)
        pits = self._pits(a, b, poses)
        most = self.config.planed_volume
        return any(self._cut_along(pair, poses, pit, most) is None for pit in pits)

    def _goes_in_flush(self, spare: float) -> bool:
        """Whether a slide goes into something, and no deeper than it stands out of it [m]."""
        return -self.config.tolerance_m <= spare < np.inf

    def _pits(self, a: int, b: int, poses: list[FloatArray]) -> list[Pit]:
        """Pits for what turns in its own place, or slides no deeper than it stands out."""
        between = joints_between(self.articulation, a, b)
        if not jointed(self.articulation, a, b) or not self._well_hung(between):
            return []
        holder = self._holder(a, b)
        way = poses if holder == 0 else [np.asarray(np.linalg.inv(pose)) for pose in poses]
        turns = any(joint.turns for joint in between)
        if turns and swept_share(*self._sides(a, b), way) > TURNED_ROOM:
            return []
        if not all(map(self._goes_in_flush, self._standing_out(a, b))):
            return []
        return [Pit(holder, at_once) for at_once in (True, False)]

    def _holder(self, a: int, b: int) -> int:
        """Return which of two parts holds the other, 0 for the first."""
        return 0 if held_by(self.articulation, b) == a else 1

    def _sides(self, a: int, b: int) -> tuple[list[Hull], list[Hull]]:
        """Return the hulls of the one that holds, and those of the other."""
        hulls = (self.hulls[a], self.hulls[b])
        return hulls if self._holder(a, b) == 0 else (hulls[1], hulls[0])

    def _standing_out(self, a: int, b: int) -> list[float]:
        """See :func:`stands_out_m`, for each slide between two parts."""
        slides = [joint for joint in joints_between(self.articulation, a, b) if not joint.turns]
        return [stands_out_m(*self._sides(a, b), joint) for joint in slides]

    def _cut_along(
        self, pair: Pair, poses: list[FloatArray], cut: Cut, most: float | None = None
    ) -> str | None:
        """Cut, or why not; ``most`` is the largest share of either part, where it is less."""
        a, b = map(self._index, pair)
        before = self.hulls[a], self.hulls[b]
        after = cut(*before, poses, self.config.clearance_m)
        losses = self._losses(a, b, before, after)
        reason = self._overdone(a, b, losses, most)
        between = self._between(a, b) if reason is None and len(poses) > 2 else []
        closely = partial(cut, clearance_m=self.config.clearance_m)
        closer = cut_between(closely, before, after, poses, between)
        if closer is not None:
            after = closer
            losses = self._losses(a, b, before, after)
            reason = self._overdone(a, b, losses, most)
        if reason is not None:
            return reason
        if max(each.bare_area for each in losses) > SOCKET_SHARE and jointed(
            self.articulation, a, b
        ):
            after, losses = self._socketed(a, b, poses, (after, losses))
        reason = too_bare(pair, losses, self.config)
        if reason is not None:
            return reason
        self.hulls[a], self.hulls[b] = after
        planed = tuple(
            Planed(name, each.deepest_m, each.share, each.area)
            for name, each in zip(pair, losses, strict=True)
            if each.deepest_m > self.config.visible_m
        )
        if planed:
            self.planed[pair] = planed
        return None

    def _between(self, a: int, b: int) -> list[FloatArray]:
        """See :func:`poses_between`."""
        mover = self.surfaces[b if self._holder(a, b) == 0 else a]
        if mover is None or not jointed(self.articulation, a, b):
            return []
        return poses_between(self.articulation, (a, b), mover, self.config.poses)

    def _socketed(
        self, a: int, b: int, poses: list[FloatArray], planed: tuple[Sides, list[Loss]]
    ) -> tuple[Sides, list[Loss]]:
        """A stem kept whole in a socket where planes would take it off, if that takes few pieces.

        Planes had little enough to take for the joint to be sound; of what the socket takes only
        its rim is looked at.
        """
        before = self.hulls[a], self.hulls[b]
        round_one = Pit(self._holder(a, b), at_once=True)
        for cut in (self._carved_by_share(a, b), round_one):
            after = cut(*before, poses, self.config.clearance_m)
            losses = self._losses(a, b, before, after)
            if sum(map(len, after)) - sum(map(len, before)) > SOCKET_PIECES:
                continue
            if all(self._is_a_rim(part, each) for part, each in zip((a, b), losses, strict=True)):
                return after, losses
        return planed

    def _is_a_rim(self, part: int, lost: Loss) -> bool:
        """Return whether no more than the rim of a socket was taken of what is seen of a part."""
        surface = self.surfaces[part]
        deep = SOCKET_DEEP * surface.diagonal if surface else 0.0
        return (
            lost.bare_area <= SOCKET_SHARE
            and lost.area <= SOCKET_RIM
            and lost.deepest_m <= max(self.config.planed_m, deep)
        )

    def _index(self, name: str) -> int:
        return next(i for i, part in enumerate(self.articulation.parts) if part.name == name)

    def _limit(self, a: int, b: int) -> float:
        """Return how much may be planed off two parts [m].

        A share of what their hinge holds, or of the lesser one.
        """
        hinged = [joint.child for joint in self._hinges(a, b)]
        sizes = [surface.diagonal for i in hinged or (a, b) if (surface := self.surfaces[i])]
        return planed_limit(self.config, min(sizes, default=0.0))

    def _hinges(self, a: int, b: int) -> list[Joint]:
        """Return the joints at an edge of what they turn, the one against the other part."""
        turning = [joint for joint in joints_between(self.articulation, a, b) if joint.turns]
        # What a crooked hinge needs is not planed off: its axis is to be mended.
        if any(is_crooked(joint.axis) for joint in turning):
            return []
        return [
            joint for joint in turning if at_an_edge(self.surfaces[joint.child], joint, self.config)
        ]

    def _deepening(self, a: int, b: int, poses: list[FloatArray]) -> tuple[float, str | None]:
        """Return how deep two parts overlap at rest [m], and why they may not be cut apart, if so.

        What is hidden at rest may go, and what a hinge's own edge needs to turn. What else only
        meets along the way is the joint's fault, and a cut would hide it.
        """
        one = self.solids[a]
        other = self.solids[b]
        limit = self._limit(a, b) if self._hinges(a, b) else self.config.tolerance_m
        limit = max(limit, self._free_limit(a, b) - self.config.clearance_m, self._pressed(a, b))
        what = "meshes"
        if one is None or other is None:
            what = "hulls"
            # Hulls say little of parts; only of what no joint holds, and far beyond all doubt.
            limit = np.inf if jointed(self.articulation, a, b) else HOPELESS_M

        def depth(pose: FloatArray) -> float:
            if one is None or other is None:
                return hull_depth(self.hulls[a], self.hulls[b], pose)
            return overlap(one, other, pose).depth_m

        rest = max(depth(pose) for pose in poses[:2])
        stride = max(1, (len(poses) - 2) // self.config.overlap_poses)
        for pose in [*poses[2::stride], poses[-1]] if limit < np.inf else []:
            deeper = depth(pose) - rest
            if deeper > limit:
                return rest, (
                    f"as the joint moves, their {what} penetrate {deeper * 1000:.2f} mm deeper "
                    f"than at rest; up to {limit * 1000:g} mm may be cut away"
                )
        return rest, None

    def _losses(
        self,
        a: int,
        b: int,
        before: tuple[list[Hull], list[Hull]],
        after: tuple[list[Hull], list[Hull]],
    ) -> list[Loss]:
        held = jointed(self.articulation, a, b)
        losses = []
        for part, old, new, other in zip((a, b), before, after, reversed(before), strict=True):
            surface = self.surfaces[part]
            if surface is not None:
                excuse = Excuse(other, held, self._hinges(a, b))
                losses.append(loss(surface, old, new, excuse, self.config))
        return losses

    def _free_limit(self, a: int, b: int) -> float:
        """Return how much may be cut off two parts together where nothing excuses it [m].

        What a joint that is hung straight runs into on its way is planed off like the edge beside
        a hinge; a crooked joint is to be mended.
        """
        between = joints_between(self.articulation, a, b)
        if not jointed(self.articulation, a, b) or not self._well_hung(between):
            return self.config.bared_m
        most = min(self._limit(a, b) + self.config.clearance_m, self.config.scraped_m)
        return max(self.config.bared_m, most)

    def _well_hung(self, joints: Iterable[Joint]) -> bool:
        return all(
            well_hung(self.surfaces[each.child], each, self._holding(each), self.config)
            for each in joints
        )

    def _pressed(self, a: int, b: int) -> float:
        """Return how far a button goes into what holds it [m]; 0 for all that is no button."""
        between = joints_between(self.articulation, a, b)
        if len(between) != 1 or between[0].turns or not jointed(self.articulation, a, b):
            return 0.0
        travel = between[0].range
        (spare,) = self._standing_out(a, b)
        button = self._well_hung(between) and self._goes_in_flush(spare)
        return travel if travel <= PRESSED_M or button else 0.0

    def _overdone(self, a: int, b: int, losses: list[Loss], at_most: float | None) -> str | None:
        """Return why a cut takes too much, or what can be seen; ``None`` if it does neither."""
        planed = self._limit(a, b) + self.config.clearance_m
        limits = CutLimits(self._free_limit(a, b), planed, at_most or self.config.most_cut)
        names = [self.articulation.parts[part].name for part in (a, b)]
        # Of a closed sheet more may go than of a solid, where it hangs at an edge of its own.
        least_m = SHEET_M if self._hinges(a, b) else 0.0
        solid = [thickness_m(self.solids[part]) > least_m for part in (a, b)]
        return overdone(names, losses, solid, limits, self.config)
