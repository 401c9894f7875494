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
        points: [m], shape [n, 3], see :func:`~.decompose.spread.spread_over`.
        diagonal: of the part [m].
        known: earlier measurements, by the hull's identity: most of them no cut touches.
    """

    points: FloatArray
    diagonal: float
    known: dict[int, tuple[Hull, FloatArray]] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, mesh: Mesh) -> SeenSurface:
        """Sample a mesh that has an area."""
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


@dataclass(frozen=True)
class CutSide:
    """One of two parts that are cut apart, and where a cut may take what can be seen of it.

    Attributes:
        part: its name.
        surface: what can be seen of it.
        before: its hulls before the cut.
        other: the other part's hulls before the cut.
        held: a joint holds one part in the other: its share inside the other is hidden.
        hinges: joints that turn one against the other.
        config: how far a cut may go.
    """

    part: str
    surface: SeenSurface
    before: Sequence[Hull]
    other: Sequence[Hull]
    held: bool
    hinges: Sequence[Joint]
    config: SeparateConfig

    def loss(self, after: Sequence[Hull]) -> Loss:
        """Return what the part loses where its hulls become others."""
        if not after:
            return Loss(self.part, 1.0, 1.0, 1.0, 1.0, 1.0, np.inf, np.inf)
        whole = sum(hull.volume for hull in self.before)
        share = 1.0 - sum(hull.volume for hull in after) / whole
        open_share = share
        if self.held and share > self.config.planed_volume:
            was, left = (volume_within(hulls, self.other) for hulls in (self.before, after))
            open_share -= (was - left) / whole
        depth = self.surface.beyond(after) - self.surface.beyond(self.before)
        taken = depth > SHAVED_M
        points = self.surface.points[taken]
        depth = depth[taken]
        within = self._in_the_other(points)
        hidden = within & self.held
        trimmed = ~hidden & (within | _beside(points, self.hinges, self.config.hinge_m))
        free = ~hidden & ~trimmed
        return Loss(
            self.part,
            share,
            max(0.0, open_share),
            *self._bared(after),
            float(depth[free].max(initial=0.0)),
            float(depth[trimmed].max(initial=0.0)),
        )

    def _bared(self, after: Sequence[Hull]) -> tuple[float, float, float]:
        """Return the shares of the surface bared and not hidden, bared, and untouched."""
        # Most lie within a hull that no cut touched, which is known.
        out = self.surface.beyond(after)[:SPREAD] > ROUNDING_M
        points = self.surface.points[:SPREAD][out]
        now = outside(after, points)
        far = now > self.config.visible_m
        points = points[far]
        now = now[far]
        more = now - outside(self.before, points)
        bared = more > self.config.visible_m
        hidden = self.held & self._in_the_other(points[bared])
        untouched = now > self.config.gap_m
        added = (untouched & (more > SHAVED_M)).any()
        return (
            float((~hidden).sum()) / SPREAD,
            float(bared.sum()) / SPREAD,
            float(untouched.sum()) / SPREAD if added else 0.0,
        )

    def _in_the_other(self, points: FloatArray) -> npt.NDArray[np.bool_]:
        """Tell which points lie in the other part, or as near as they may come to it, shape [n]."""
        return outside(self.other, points) < self.config.clearance_m


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


def _beside(points: FloatArray, hinges: Sequence[Joint], radius_m: float) -> npt.NDArray[np.bool_]:
    """Return which points lie near a hinge's line, shape [n]."""
    near = np.zeros(len(points), dtype=bool)
    for hinge in hinges:
        near |= np.linalg.norm(arms_from(hinge, points), axis=1) < radius_m
    return near
