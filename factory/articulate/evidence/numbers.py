"""The evidence for and against each candidate, as one row of numbers with names."""

from __future__ import annotations

import numpy as np

from ...mesh import BoolArray, FloatArray
from .body import Body
from .candidates import Candidates, LineSource
from .guess import Guess
from .look import Look, free_share, look_at, stands_out
from .travel import Travel, displaced, travel

TURN = (
    "turn", "turn_hit_1", "turn_hit_2", "turn_hit_3", "turn_hit_4", "turn_out", "turn_front",
    "turn_pull", "turn_lever", "turn_one_sided", "turn_round", "turn_is_round", "turn_attach",
    "turn_attach_share", "turn_contact_far", "turn_on_part", "turn_along_rest", "turn_upright",
    "turn_flat_axis", "turn_long_axis", "turn_plane", "turn_plane_back", "turn_handle_lever",
    "turn_slip", "turn_rises", "turn_low_line", "turn_contact", "turn_big_radius", "turn_middle",
    "turn_upright_tall", "turn_corner", "turn_straight", "turn_small_round", "turn_free",
    "turn_held_2", "turn_held_4", "turn_ways",
)  # fmt: skip
SLIDE = (
    "slide", "slide_hit_1", "slide_hit_2", "slide_hit_3", "slide_hit_4", "slide_out", "slide_front",
    "slide_pull", "slide_free", "slide_slip", "slide_extent", "slide_upright", "slide_flat_axis",
    "slide_deep", "slide_handle_middle", "slide_handle", "slide_size", "slide_flat_part",
    "slide_wide", "slide_rises", "slide_in_plane", "slide_wrapped", "slide_cube", "slide_low_front",
    "slide_straight", "slide_plate", "slide_grip", "slide_reach", "slide_opposite", "slide_small",
    "slide_small_front", "slide_small_free", "slide_inside", "slide_held_2", "slide_held_4",
    "slide_ways",
)  # fmt: skip
GUESS = ("guess_kind", "guess_angle", "guess_sign", "guess_near", "guess_distance", "guess_made")
#: What every column of :func:`measure` is; turning columns are 0 for slides and the other way
#: round.
NAMES = TURN + SLIDE + GUESS


def measure(body: Body, candidates: Candidates, guess: Guess) -> FloatArray:
    """Return the evidence for every candidate, shape [n, len(NAMES)], mostly within -1 to 1."""
    look = look_at(body)
    numbers = np.zeros((len(candidates), len(NAMES)))
    column = {name: i for i, name in enumerate(NAMES)}
    for slides, found in ((False, _turning), (True, _sliding)):
        rows = np.flatnonzero(candidates.slides == slides)
        some = candidates.at(rows)
        prefix = "slide" if slides else "turn"
        gone = travel(body, some)
        values = {
            f"{prefix}_{name}": value for name, value in found(body, look, some, gone).items()
        }
        values[prefix] = np.ones(len(rows))
        values |= _agreement(body, some, guess)
        for name, value in values.items():
            numbers[rows, column[name]] = value
    return numbers


#: Cosine of the angle within which an axis runs along an edge.
STRAIGHT = 0.9998
#: Parts of this share of the object's diagonal are small: buttons and knobs rather than doors and
#: drawers.
SMALL = 0.08


def _clip(values: FloatArray) -> FloatArray:
    return np.clip(values, -1.0, 1.0)


def _shared(body: Body, look: Look, some: Candidates, gone: Travel) -> dict[str, FloatArray]:
    """Return the numbers that both kinds have."""
    worst = np.maximum.accumulate(gone.hits, axis=1)
    handle = look.center if look.handle is None else look.handle
    values = {f"hit_{k + 1}": np.minimum(worst[:, k] * 5.0, 1.0) for k in range(worst.shape[1])}
    held = np.maximum.accumulate(gone.held, axis=1)
    values |= {f"held_{k + 1}": np.minimum(held[:, k] * 5.0, 1.0) for k in (1, 3)}
    stopped = held.mean(axis=1).reshape(-1, 2)
    values["ways"] = np.tanh(5.0 * (stopped[:, ::-1] - stopped).ravel())
    values["out"] = gone.out
    values["front"] = some_heading(some, look.center) @ look.front
    values["pull"] = (some_heading(some, handle) @ look.front) * float(look.handle is not None)
    values["slip"] = np.abs(
        np.einsum("nij,ij->ni", some_headings(some, body.contact.points), body.contact.normals)
    ).mean(axis=1)
    values["upright"] = np.abs(some.axis[:, 2])
    values["flat_axis"] = np.abs(some.axis @ look.front) * look.facing
    values["rises"] = some_heading(some, look.center)[:, 2]
    own = np.concatenate(body.frames)
    values["straight"] = (np.abs(some.axis @ own.T).max(axis=1) > STRAIGHT).astype(np.float64)
    return values


def some_headings(some: Candidates, points: FloatArray) -> FloatArray:
    """Return unit directions in which points [m] start to move, shape [n, point_count, 3]."""
    return displaced(some, points, np.zeros(len(some)))[1]


def some_heading(some: Candidates, point: FloatArray) -> FloatArray:
    """Return the same as :func:`some_headings` for one point, shape [n, 3]."""
    return some_headings(some, point[None])[:, 0]


def _turning(body: Body, look: Look, some: Candidates, gone: Travel) -> dict[str, FloatArray]:
    values = _shared(body, look, some, gone)
    size = body.diagonal
    along, across = some.about(body.probes.points)
    radius = np.linalg.norm(across, axis=2)
    farthest = np.maximum(radius.max(axis=1), 1e-9)
    mean = across.mean(axis=1)
    lever = np.linalg.norm(mean, axis=1)
    side = np.einsum("nij,nj->ni", across, mean / np.maximum(lever, 1e-9)[:, None])
    values["lever"] = lever / farthest
    values["one_sided"] = (side > -0.03 * size).mean(axis=1)
    values["round"] = np.minimum(some.radius / farthest, 1.0)
    values["is_round"] = (some.source == LineSource.ROUND).astype(np.float64)
    reach = np.linalg.norm(some.about(body.contact.points)[1], axis=2)
    values["attach"] = np.exp(-reach.min(axis=1) / (0.04 * size))
    values["attach_share"] = (reach < 0.08 * size).mean(axis=1)
    values["contact_far"] = _clip(reach.mean(axis=1) / size)
    values["on_part"] = np.exp(-radius.min(axis=1) / (0.06 * size))
    values["along_rest"] = _along_rest(body, some, along)
    values["long_axis"] = np.ptp(along, axis=1) / size
    plane = (some.origin @ look.front - look.middle) / max(look.thickness, 0.02 * size) * 2.0
    level = 1.0 - np.abs(some.axis @ look.front)
    values["plane"] = _clip(plane) * level
    values["plane_back"] = np.minimum(np.abs(np.abs(plane) - 1.0), 1.0) * level
    if look.handle is not None:
        _, arm = some.about(look.handle[None])
        values["handle_lever"] = np.minimum(np.linalg.norm(arm[:, 0], axis=1) / farthest, 1.0)
    flat = 1.0 - values["upright"]
    height = max(float(look.extents[2]), 1e-9)
    values["low_line"] = flat * _clip(2.0 * (some.origin[:, 2] - look.center[2]) / height)
    values["contact"] = (some.source == LineSource.CONTACT).astype(np.float64)
    values["big_radius"] = _clip(farthest / size)
    values["middle"] = (lever < 0.1 * farthest).astype(np.float64)
    width = float(look.extents[:2].max())
    values["upright_tall"] = values["upright"] * _clip(np.log(height / max(width, 1e-9)))
    whole = body.partition.mesh.diagonal
    values["small_round"] = float(np.exp(-size / (SMALL * whole))) * values["is_round"]
    # Of the way that the part's middle first goes, along the nearest of the frames' axes.
    nearest = np.argmax(some_heading(some, look.center) @ look.sides.T, axis=1)
    values["free"] = look.free[nearest]
    edge = (some.source == LineSource.EDGE).astype(np.float64)
    values["corner"] = edge * (values["one_sided"] > 0.97)
    return values


def _along_rest(body: Body, some: Candidates, along: FloatArray) -> FloatArray:
    """Return the share of the axis, as long as the part, that runs close to what stays."""
    share = np.linspace(0.05, 0.95, 7)
    low = along.min(axis=1)
    high = along.max(axis=1)
    places = (
        some.origin[:, None]
        + (low[:, None] + share * (high - low)[:, None])[..., None] * some.axis[:, None]
    )
    if body.tree is None:
        return np.zeros(len(some))
    distance = body.tree.query(places.reshape(-1, 3), distance_upper_bound=0.1 * body.diagonal)[0]
    return np.asarray(
        np.exp(-distance / (0.03 * body.diagonal)).reshape(len(some), -1).mean(axis=1)
    )


def _sliding(body: Body, look: Look, some: Candidates, gone: Travel) -> dict[str, FloatArray]:
    values = _shared(body, look, some, gone)
    size = body.diagonal
    whole = body.partition.mesh.diagonal
    points = body.probes.points @ some.axis.T
    extent = np.ptp(points, axis=0)
    values["free"] = free_share(body, some.axis)
    values["extent"] = extent / size
    values["deep"] = values["flat_axis"] * _clip(extent / max(float(np.median(look.extents)), 1e-9))
    has = float(look.handle is not None)
    handle = look.center if look.handle is None else look.handle
    offset = handle - look.center
    sideways = np.linalg.norm(offset - (some.axis @ offset)[:, None] * some.axis, axis=1)
    values["handle_middle"] = has * np.exp(-sideways / (0.1 * size))
    ones = np.ones(len(some))
    values["handle"] = has * ones
    values["size"] = min(size / whole, 1.0) * ones
    sides = np.sort(look.extents)
    values["flat_part"] = np.exp(-float(sides[0]) / (0.1 * size)) * ones
    width = float(look.extents[:2].max())
    height = float(look.extents[2])
    values["wide"] = np.clip(np.log(width / max(height, 1e-9)), -1.5, 1.5) / 1.5 * ones
    values["in_plane"] = values["flat_part"] * (1.0 - np.abs(some.axis @ look.front))
    inside = np.abs(np.einsum("ij,nj->ni", body.contact.normals, some.axis)) < 0.3
    values["wrapped"] = inside.mean(axis=1) * min(len(body.contact) / (0.3 * len(body.own)), 1.0)
    values["cube"] = float(sides[0] / max(sides[2], 1e-9)) * ones
    small = float(np.exp(-size / (SMALL * whole)))
    values["small"] = small * ones
    values["small_front"] = small * values["front"]
    values["small_free"] = small * values["free"]
    values["opposite"] = values["free"] - values["free"].reshape(-1, 2)[:, ::-1].ravel()
    values |= _ends(body, some)
    values["low_front"] = (
        values["wide"] * np.abs(some.axis @ look.front) * float(abs(look.front[2]) < 0.3)
    )
    return values


def _ends(body: Body, some: Candidates) -> dict[str, FloatArray]:
    """Compare leading end and trailing end: a drawer leads with plate, grip and free way.

    Candidates come in pairs, one for each way round.
    """
    vertices = body.partition.few_vertices
    plate, grip, reach, inside = (np.zeros(len(some)) for _ in range(4))
    for k, axis in enumerate(some.axis):
        along = body.moving.points @ axis
        low = float(along.min())
        high = float(along.max())
        depth = max(high - low, 1e-9)
        whole = vertices @ axis
        span = max(float(np.ptp(whole)), 1e-9)
        reach[k] = (low - whole.min() - (whole.max() - high)) / (0.1 * span)
        inside[k] = min(depth / span, 1.0)
        plate[k] = _breadth(body, axis, along > high - 0.2 * depth) - _breadth(
            body, axis, along < low + 0.2 * depth
        )
    grip = stands_out(body, some.axis)
    grip = grip - grip.reshape(-1, 2)[:, ::-1].ravel()
    return {"plate": _clip(3.0 * plate), "grip": grip, "reach": _clip(reach), "inside": inside}


def _breadth(body: Body, axis: FloatArray, chosen: BoolArray) -> float:
    """Return half the girth of some of the points, seen along an axis, over that of all."""
    points = body.moving.points - (body.moving.points @ axis)[:, None] * axis
    everything = float(np.ptp(points @ body.partition.level.T, axis=0).sum())
    return float(np.ptp(points[chosen] @ body.partition.level.T, axis=0).sum()) / max(
        everything, 1e-9
    )


def _agreement(body: Body, some: Candidates, guess: Guess) -> dict[str, FloatArray]:
    """Return how far the candidates agree with the guess; 0 without one."""
    values: dict[str, FloatArray] = {
        "guess_made": (some.source == LineSource.GUESSED).astype(np.float64)
    }
    slides = bool(some.slides[0])
    if guess.turns is not None:
        values["guess_kind"] = np.full(
            len(some), np.log(max(1.0 - guess.turns if slides else guess.turns, 0.02))
        )
    if guess.direction is not None:
        cosine = some.axis @ guess.direction
        values["guess_angle"] = _clip(np.arccos(np.minimum(np.abs(cosine), 1.0)) / np.radians(45.0))
        values["guess_sign"] = cosine
    if guess.point is not None and not slides:
        _, arm = some.about(guess.point[None])
        distance = np.linalg.norm(arm[:, 0], axis=1) / body.partition.mesh.diagonal
        values["guess_distance"] = np.minimum(distance * 4.0, 1.0)
        values["guess_near"] = np.exp(-distance / 0.05)
    return values
