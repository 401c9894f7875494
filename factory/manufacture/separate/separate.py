"""The stage: which pairs are cut, by the first way that takes no more than it may."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from operator import is_

from ...articulation import Articulation
from ...asset import Hull
from ...config import SeparateConfig
from ...mesh import FloatArray
from ..decompose.convex import limit_vertices
from ..decompose.merge import merge
from ..decompose.pieces import SolidPieces
from ..hinges import is_crooked
from ..repair import Pair
from .along import Sides, carved_apart_along, cut_apart_along, hull_depth
from .between import Cut, cut_between, poses_between
from .budget import Loss, too_bare
from .clip import ROUNDING_M
from .hung import HUB_SHARE, ROUND_SHARE
from .pair import PartPair, Workpieces
from .pits import TURNED_ROOM, Pit, seen_from, swept_share
from .turned import Turned

#: A part of whose surface a cut would bare more than this is kept whole in a socket, of so many
#: pieces more at most, and so little of what is seen around it, as deep as what may be cut back or
#: this share of the part's diagonal: a toaster of four metres has a slot as large.
SOCKET_SHARE = 0.05
SOCKET_PIECES = 24
SOCKET_RIM = 0.01
SOCKET_DEEP = 0.01
#: A plane that made room in one corner of a hull cuts through all of it: what is convex again but
#: for this is joined [m].
EXACT_M = 1e-4


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
class CutBack:
    """A visible cut.

    Attributes:
        part: its name.
        depth_m: deepest [m].
        share: of its collision volume.
        area: of its visible surface.
    """

    part: str
    depth_m: float
    share: float
    area: float


@dataclass(frozen=True)
class Separation:
    """What came of cutting.

    Attributes:
        pieces: one per part, in their order.
        refused: pair of part names -> why its hulls were not cut apart on all of their way.
        hidden: pair of part names -> how deep the parts themselves overlap at rest [m],
            where that is more than decomposition explains and the hidden share was cut out of the
            collision geometry.
        trimmed: pair of part names -> the visible cut.
    """

    pieces: tuple[SolidPieces, ...]
    refused: dict[Pair, SeparationRefusal] = field(default_factory=dict)
    hidden: dict[Pair, float] = field(default_factory=dict)
    trimmed: dict[Pair, tuple[CutBack, ...]] = field(default_factory=dict)


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
    if not wanted:
        return Separation(pieces)
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
        hulls = merge(hulls, EXACT_M)
    limited = tuple(limit_vertices(hull, max_vertices) for hull in hulls)
    return replace(piece, hulls=limited)


@dataclass(frozen=True)
class _Way:
    """One way to cut two parts apart.

    Attributes:
        cut: does it.
        share: of the collision volume of either that it may take.
    """

    cut: Cut
    share: float


def _cut(found: Separation, bodies: Workpieces, names: Pair) -> None:
    """Cut two parts apart on all of their way, else at rest, if that takes no more than may."""
    config = bodies.config
    pair = PartPair.of(bodies, names)
    hidden = pair.at_rest_m > config.tolerance_m
    reason = pair.hopeless()
    for way in ways(pair) if reason is None else ():
        told = _try(found, pair, pair.poses, way)
        if told is None:
            reason = None
            break
        # Why a pit will not do says nothing of a part that is no knob.
        reason = told if reason is None or way.share == config.most_cut else reason
    cut = reason is None

    if reason is not None:
        # What is in the way along it is for the checks to see, and for other repairs.
        at_rest = _Way(cut_apart_along, config.most_cut)
        cut = _try(found, pair, pair.poses[:2], at_rest) is None
        if hidden and not pair.jointed:
            reason = (
                f"they overlap by {pair.at_rest_m * 1000:.2f} mm at rest and no joint holds "
                f"one in the other; {reason}"
            )
        found.refused[names] = SeparationRefusal(reason, pair.solid and hidden, cut)
    if cut and hidden:
        found.hidden[names] = pair.at_rest_m


def _came_near(bodies: Workpieces, names: Pair) -> bool:
    """Tell whether two parts that were cut apart are nearer at rest than they may be."""
    least = bodies.config.clearance_m
    pair = PartPair.of(bodies, names)
    deepest = max(hull_depth(*pair.before, pose, least) for pose in pair.poses[:2])
    return deepest > ROUNDING_M - least


def _try(found: Separation, pair: PartPair, poses: Sequence[FloatArray], way: _Way) -> str | None:
    """Cut two parts at some poses, or say why not."""
    config = pair.bodies.config
    cut = partial(way.cut, clearance_m=config.clearance_m)
    after = cut(*pair.before, poses)
    losses = pair.losses(after)
    reason = pair.overdone(losses, way.share)
    between = poses_between(pair) if reason is None and len(poses) > 2 else []
    closer = cut_between(cut, pair.before, after, poses, between)
    if closer is not None:
        after = closer
        losses = pair.losses(after)
        reason = pair.overdone(losses, way.share)
    if reason is not None:
        return reason
    if max(each.bare_area for each in losses) > SOCKET_SHARE and pair.jointed:
        after = _socketed(pair, poses) or after
        losses = pair.losses(after)
    reason = too_bare(pair.names, losses, config)
    if reason is not None:
        return reason
    for part, hulls in zip(pair.parts, after, strict=True):
        pair.bodies.hulls[part] = hulls
    trimmed = tuple(
        CutBack(name, each.deepest_m, each.share, each.area)
        for name, each in zip(pair.names, losses, strict=True)
        if each.deepest_m > config.visible_m
    )
    if trimmed:
        found.trimmed[pair.names] = trimmed
    return None


def ways(pair: PartPair) -> Iterator[_Way]:
    """Yield the ways to cut two parts apart, those of fewest pieces first."""
    config = pair.bodies.config
    yield _Way(cut_apart_along, config.most_cut)
    for cut in finer_cuts(pair, pair.at_rest_m):
        yield _Way(cut, config.most_cut)
    if pair.pressed_m > 0.0:
        yield _Way(_carved_by_share(pair), config.most_cut)
    for pit in _pits(pair):
        yield _Way(pit, config.planed_volume)


def finer_cuts(pair: PartPair, at_rest_m: float) -> list[Cut]:
    """Return what takes less than planes of parts that a joint connects, so deep at rest [m]."""
    if not pair.jointed:
        return []
    straight = not any(is_crooked(joint.axis) for joint in pair.joints)
    deep = straight and at_rest_m > pair.bodies.config.tolerance_m
    share = HUB_SHARE if deep else ROUND_SHARE
    seated = [joint for joint in pair.joints if pair.seat_roundness(joint) > share]
    return [*map(Turned, seated[:1]), carved_apart_along]


def _carved_by_share(pair: PartPair) -> Cut:
    """Return carving that takes as small a share of either part as can be: behind a button."""
    whole_a, whole_b = (sum(hull.volume for hull in hulls) for hulls in pair.before)
    return partial(carved_apart_along, whole=(whole_a, whole_b))


def _pits(pair: PartPair) -> list[Pit]:
    """Return pits for what turns in its own place, or slides no deeper than it stands out."""
    if not pair.well_hung:
        return []
    turns = any(joint.turns for joint in pair.joints)
    way = seen_from(pair.holder, pair.poses)
    if turns and swept_share(*pair.held, way) > TURNED_ROOM:
        return []
    if not pair.goes_in_flush:
        return []
    return [Pit(pair.holder, at_once) for at_once in (True, False)]


def _socketed(pair: PartPair, poses: Sequence[FloatArray]) -> Sides | None:
    """Return a stem kept whole in a socket, where planes would bare it, if few pieces do.

    Planes had little enough to take for the joint to be sound; of what the socket takes only its
    rim is looked at.
    """
    for cut in (_carved_by_share(pair), Pit(pair.holder, at_once=True)):
        after = cut(*pair.before, poses, pair.bodies.config.clearance_m)
        more = sum(map(len, after)) - sum(map(len, pair.before))
        losses = pair.losses(after)
        if more <= SOCKET_PIECES and all(map(partial(_is_a_rim, pair), pair.parts, losses)):
            return after
    return None


def _is_a_rim(pair: PartPair, part: int, lost: Loss) -> bool:
    """Tell whether only the rim of a socket was cut off a part's visible surface."""
    surface = pair.bodies.surfaces[part]
    deep = SOCKET_DEEP * surface.diagonal if surface else 0.0
    return (
        lost.bare_area <= SOCKET_SHARE
        and lost.area <= SOCKET_RIM
        and lost.deepest_m <= max(pair.bodies.config.planed_m, deep)
    )
