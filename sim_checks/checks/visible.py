"""The visible surfaces of a description's parts, held beside the hulls in any pose."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..description import FloatArray, Link
from ..geometry.depth import contact_region
from ..geometry.gaps import visible_gap
from ..geometry.loose import Sides, strayed
from ..geometry.placing import joined
from ..geometry.surfaces import PosedSurface, SurfaceMeeting, VisibleSurface
from .pairs import RestingSolids
from .penetration_study import Contact

#: A look at two visible surfaces takes as long as so many at two hulls.
SURFACE_LOOKS = 20


@dataclass(frozen=True)
class Visible:
    """What the parts show.

    Attributes:
        rest: the hulls, posed anew by every question; at rest a stray piece is held against both
            parts.
    """

    rest: RestingSolids

    @cached_property
    def surfaces(self) -> tuple[VisibleSurface | None, ...]:
        """Return each part's visible surface in its first link's frame; ``None`` without one."""
        tree = self.rest.solids.tree
        links = {link.name: link for link in self.rest.solids.description.links}
        at_zero = tree.link_poses({})
        return tuple(_surface([links[name] for name in part], at_zero) for part in tree.parts)

    def gap(self, contact: Contact) -> float | None:
        """Measure the gap of two visible surfaces at a contact [m]; ``None`` without one."""
        sides = self._sides(contact, self.rest.solids.place(contact.pose))
        if sides is None:
            return None
        self.rest.solids.looks.take(SURFACE_LOOKS)
        return visible_gap(*sides, self._meeting(contact))

    def strayed(self, contact: Contact, allowed: float) -> bool:
        """Tell whether only small pieces at the other part meet it deeper than ``allowed`` [m]."""
        at_rest = self._sides(contact, self._resting)
        sides = self._sides(contact, self.rest.solids.place(contact.pose))
        if sides is None or at_rest is None:
            return False
        return strayed(sides, self._meeting(contact), at_rest, allowed)

    @cached_property
    def _resting(self) -> dict[str, FloatArray]:
        """Link poses at rest."""
        return self.rest.solids.tree.link_poses(self.rest.lower)

    def _meeting(self, contact: Contact) -> SurfaceMeeting:
        """Return where a contact's hulls meet or come nearest; they are placed as it says."""
        a, b = (self.rest.solids.items[index].collider for index in contact.hulls)
        overlap = a.stand(b)
        margin = self.rest.config.clearance_m
        region = contact_region(a.hull, b.hull)
        low = region.min(axis=0) if len(region) else np.maximum(a.bounds[0], b.bounds[0]) - margin
        high = region.max(axis=0) if len(region) else np.minimum(a.bounds[1], b.bounds[1]) + margin
        low, high = np.minimum(low, high), np.maximum(low, high)
        return SurfaceMeeting(low, high, overlap.depth, overlap.direction, margin)

    def _sides(self, contact: Contact, poses: Mapping[str, FloatArray]) -> Sides | None:
        """Return the surfaces of a contact's hulls' parts; ``None`` where one shows nothing."""
        solids = self.rest.solids
        found = []
        for part in (solids.items[index].part for index in contact.hulls):
            surface = self.surfaces[part]
            if surface is not None:
                found.append(PosedSurface(surface, poses[solids.tree.parts[part][0]]))
        return (found[0], found[1]) if len(found) == 2 else None


def _surface(links: Sequence[Link], at_zero: Mapping[str, FloatArray]) -> VisibleSurface | None:
    """Return one part's surface in its first link's frame."""
    to_part = np.linalg.inv(at_zero[links[0].name])
    mesh = joined((shape, to_part @ at_zero[link.name]) for link in links for shape in link.visuals)
    return None if mesh is None else VisibleSurface(*mesh)
