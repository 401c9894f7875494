"""Two parts that are to be cut apart: how they move against one another, what a cut may take."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from manifold3d import Manifold

from ...articulation import Articulation, Joint
from ...asset import Hull
from ...config import SeparateConfig
from ...mesh import BoolArray, FloatArray
from ..decompose.convex import hull_of
from ..decompose.outside import ROUNDING_M, outside
from ..decompose.solids import thickness_m, volume_within
from ..decompose.spread import SPREAD
from ..hinges import CROOKED, is_askew
from ..poses import arms_from, held_by, joints_between, moved, relative_poses
from .along import Sides, hull_depth
from .budget import Loss, SeenSurface, overdone
from .clip import SHEET_M
from .hung import at_an_edge, reach_m, stands_out_m, trimmed_limit, well_hung
from .overlap import overlap_m, part_solid

#: Less cut off counts as nothing: points that it bares are not looked at [m].
SHAVED_M = 1e-4
#: Hulls that get so much deeper along a joint are in each other's way, however fat they are [m].
HOPELESS_M = 0.06
#: A slide no longer than this is a button, which is pressed into what it stands on [m].
PRESSED_M = 0.012
#: What turns may need so many times the room that it takes where it is modelled: a square stem.
TURNED_ROOM = 2.0
#: After a cut all of a hinge's way is looked at, in steps so long at the end of its arm [m],
STEP_M = 0.004
#: at most so many for each that was cut at.
FINEST = 8
#: In the first share of its range a door leaves its frame, corner past corner: steps are shorter.
LEAVING = 0.1
LEAVING_STEP_M = 0.0015


@dataclass(frozen=True)
class Workpieces:
    """All parts that are worked on.

    Attributes:
        articulation: whose parts they are.
        hulls: of each part, object frame at rest; a cut replaces those of two.
        config: how far a cut may go.
    """

    articulation: Articulation
    hulls: list[list[Hull]]
    config: SeparateConfig

    @cached_property
    def solids(self) -> tuple[Manifold | None, ...]:
        """Return each part as one solid; ``None`` if its surfaces enclose nothing."""
        parts = range(len(self.articulation.parts))
        return tuple(part_solid(self.articulation, part) for part in parts)

    @cached_property
    def surfaces(self) -> tuple[SeenSurface, ...]:
        """Return each part's visible surface; a carrier's has no points."""
        parts = range(len(self.articulation.parts))
        return tuple(SeenSurface.of(self.articulation.part_mesh(part)) for part in parts)

    def holding(self, joint: Joint) -> list[Hull]:
        """Return the hulls of what holds the part that a joint moves."""
        holder = held_by(self.articulation, joint.child)
        return [] if holder is None else self.hulls[holder]


@dataclass(frozen=True)
class PartPair:
    """Two of them, as they are before they are cut apart.

    Attributes:
        bodies: all parts.
        parts: indices of the two.
        before: the hulls of both.
    """

    bodies: Workpieces
    parts: tuple[int, int]
    before: Sides

    @classmethod
    def of(cls, bodies: Workpieces, names: Iterable[str]) -> PartPair:
        """Find two parts by their names."""
        known = [part.name for part in bodies.articulation.parts]
        a, b = map(known.index, names)
        return cls(bodies, (a, b), (bodies.hulls[a], bodies.hulls[b]))

    @cached_property
    def poses(self) -> list[FloatArray]:
        """Return where the second part is as seen from the first: at rest, closed, on all ways."""
        return relative_poses(self.bodies.articulation, *self.parts, self.bodies.config.poses)

    @cached_property
    def poses_between(self) -> list[FloatArray]:
        """Return poses between those, so near that a sheet at a hinged arm's end meets another.

        None for slides, which are cut on all of their way, where the poses that are cut at are near
        enough, and where no joint holds one part in the other.
        """
        mover = self.bodies.surfaces[self.parts[1 - self.holder]]
        if not self.jointed:
            return []
        count = self.bodies.config.poses
        turning = [joint for joint in self.joints if joint.turns]
        way = max((joint.range * reach_m(mover, joint) for joint in turning), default=0.0)
        most = FINEST * (count - 1)
        finer = min(int(way / STEP_M), most) + 1
        if finer <= count:
            return []
        leaving = min(int(LEAVING * way / LEAVING_STEP_M), most) + 1
        pair = (self.bodies.articulation, *self.parts)
        return relative_poses(*pair, leaving, LEAVING) + relative_poses(*pair, finer)

    @cached_property
    def joints(self) -> list[Joint]:
        """Return the joints that move one part against the other."""
        return joints_between(self.bodies.articulation, *self.parts)

    @cached_property
    def jointed(self) -> bool:
        """Tell whether one part is held in the other: by a joint, or over empty links.

        A cap that turns and lifts hangs on a link without geometry between its two joints.
        """
        return held_by(self.bodies.articulation, self.parts[1 - self.holder]) in self.parts

    @cached_property
    def holder(self) -> int:
        """Return which of the two holds the other: 0 or 1."""
        a, b = self.parts
        return 0 if held_by(self.bodies.articulation, b) == a else 1

    @property
    def held(self) -> tuple[list[Hull], list[Hull]]:
        """Return the hulls of the one that holds, and those of the other."""
        return self.before[self.holder], self.before[1 - self.holder]

    @cached_property
    def well_hung(self) -> bool:
        """Tell whether one holds the other, and all joints move as people hang things."""
        bodies = self.bodies
        return self.jointed and all(
            well_hung(bodies.surfaces[each.child], each, bodies.holding(each), bodies.config)
            for each in self.joints
        )

    @cached_property
    def hinges(self) -> list[Joint]:
        """Return the joints at an edge of what they turn, the one against the other part."""
        turning = [joint for joint in self.joints if joint.turns]
        # What a crooked hinge needs is not cut back: its axis is to be mended.
        if any(is_askew(joint.axis, CROOKED) for joint in turning):
            return []
        surfaces = self.bodies.surfaces
        config = self.bodies.config
        return [each for each in turning if at_an_edge(surfaces[each.child], each, config)]

    @cached_property
    def pressed_m(self) -> float:
        """Return how far a button goes into what holds it [m]; 0 for all that is no button."""
        if len(self.joints) != 1 or self.joints[0].turns or not self.jointed:
            return 0.0
        travel = self.joints[0].range
        button = self.well_hung and self.goes_in_flush
        return travel if travel <= PRESSED_M or button else 0.0

    @cached_property
    def goes_in_flush(self) -> bool:
        """Tell whether what slides goes into the other, no deeper than it stands out of it."""
        slides = [joint for joint in self.joints if not joint.turns]
        spare = [stands_out_m(*self.held, joint) for joint in slides]
        return all(-self.bodies.config.tolerance_m <= each < np.inf for each in spare)

    @cached_property
    def seated(self) -> bool:
        """Tell whether one turns in its own place in the other, or goes in flush."""
        if not (self.well_hung and self.goes_in_flush):
            return False
        if not any(joint.turns for joint in self.joints):
            return True
        return self._taken(self.poses) <= TURNED_ROOM * self._taken(self.poses[:1])

    def _taken(self, poses: Sequence[FloatArray]) -> float:
        """Return the volume of the holder in the room that each hull of the other takes [m3]."""
        holder, mover = self.held
        seen = poses if self.holder == 0 else [np.asarray(np.linalg.inv(pose)) for pose in poses]
        rooms = [
            hull_of(np.concatenate([moved(hull.vertices, pose) for pose in seen])) for hull in mover
        ]
        return volume_within(holder, [room for room in rooms if room is not None])

    def losses(self, after: Sides) -> list[Loss]:
        """Return what a cut takes of each that can be seen."""
        return [self._loss(side, hulls) for side, hulls in enumerate(after)]

    def _loss(self, side: int, after: Sequence[Hull]) -> Loss:
        """Return what one of the two, 0 or 1, loses where its hulls become others."""
        part = self.bodies.articulation.parts[self.parts[side]].name
        if not after:
            return Loss(part, 1.0, 1.0, 1.0, 1.0, 1.0, np.inf, np.inf)
        config = self.bodies.config
        surface = self.bodies.surfaces[self.parts[side]]
        before = self.before[side]
        whole = sum(hull.volume for hull in before)
        share = 1.0 - sum(hull.volume for hull in after) / whole
        open_share = share
        if self.jointed and share > config.planed_volume:
            other = self.before[1 - side]
            was, left = (volume_within(hulls, other) for hulls in (before, after))
            open_share -= (was - left) / whole
        depth = surface.beyond(after) - surface.beyond(before)
        taken = depth > SHAVED_M
        points = surface.points[taken]
        depth = depth[taken]
        within = self._in_the_other(side, points)
        hidden = within & self.jointed
        beside = np.zeros(len(points), dtype=bool)
        for hinge in self.hinges:
            beside |= np.linalg.norm(arms_from(hinge, points), axis=1) < config.hinge_m
        trimmed = ~hidden & (within | beside)
        free = ~hidden & ~trimmed
        return Loss(
            part,
            share,
            max(0.0, open_share),
            *self._bared(side, after),
            float(depth[free].max(initial=0.0)),
            float(depth[trimmed].max(initial=0.0)),
        )

    def _bared(self, side: int, after: Sequence[Hull]) -> tuple[float, float, float]:
        """Return the shares of the surface bared and not hidden, bared, and untouched."""
        config = self.bodies.config
        surface = self.bodies.surfaces[self.parts[side]]
        # Most lie within a hull that no cut touched, which is known.
        out = surface.beyond(after)[:SPREAD] > ROUNDING_M
        points = surface.points[:SPREAD][out]
        now = outside(after, points)
        far = now > config.visible_m
        points = points[far]
        now = now[far]
        more = now - outside(self.before[side], points)
        bared = more > config.visible_m
        hidden = self.jointed & self._in_the_other(side, points[bared])
        untouched = now > config.gap_m
        added = (untouched & (more > SHAVED_M)).any()
        return (
            float((~hidden).sum()) / SPREAD,
            float(bared.sum()) / SPREAD,
            float(untouched.sum()) / SPREAD if added else 0.0,
        )

    def _in_the_other(self, side: int, points: FloatArray) -> BoolArray:
        """Tell which points of one lie in the other, or as near as they may come to it, [n]."""
        return outside(self.before[1 - side], points) < self.bodies.config.clearance_m

    def overdone(self, losses: Sequence[Loss]) -> str | None:
        """Return why a cut takes too much, or what can be seen; ``None`` if it does neither."""
        config = self.bodies.config
        # Of a closed sheet more may go than of a solid, where it hangs at an edge of its own.
        least_m = SHEET_M if self.hinges else 0.0
        solid = [thickness_m(self.bodies.solids[part]) > least_m for part in self.parts]
        trimmed_m = self._trimmed_m + config.clearance_m
        return overdone(losses, solid, config, free_m=self._free_m, trimmed_m=trimmed_m)

    @cached_property
    def solid(self) -> bool:
        """Tell whether both parts enclose something: what they overlap is known, not guessed."""
        return all(self.bodies.solids[part] is not None for part in self.parts)

    @cached_property
    def at_rest_m(self) -> float:
        """Return how deep the two lie in one another at rest or closed [m]."""
        return max(map(self._depth_m, self.poses[:2]))

    def hopeless(self) -> str | None:
        """Return why two parts may not be cut apart along their joints; ``None`` if they may.

        Geometry hidden at rest may go, and that in the way of a hinge's own edge. What else only
        meets along the way is the joint's fault, and a cut would hide it.
        """
        config = self.bodies.config
        limit = self._trimmed_m if self.hinges else config.tolerance_m
        limit = max(limit, self._free_m - config.clearance_m, self.pressed_m)
        what = "meshes"
        if not self.solid:
            what = "hulls"
            # Hulls say little of parts; only of what no joint holds, and far beyond all doubt.
            limit = np.inf if self.jointed else HOPELESS_M
        stride = max(1, (len(self.poses) - 2) // config.overlap_poses)
        for pose in [*self.poses[2::stride], self.poses[-1]] if limit < np.inf else []:
            deeper = self._depth_m(pose) - self.at_rest_m
            if deeper > limit:
                return (
                    f"as the joint moves, their {what} penetrate {deeper * 1000:.2f} mm deeper "
                    f"than at rest; up to {limit * 1000:g} mm may be cut away"
                )
        return None

    def _depth_m(self, pose: FloatArray) -> float:
        """Return how deep the solids of both, else their hulls, lie in one another [m]."""
        one, other = (self.bodies.solids[part] for part in self.parts)
        if one is None or other is None:
            return hull_depth(*self.before, pose)
        return overlap_m(one, other, pose)

    @cached_property
    def _trimmed_m(self) -> float:
        """Return how much may be cut off the two beside their hinge [m].

        A share of what their hinge holds, or of the lesser one.
        """
        parts = [joint.child for joint in self.hinges] or self.parts
        least = min(self.bodies.surfaces[part].diagonal for part in parts)
        return trimmed_limit(self.bodies.config, least)

    @cached_property
    def _free_m(self) -> float:
        """Return how much may be cut off the two together where nothing excuses it [m].

        What a joint that is hung straight runs into on its way is cut back like the edge beside a
        hinge; a crooked joint is to be mended.
        """
        config = self.bodies.config
        if not self.well_hung:
            return config.bared_m
        most = min(self._trimmed_m + config.clearance_m, config.scraped_m)
        return max(config.bared_m, most)
