"""The stage: which pairs are cut apart, by planes or carved, and how much that took."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from operator import is_

from ...articulation import Articulation
from ...asset import Hull
from ...config import SeparateConfig
from ...mesh import FloatArray
from ..decompose.convex import THINNEST_M, limit_vertices
from ..decompose.merge import merge
from ..decompose.pieces import SolidPieces
from ..repair import Pair
from .along import LEAST_M, Sides, carved_apart_along, cut_apart_along, hull_depth
from .budget import Loss, too_bare
from .pair import SHAVED_M, PartPair, Workpieces

#: A part of whose surface planes would bare more than this is kept whole in a socket that takes so
#: little of what is seen around it, as deep as what may be cut back or this share of the part's
#: diagonal: a toaster of four metres has a slot as large.
SOCKET_SHARE = 0.05
SOCKET_RIM = 0.01
SOCKET_DEEP = 0.01
#: How often what a cut missed between two poses is looked for, and cut.
MOST_LOOKS = 3

Cut = Callable[..., Sides]


@dataclass(frozen=True)
class SeparationRefusal:
    """Why the hulls of two parts were not cut apart on all of their way.

    Attributes:
        reason: a sentence with the number in it.
        meshes: True where the parts' own solids are at fault; False where it may be their hulls
            only.
        at_rest: they were cut apart where they are at rest, only not along the way.
    """

    reason: str
    meshes: bool
    at_rest: bool = False


@dataclass(frozen=True)
class Separation:
    """What came of cutting.

    Attributes:
        pieces: one per part, in their order.
        refused: pair of part names -> why its hulls were not cut apart on all of their way.
        hidden: pair of part names -> how deep the parts themselves overlap at rest [m],
            where that is more than decomposition explains and the hidden share was cut out of the
            collision geometry.
        trimmed: pair of part names -> what each part loses of which a cut can be seen.
    """

    pieces: tuple[SolidPieces, ...]
    refused: dict[Pair, SeparationRefusal] = field(default_factory=dict)
    hidden: dict[Pair, float] = field(default_factory=dict)
    trimmed: dict[Pair, tuple[Loss, ...]] = field(default_factory=dict)


def separate(
    articulation: Articulation,
    pieces: tuple[SolidPieces, ...],
    pairs: Iterable[Pair],
    config: SeparateConfig,
    max_vertices: int,
) -> Separation:
    """Cut the hulls of some pairs of parts, given by name, apart.

    A cut adds corners to a hull; of more than ``max_vertices`` those that matter least are left
    out.
    """
    wanted = sorted({(min(pair), max(pair)) for pair in pairs})
    bodies = Workpieces(articulation, [list(piece.hulls) for piece in pieces], config)
    found = Separation(pieces)
    for pair in wanted:
        _cut(found, bodies, pair)
    # A sheet between two others that made way for the second may have come too near to the first.
    for pair in wanted:
        if pair not in found.refused and _came_near(bodies, pair):
            _cut(found, bodies, pair)
    after = tuple(
        with_hulls(piece, kept, max_vertices)
        for piece, kept in zip(pieces, bodies.hulls, strict=True)
    )
    return replace(found, pieces=after)


def with_hulls(piece: SolidPieces, hulls: list[Hull], max_vertices: int) -> SolidPieces:
    """Return a part with what cuts left of its hulls, joined where they are convex together.

    A cut adds corners to a hull; of more than ``max_vertices`` those that matter least are left
    out.
    """
    if len(hulls) == len(piece.hulls) and all(map(is_, hulls, piece.hulls)):
        return piece
    if len(hulls) > len(piece.hulls):
        # A plane that made room in one corner of a hull cut through all of it.
        hulls = merge(hulls, SHAVED_M)
    limited = tuple(limit_vertices(hull, max_vertices) for hull in hulls)
    return replace(piece, hulls=limited)


@dataclass(frozen=True)
class _CutPair:
    """What two parts would become.

    Attributes:
        pair: the two.
        after: their hulls.
        losses: what each loses that can be seen.
        overdone: why that is too much; ``None`` if it is not.
    """

    pair: PartPair
    after: Sides
    losses: Sequence[Loss]
    overdone: str | None

    @classmethod
    def of(cls, pair: PartPair, after: Sides) -> _CutPair:
        """Measure what a cut takes."""
        losses = pair.losses(after)
        return cls(pair, after, losses, pair.overdone(losses))

    @property
    def reason(self) -> str | None:
        """Return why the two are not to be cut so; ``None`` if they are."""
        return self.overdone or too_bare(self.losses, self.pair.bodies.config)

    @property
    def bare_area(self) -> float:
        """Return the largest share of a visible surface that is bared, hidden or not."""
        return max(each.bare_area for each in self.losses)

    @property
    def is_a_rim(self) -> bool:
        """Tell whether only the rim of a socket is cut off what can be seen."""
        config = self.pair.bodies.config
        surfaces = [self.pair.bodies.surfaces[part] for part in self.pair.parts]
        return self.bare_area <= SOCKET_SHARE and all(
            lost.area <= SOCKET_RIM
            and lost.deepest_m <= max(config.planed_m, SOCKET_DEEP * surface.diagonal)
            for lost, surface in zip(self.losses, surfaces, strict=True)
        )


def _cut(found: Separation, bodies: Workpieces, names: Pair) -> None:
    """Cut two parts apart on all of their way, else at rest, if that takes no more than may."""
    pair = PartPair.of(bodies, names)
    hidden = pair.at_rest_m > bodies.config.tolerance_m
    cut = None
    reason = pair.hopeless()
    if reason is None:
        cut = _along(pair)
        reason = cut.reason
    if cut is None or reason is not None:
        # What is in the way along it is for the checks to see, and for other repairs.
        cut = _attempt(pair, cut_apart_along, pair.poses[:2])
        if hidden and not pair.jointed:
            reason = (
                f"they overlap by {pair.at_rest_m * 1000:.2f} mm at rest and no joint holds "
                f"one in the other; {reason}"
            )
        at_rest = cut.reason is None
        found.refused[names] = SeparationRefusal(str(reason), pair.solid and hidden, at_rest)
    if cut.reason is None:
        for part, hulls in zip(pair.parts, cut.after, strict=True):
            bodies.hulls[part] = hulls
        # What can be seen of it is told.
        trimmed = tuple(each for each in cut.losses if each.deepest_m > bodies.config.visible_m)
        if trimmed:
            found.trimmed[names] = trimmed
        if hidden:
            found.hidden[names] = pair.at_rest_m


def _along(pair: PartPair) -> _CutPair:
    """Cut two parts apart on all of their way, by the first cut that takes no more than it may.

    That is by planes, which make the fewest pieces; or, of parts that a joint connects, around the
    room that they need; or around what turns or is pressed in its own place in the other. Where
    that bares much of a part it is kept whole in a socket: that another cut has little enough to
    take says that the joint is sound, so only the socket's rim is looked at.
    """
    socket = partial(carved_apart_along, giving=pair.holder)
    cuts: list[Cut] = [cut_apart_along]
    if pair.jointed:
        cuts += [carved_apart_along, *([socket] if pair.seated else [])]
    for cut in cuts:
        tried = _attempt(pair, cut, pair.poses)
        if tried.overdone is None:
            break
    if pair.jointed and tried.overdone is None and tried.bare_area > SOCKET_SHARE:
        kept = _attempt(pair, socket, pair.poses)
        return replace(kept, overdone=None) if kept.is_a_rim else tried
    return tried


def _attempt(pair: PartPair, cut: Cut, poses: Sequence[FloatArray]) -> _CutPair:
    """Cut two parts at some poses; along a joint anew where they are too near between two."""
    cut = partial(cut, clearance_m=pair.bodies.config.clearance_m)
    tried = _CutPair.of(pair, cut(*pair.before, poses))
    if tried.overdone is not None or len(poses) <= 2:
        return tried
    after = tried.after
    way = list(poses)
    for _ in range(MOST_LOOKS):
        missed = [
            pose for pose in pair.poses_between if hull_depth(*after, pose, LEAST_M) > -LEAST_M
        ]
        if not missed:
            break
        # Where nearly all of a long way is missed, as that of a wheel, some of it shows the rest.
        way += missed[:: -(-len(missed) // len(poses))]
        after = cut(*pair.before, way)
    return tried if after is tried.after else _CutPair.of(pair, after)


def _came_near(bodies: Workpieces, names: Pair) -> bool:
    """Tell whether two parts that were cut apart are nearer at rest than they may be."""
    least = bodies.config.clearance_m
    pair = PartPair.of(bodies, names)
    deepest = max(hull_depth(*pair.before, pose, least) for pose in pair.poses[:2])
    return deepest > THINNEST_M - least
