"""A second look at contacts that are too deep: the visible surfaces there, and the likely cause.

Only contacts that end in a finding are looked at, and of each sound joint the one place where its
hulls come nearest.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial
from typing import TypeVar

import numpy as np

from ..description import FloatArray, Link
from ..geometry.depth import contact_region
from ..geometry.gaps import visible_gap
from ..geometry.loose import Sides, strayed
from ..geometry.path import JointAxis
from ..geometry.placing import box_around, grow_box, joined
from ..geometry.surfaces import PosedSurface, SurfaceMeeting, VisibleSurface
from .cause import MOST_OF_THE_RANGE, Cause, shown_cause, way_cause
from .joint_sweep import JointCourse, clear_until
from .pairs import RestingSolids
from .penetration_study import Contact, JointSweep, PairKind, PairSweep, PenetrationStudy

AnyContact = TypeVar("AnyContact", bound=Contact)
#: A look at two visible surfaces takes as long as so many at two hulls.
SURFACE_LOOKS = 20
#: A whole turn has no other way round [rad].
WHOLE_TURN = 2.0 * np.pi - 1e-6


@dataclass(frozen=True)
class Diagnosis:
    """Where to look again.

    Attributes:
        rest: the solids, posed anew by every question, and contacts at rest, with which every
            joint's are compared; at rest a stray piece is held against both parts.
    """

    rest: RestingSolids

    def explained(self, study: PenetrationStudy) -> PenetrationStudy:
        """Return the same study, with visible surfaces and a cause for all that is too deep."""
        at_rest = partial(self._judged, allowed=self.rest.config.rest_m, at_rest=True)
        met = (replace(item, pair=self._met_open(item.pair)) for item in study.neighbours.met)
        return replace(
            study,
            rest=tuple(map(at_rest, study.rest)),
            zero=None if study.zero is None else tuple(map(at_rest, study.zero)),
            sweeps=tuple(map(self._along, study.sweeps)),
            neighbours=replace(study.neighbours, met=tuple(met)),
            combinations=tuple(map(self._met_open, study.combinations)),
        )

    def _judged(
        self,
        contact: AnyContact,
        allowed: float,
        at_rest: bool = False,
        way: Callable[[bool], Cause | None] | None = None,
    ) -> AnyContact:
        if contact.depth <= allowed:
            return contact
        visual = self._gap(contact)
        leaked = visual is not None and visual < -allowed and self._strayed(contact, allowed)
        cause = shown_cause(contact.depth, allowed, visual, leaked=leaked, at_rest=at_rest)
        if cause is None and way is not None:
            # Other ways are looked for only where the surfaces alone do not tell.
            cause = way(visual is not None)
        return replace(contact, visual=visual, cause=cause)

    def _along(self, sweep: JointSweep) -> JointSweep:
        if not any(pair.excess > self.rest.config.excess_m for pair in sweep.pairs):
            return self._with_clearance(sweep)
        if sweep.alternative is not None:
            # What others have to make way for is no fault that wants a cause.
            return sweep
        course = JointCourse(sweep.joint, self.rest, self.rest.lower)
        otherwise = cache(lambda: self._least_otherwise(course))
        pairs = (self._explained(pair, sweep, course, otherwise) for pair in sweep.pairs)
        return replace(sweep, pairs=tuple(pairs))

    def _with_clearance(self, sweep: JointSweep) -> JointSweep:
        if not sweep.pairs:
            return sweep
        nearest = max(sweep.pairs, key=lambda pair: pair.excess)
        seen = replace(nearest, visual=self._gap(nearest))
        return replace(sweep, pairs=tuple(seen if p is nearest else p for p in sweep.pairs))

    def _explained(
        self,
        pair: PairSweep,
        sweep: JointSweep,
        course: JointCourse,
        otherwise: Callable[[], float | None],
    ) -> PairSweep:
        config = self.rest.config

        def way(seen: bool) -> Cause | None:
            alone = replace(course, only=frozenset({pair.parts}))
            clear = (clear_until(alone, pair) - sweep.lower) / (sweep.upper - sweep.lower)
            # Where the joint opens for most of its way, no other is looked for.
            other = otherwise() if clear < MOST_OF_THE_RANGE else None
            return way_cause(clear, sweep.excess, other, pair.at_rest, seen=seen, config=config)

        # How a joint goes says something of what blocks it, not of its knuckles or of pairs that
        # may touch. Where another joint would have to make way first, it says nothing of this one.
        plain = pair.kind is PairKind.PLAIN and not sweep.waits_for
        allowed = config.excess_m + pair.at_rest
        return self._judged(pair, allowed, way=way if plain else None)

    def _least_otherwise(self, course: JointCourse) -> float | None:
        """Return the least worst excess among the other motions that can be tried [m]."""
        tried = (replace(course, motion=item).run() for item in self._other_motions(course))
        return min((sweep.excess for sweep in tried), default=None)

    def _other_motions(self, course: JointCourse) -> tuple[JointAxis, ...]:
        """Yield the joint turned around; and a hinge at either edge, the far one both ways.

        None for a joint that others follow: turned around, it would take them to where they never
        go.
        """
        if self.rest.solids.tree.followers(course.joint):
            return ()
        own = course.line()
        if own.turning and course.length >= WHOLE_TURN:
            return ()
        around = replace(own, axis=-own.axis)
        solids = self.rest.solids
        links = solids.tree.below(course.joint)
        points = solids.points(i for i, item in enumerate(solids.items) if item.link in links)
        if not own.turning or not len(points):
            return (around,)
        across = points - points.mean(axis=0)
        across -= np.outer(across @ own.axis, own.axis)
        widest = np.linalg.svd(across, full_matrices=False)[2][0]
        # Along the part's widest direction only: the hinge stays on the face that it is on.
        reach = (points - own.origin) @ widest
        near, far = sorted((float(reach.min()), float(reach.max())), key=abs)
        hung = ((own, near), (own, far), (around, far))
        return (around, *(replace(line, origin=own.origin + at * widest) for line, at in hung))

    def _met_open(self, contact: AnyContact) -> AnyContact:
        """Tell only causes that the surfaces show: two open joints may meet by design."""
        return self._judged(contact, self.rest.config.excess_m + contact.at_rest)

    @cached_property
    def _surfaces(self) -> tuple[VisibleSurface | None, ...]:
        """Return each part's visible surface in its first link's frame; ``None`` without one."""
        tree = self.rest.solids.tree
        links = {link.name: link for link in self.rest.solids.description.links}
        at_zero = tree.link_poses({})
        return tuple(_surface([links[name] for name in part], at_zero) for part in tree.parts)

    def _gap(self, contact: Contact) -> float | None:
        """Measure the gap of two visible surfaces at a contact [m]; ``None`` without one."""
        sides = self._sides(contact, self.rest.solids.place(contact.pose))
        if sides is None:
            return None
        self.rest.solids.looks.take(SURFACE_LOOKS)
        return visible_gap(*sides, self._meeting(contact))

    def _strayed(self, contact: Contact, allowed: float) -> bool:
        """Tell whether only small pieces at the other part meet it deeper than ``allowed`` [m]."""
        solids = self.rest.solids
        at_rest = self._sides(contact, solids.tree.link_poses(self.rest.lower))
        sides = self._sides(contact, solids.place(contact.pose))
        if sides is None or at_rest is None:
            return False
        return strayed(sides, self._meeting(contact), at_rest, allowed)

    def _meeting(self, contact: Contact) -> SurfaceMeeting:
        """Return where a contact's hulls meet or come nearest; they are placed as it says."""
        a, b = (self.rest.solids.items[index].collider for index in contact.hulls)
        overlap = a.stand(b)
        margin = self.rest.config.clearance_m
        region = contact_region(a.hull, b.hull)
        if len(region) == 0:
            lows, highs = np.stack([a.bounds, b.bounds], axis=1)
            region = grow_box(np.array([lows.max(axis=0), highs.min(axis=0)]), margin)
        return SurfaceMeeting(box_around([region]), overlap.depth, overlap.direction, margin)

    def _sides(self, contact: Contact, poses: Mapping[str, FloatArray]) -> Sides | None:
        """Return the surfaces of a contact's hulls' parts; ``None`` where one shows nothing."""
        solids = self.rest.solids
        found = []
        for part in (solids.items[index].part for index in contact.hulls):
            surface = self._surfaces[part]
            if surface is not None:
                found.append(PosedSurface(surface, poses[solids.tree.parts[part][0]]))
        return (found[0], found[1]) if len(found) == 2 else None


def _surface(links: Sequence[Link], at_zero: Mapping[str, FloatArray]) -> VisibleSurface | None:
    """Return one part's surface in its first link's frame."""
    to_part = np.linalg.inv(at_zero[links[0].name])
    mesh = joined((shape, to_part @ at_zero[link.name]) for link in links for shape in link.visuals)
    return None if mesh is None else VisibleSurface(*mesh)
