"""Why two parts meet: the numbers taken of a contact, and what they say."""

from __future__ import annotations

from enum import StrEnum

from ..config import PenetrationConfig

#: A joint that is clear for this share of its range opens; only its end is wrong.
MOST_OF_THE_RANGE = 0.5
#: A joint that is clear for less than this share of its range is blocked from the start.
FROM_THE_START = 0.05
#: Another motion is the better one when it is this much shallower.
MUCH_BETTER = 0.25
#: Visible surfaces that overlap by less than this share of the hulls' depth do not explain it.
FAR_SHALLOWER = 0.5


class Cause(StrEnum):
    """The likely reason of an overlap."""

    HULL_INFLATION = "hull_inflation"
    """The visible surfaces do not meet there, or hardly: the collision hulls are too fat."""
    LEAKED_SEGMENT = "leaked_segment"
    """A small loose piece of one part meets the other part, to which it belongs."""
    WRONG_AXIS = "wrong_axis"
    """Blocked from the start, or free if turned around or hung at the other edge."""
    LIMIT_TOO_LONG = "limit_too_long"
    """The joint is free for most of its range, and only its end runs into something."""
    PARTS_OVERLAP = "parts_overlap"
    """The visible parts overlap at rest."""


#: What a message adds for each cause.
CLAUSES = {
    Cause.HULL_INFLATION: "the visible surfaces hardly meet there: the collision hulls are too fat",
    Cause.LEAKED_SEGMENT: (
        "what meets is a small loose piece that seems to belong to the other part"
    ),
    Cause.WRONG_AXIS: "the joint seems to run the wrong way or about the wrong axis",
    Cause.LIMIT_TOO_LONG: "it is free for most of its range: the upper limit is too far",
    Cause.PARTS_OVERLAP: "the visible parts themselves overlap",
}


def shown_cause(
    depth: float, allowed: float, visual: float | None, *, leaked: bool, at_rest: bool
) -> Cause | None:
    """Return what the visible surfaces say of a contact that is too deep, or nothing.

    Args:
        depth: of the hulls [m].
        allowed: depth that would pass there [m].
        visual: how the visible surfaces stand [m], negative where they overlap; ``None``
            if not known.
        leaked: without a small loose piece that lies at the other part, the visible surfaces would
            be clean.
        at_rest: nothing has moved to get there.
    """
    if visual is None:
        return None
    shown = max(0.0, -visual)
    if shown <= allowed and shown <= FAR_SHALLOWER * depth:
        return Cause.HULL_INFLATION
    if leaked:
        return Cause.LEAKED_SEGMENT
    return Cause.PARTS_OVERLAP if at_rest else None


def way_cause(
    clear: float,
    excess: float,
    otherwise: float | None,
    at_rest: float,
    *,
    seen: bool,
    config: PenetrationConfig,
) -> Cause | None:
    """Return what a joint's way to a contact says of it, or nothing.

    Args:
        clear: share of its range that it makes before the pair fails.
        excess: worst depth beyond rest along the joint [m].
        otherwise: the least worst depth beyond rest among the other motions tried [m]: turned
            around, or hung at the opposite edge; ``None`` if none was tried.
        at_rest: depth of the pair's hulls where the way starts [m].
        seen: the visible surfaces are known; fat hulls would block a joint just so.
        config: what counts as too deep.
    """
    if clear >= MOST_OF_THE_RANGE:
        return Cause.LIMIT_TOO_LONG
    if not seen:
        return None
    better = max(config.excess_m, MUCH_BETTER * excess)
    if otherwise is not None and otherwise <= better:
        return Cause.WRONG_AXIS
    if clear >= FROM_THE_START:
        return None
    # Parts that overlap before anything moves say nothing of the joint.
    return Cause.PARTS_OVERLAP if at_rest > config.rest_m else Cause.WRONG_AXIS
