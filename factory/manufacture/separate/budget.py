"""What a cut takes of what can be seen, and how much of that a joiner would trim."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ...asset import Hull
from ...config import SeparateConfig
from ...mesh import FloatArray, Mesh
from ..decompose.convex import depth_below
from ..decompose.spread import spread_over

#: Most corners that are looked at.
MOST_CORNERS = 3000
#: So many hulls are remembered with how far points of a surface lie beyond them.
MOST_KNOWN = 500


@dataclass(frozen=True)
class SeenSurface:
    """Points of a part's visible surface, object frame at rest.

    Attributes:
        points: [m], shape [n, 3], see :func:`~.decompose.spread.spread_over`.
        diagonal: of the part [m].
        known: earlier measurements, by the hull's identity: most of them no cut touches.
    """

    points: FloatArray
    diagonal: float
    known: dict[int, tuple[Hull, FloatArray]] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, mesh: Mesh) -> SeenSurface:
        """Sample a mesh; one without an area has no points."""
        return cls(spread_over(mesh, MOST_CORNERS), mesh.diagonal)

    def beyond(self, hulls: Sequence[Hull]) -> FloatArray:
        """Return how far each point lies beyond a face plane of every hull [m], shape [n].

        That is how deep a cut went: a plane that takes all of a sheet at a slight angle is never
        deep, however far the sheet's other end then is from the rest.
        """
        nearest = np.full(len(self.points), np.inf)
        for hull in hulls:
            # With the hull, so that no other one gets its identity.
            if id(hull) not in self.known:
                if len(self.known) >= MOST_KNOWN:
                    self.known.clear()
                self.known[id(hull)] = hull, -depth_below(hull, self.points)
            np.minimum(nearest, self.known[id(hull)][1], out=nearest)
        return np.asarray(np.maximum(nearest, 0.0))


@dataclass(frozen=True)
class Loss:
    """What one part loses by a cut.

    Attributes:
        part: its name.
        share: of its collision volume.
        open_share: the same without what lay hidden in the part that holds it.
        area: share of its visible surface that is neither hidden nor covered any more.
        bare_area: share of it that is not covered any more, hidden or not.
        untouched: share of it that lies too far outside the remaining hulls, hidden or not,
            after this cut and all before it; 0 where this one adds nothing to it.
        bared_m: deepest cut below its visible surface where nothing excuses it [m].
        trimmed_m: the same beside a hinge, or in a part that no joint holds it in [m].
    """

    part: str
    share: float
    open_share: float
    area: float
    bare_area: float
    untouched: float
    bared_m: float
    trimmed_m: float

    @property
    def deepest_m(self) -> float:
        """Return the deepest cut below its visible surface, excused or not [m]."""
        return max(self.bared_m, self.trimmed_m)


def overdone(
    losses: Sequence[Loss],
    solid: Sequence[bool],
    config: SeparateConfig,
    *,
    free_m: float,
    trimmed_m: float,
) -> str | None:
    """Say why a cut of two parts takes too much, or visible surface; ``None`` if it does neither.

    ``solid`` tells whether each encloses a volume to speak of: the slabs over an open surface come
    and go whole, and a thin sheet is cut back to half of itself. Off both together may go
    ``free_m`` where nothing excuses it, and ``trimmed_m`` where something does, see `Loss` [m].
    """
    for depths, limit in (
        ([each.bared_m for each in losses], free_m),
        ([each.trimmed_m for each in losses], trimmed_m),
    ):
        if sum(depths) > limit:
            return (
                f"cutting them apart would take {sum(depths) * 1000:.1f} mm that is not hidden "
                f"in the other, most of it off {losses[int(np.argmax(depths))].part!r}; "
                f"at most {limit * 1000:.3g} mm may go"
            )
    for each, encloses in zip(losses, solid, strict=True):
        trimmed = each.deepest_m > config.visible_m
        shares = [(each.share, config.most_cut)] if encloses or trimmed else []
        shares += [(each.open_share, config.planed_volume)] if encloses and trimmed else []
        for share, most in shares:
            if share > most:
                return (
                    f"cutting them apart would take {share:.0%} of {each.part!r}; "
                    f"at most {most:.0%} may go"
                )
        if each.area > config.planed_area:
            return (
                f"cutting them apart would bare {each.area:.0%} of the surface of {each.part!r}; "
                f"at most {config.planed_area:.0%} may be"
            )
    return None


def too_bare(losses: Sequence[Loss], config: SeparateConfig) -> str | None:
    """Say why a part would be left with too little of its surface covered, by all cuts."""
    for each in losses:
        if each.untouched > config.most_untouched:
            return (
                f"cutting them apart would leave {each.untouched:.0%} of the surface of "
                f"{each.part!r} more than {config.gap_m * 1000:g} mm outside its collision "
                f"geometry; at most {config.most_untouched:.0%} may be"
            )
    return None
