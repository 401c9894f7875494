"""What a cut takes of what can be seen, and how much of that a joiner would trim."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from ...articulation import Joint
from ...asset import Hull
from ...config import SeparateConfig
from ...mesh import FloatArray, Mesh
from ..decompose.convex import depth_below
from ..decompose.outside import ROUNDING_M, outside
from ..decompose.solids import volume_within
from ..decompose.spread import SPREAD, spread_over
from ..poses import arms_from

#: Most corners that are looked at.
MOST_CORNERS = 3000
#: So many hulls are remembered with how far points of a surface lie beyond them.
MOST_KNOWN = 500
#: What is cut off by less is all there: points that are bared by it are not looked at [m].
SHAVED_M = 1e-4


@dataclass(frozen=True)
class SeenSurface:
    """Points of a part's visible surface, object frame at rest.

    Attributes:
        points: [m], shape [n, 3]; the first ``spread`` by area, then corners.
        spread: how many stand for equal areas each.
        diagonal: of the part [m].
        known: earlier measurements, by the hull's identity: most of them no cut touches.
    """

    points: FloatArray
    spread: int
    diagonal: float
    known: dict[int, tuple[Hull, FloatArray]] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, mesh: Mesh) -> SeenSurface:
        """Sample a mesh that has an area."""
        return cls(spread_over(mesh, SPREAD, MOST_CORNERS), SPREAD, mesh.diagonal)

    def beyond(self, hulls: Sequence[Hull]) -> FloatArray:
        """Return how far each point lies beyond a face plane of every hull [m], shape [n].

        That is how deep a cut went: a plane that takes all of a sheet at a slight angle is never
        deep, however far the sheet's other end then is from the rest.
        """
        nearest = np.full(len(self.points), np.inf)
        for hull in hulls:
            np.minimum(nearest, self._beyond_one(hull), out=nearest)
        return np.asarray(np.maximum(nearest, 0.0))

    def _beyond_one(self, hull: Hull) -> FloatArray:
        # With the hull, so that no other one gets its identity.
        if id(hull) not in self.known:
            if len(self.known) >= MOST_KNOWN:
                self.known.clear()
            self.known[id(hull)] = hull, -depth_below(hull, self.points)
        return self.known[id(hull)][1]


@dataclass(frozen=True)
class Excuse:
    """Where a cut between two parts may take what can be seen of one of them.

    Attributes:
        other: the other part's hulls before the cut.
        held: a joint holds one part in the other: its share inside the other is hidden.
        hinges: joints that turn one against the other.
    """

    other: Sequence[Hull]
    held: bool
    hinges: Sequence[Joint]

    def holds(self, points: FloatArray, config: SeparateConfig) -> npt.NDArray[np.bool_]:
        """Tell which points lie in the other part, or as near as they may come to it, shape [n]."""
        return outside(self.other, points) < config.clearance_m


@dataclass(frozen=True)
class Loss:
    """What one part loses by a cut.

    Attributes:
        share: of its collision volume.
        open_share: the same without what lay hidden in the part that holds it.
        area: share of its visible surface that is neither hidden nor covered any more.
        bare_area: share of it that is not covered any more, hidden or not.
        untouched: share of it that lies too far outside the remaining hulls, hidden or not,
            after this cut and all before it; 0 where this one adds nothing to it.
        bared_m: deepest cut below its visible surface where nothing excuses it [m].
        trimmed_m: the same beside a hinge, or in a part that no joint holds it in [m].
    """

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


def loss(
    surface: SeenSurface,
    before: Sequence[Hull],
    after: Sequence[Hull],
    excuse: Excuse,
    config: SeparateConfig,
) -> Loss:
    """Return what a part with some visible surface loses where its hulls become others."""
    if not after:
        return Loss(1.0, 1.0, 1.0, 1.0, 1.0, np.inf, np.inf)
    whole = sum(hull.volume for hull in before)
    share = 1.0 - sum(hull.volume for hull in after) / whole
    open_share = share
    if excuse.held and share > config.planed_volume:
        was, left = (volume_within(hulls, excuse.other) for hulls in (before, after))
        open_share -= (was - left) / whole
    depth = surface.beyond(after) - surface.beyond(before)
    taken = depth > SHAVED_M
    points = surface.points[taken]
    depth = depth[taken]
    within = excuse.holds(points, config)
    hidden = within & excuse.held
    trimmed = ~hidden & (within | _beside(points, excuse.hinges, config.hinge_m))
    free = ~hidden & ~trimmed
    area, bare_area, untouched = _bared(surface, before, after, excuse, config)
    return Loss(
        share,
        max(0.0, open_share),
        area,
        bare_area,
        untouched,
        float(depth[free].max(initial=0.0)),
        float(depth[trimmed].max(initial=0.0)),
    )


def _bared(
    surface: SeenSurface,
    before: Sequence[Hull],
    after: Sequence[Hull],
    excuse: Excuse,
    config: SeparateConfig,
) -> tuple[float, float, float]:
    """Return the shares of a surface bared and not hidden, bared, and untouched: see `Loss`."""
    # Most lie within a hull that no cut touched, which is known.
    out = surface.beyond(after)[: surface.spread] > ROUNDING_M
    points = surface.points[: surface.spread][out]
    now = outside(after, points)
    far = now > config.visible_m
    points = points[far]
    now = now[far]
    more = now - outside(before, points)
    bared = more > config.visible_m
    hidden = excuse.held & excuse.holds(points[bared], config)
    untouched = now > config.gap_m
    added = (untouched & (more > SHAVED_M)).any()
    return (
        float((~hidden).sum()) / surface.spread,
        float(bared.sum()) / surface.spread,
        float(untouched.sum()) / surface.spread if added else 0.0,
    )


def overdone(
    names: Sequence[str],
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
                f"in the other, most of it off {names[int(np.argmax(depths))]!r}; "
                f"at most {limit * 1000:.3g} mm may go"
            )
    for name, each, encloses in zip(names, losses, solid, strict=True):
        trimmed = each.deepest_m > config.visible_m
        shares = [(each.share, config.most_cut)] if encloses or trimmed else []
        shares += [(each.open_share, config.planed_volume)] if encloses and trimmed else []
        for share, most in shares:
            if share > most:
                return (
                    f"cutting them apart would take {share:.0%} of {name!r}; "
                    f"at most {most:.0%} may go"
                )
        if each.area > config.planed_area:
            return (
                f"cutting them apart would bare {each.area:.0%} of the surface of {name!r}; "
                f"at most {config.planed_area:.0%} may be"
            )
    return None


def too_bare(names: Sequence[str], losses: Sequence[Loss], config: SeparateConfig) -> str | None:
    """Say why a part would be left with too little of its surface covered, by all cuts."""
    for name, each in zip(names, losses, strict=True):
        if each.untouched > config.most_untouched:
            return (
                f"cutting them apart would leave {each.untouched:.0%} of the surface of {name!r} "
                f"more than {config.gap_m * 1000:g} mm outside its collision geometry; "
                f"at most {config.most_untouched:.0%} may be"
            )
    return None


def _beside(points: FloatArray, hinges: Sequence[Joint], radius_m: float) -> npt.NDArray[np.bool_]:
    """Return which points lie near a hinge's line, shape [n]."""
    near = np.zeros(len(points), dtype=bool)
    for hinge in hinges:
        near |= np.linalg.norm(arms_from(hinge, points), axis=1) < radius_m
    return near
