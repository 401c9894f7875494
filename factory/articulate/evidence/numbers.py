"""The evidence for and against each candidate, as one row of numbers with names."""

from __future__ import annotations

import numpy as np

from ...mesh import FloatArray
from .body import Body
from .candidates import Candidates, LineSource
from .guess import Guess
from .look import Look, free_share, look_at
from .travel import displaced, travel

SHARED = ("made", "hit", "ways", "out", "front", "slip", "upright", "rises", "straight", "free")
TURNING = (
    "lever", "one_sided", "round", "is_round", "attach", "attach_share", "on_part", "along_rest",
    "long_axis", "plane_back", "handle_lever", "low_line", "middle", "corner", "big_radius",
)  # fmt: skip
SLIDING = ("opposite", "size", "flat_part", "in_plane", "wrapped", "cube", "reach", "inside")
GUESS = ("guess_kind", "guess_angle", "guess_sign", "guess_near", "guess_distance", "guess_made")
#: What every column of :func:`measure` is; turning columns are 0 for slides and the other way
#: round.
NAMES = (
    *(f"turn_{name}" for name in (*SHARED, *TURNING)),
    *(f"slide_{name}" for name in (*SHARED, *SLIDING)),
    *GUESS,
)
#: Cosine of the angle within which an axis runs along an edge.
STRAIGHT = 0.9998


def measure(body: Body, candidates: Candidates, guess: Guess) -> FloatArray:
    """Return the evidence for every candidate, shape [n, len(NAMES)], mostly within -1 to 1."""
    look = look_at(body)
    numbers = np.zeros((len(candidates), len(NAMES)))
    column = {name: i for i, name in enumerate(NAMES)}
    for slides, found in ((False, _turning), (True, _sliding)):
        rows = np.flatnonzero(candidates.slides == slides)
        some = candidates.at(rows)
        prefix = "slide" if slides else "turn"
        values = _shared(body, look, some) | found(body, look, some)
        values = {f"{prefix}_{name}": value for name, value in values.items()}
        for name, value in (values | _agreement(body, some, guess)).items():
            numbers[rows, column[name]] = value
    return numbers


def _clip(values: FloatArray) -> FloatArray:
    return np.clip(values, -1.0, 1.0)


def _shared(body: Body, look: Look, some: Candidates) -> dict[str, FloatArray]:
    """Return the numbers that both kinds have."""
    gone = travel(body, some)
    stopped = gone.held.reshape(-1, 2)
    heading = _headings(some, look.center[None])[:, 0]
    slips = np.einsum("nij,ij->ni", _headings(some, body.contact.points), body.contact.normals)
    own = np.concatenate(body.frames)
    return {
        "made": np.ones(len(some)),
        "hit": np.minimum(5.0 * gone.hits, 1.0),
        "ways": np.tanh(5.0 * (stopped[:, ::-1] - stopped).ravel()),
        "out": gone.out,
        "front": heading @ look.front,
        "slip": np.abs(slips).mean(axis=1),
        "upright": np.abs(some.axis[:, 2]),
        "rises": heading[:, 2],
        "straight": (np.abs(some.axis @ own.T).max(axis=1) > STRAIGHT).astype(np.float64),
        "free": look.free[np.argmax(heading @ look.sides.T, axis=1)],
    }


def _headings(some: Candidates, points: FloatArray) -> FloatArray:
    """Return unit directions in which points [m] start to move, shape [n, point_count, 3]."""
    return displaced(some, points, np.zeros(len(some)))[1]


def _turning(body: Body, look: Look, some: Candidates) -> dict[str, FloatArray]:
    size = body.diagonal
    along, across = some.about(body.probes.points)
    radius = np.linalg.norm(across, axis=2)
    farthest = np.maximum(radius.max(axis=1), 1e-9)
    mean = across.mean(axis=1)
    lever = np.linalg.norm(mean, axis=1)
    side = np.einsum("nij,nj->ni", across, mean / np.maximum(lever, 1e-9)[:, None])
    one_sided = (side > -0.03 * size).mean(axis=1)
    reach = np.linalg.norm(some.about(body.contact.points)[1], axis=2)
    handle = look.center if look.handle is None else look.handle
    arm = np.linalg.norm(some.about(handle[None])[1][:, 0], axis=1)
    plane = (some.origin @ look.front - look.middle) / max(look.thickness, 0.02 * size) * 2.0
    low = (some.origin[:, 2] - look.center[2]) / max(float(look.extents[2]), 1e-9)
    return {
        "lever": lever / farthest,
        "one_sided": one_sided,
        "round": np.minimum(some.radius / farthest, 1.0),
        "is_round": (some.source == LineSource.ROUND).astype(np.float64),
        "attach": np.exp(-reach.min(axis=1) / (0.04 * size)),
        "attach_share": (reach < 0.08 * size).mean(axis=1),
        "on_part": np.exp(-radius.min(axis=1) / (0.06 * size)),
        "along_rest": _along_rest(body, some, along),
        "long_axis": np.ptp(along, axis=1) / size,
        "plane_back": np.minimum(np.abs(np.abs(plane) - 1.0), 1.0)
        * (1.0 - np.abs(some.axis @ look.front)),
        "handle_lever": np.minimum(arm / farthest, 1.0) * (look.handle is not None),
        "low_line": (1.0 - np.abs(some.axis[:, 2])) * _clip(2.0 * low),
        "middle": (lever < 0.1 * farthest).astype(np.float64),
        "corner": ((some.source == LineSource.EDGE) & (one_sided > 0.97)).astype(np.float64),
        "big_radius": _clip(farthest / size),
    }


def _along_rest(body: Body, some: Candidates, along: FloatArray) -> FloatArray:
    """Return the share of the axis, as long as the part, that runs close to what stays."""
    if body.tree is None:
        return np.zeros(len(some))
    low = along.min(axis=1)[:, None]
    high = along.max(axis=1)[:, None]
    steps = low + np.linspace(0.05, 0.95, 7) * (high - low)
    places = some.origin[:, None] + steps[..., None] * some.axis[:, None]
    distance, _ = body.tree.query(places, distance_upper_bound=0.1 * body.diagonal)
    return np.asarray(np.exp(-distance / (0.03 * body.diagonal)).mean(axis=1))


def _sliding(body: Body, look: Look, some: Candidates) -> dict[str, FloatArray]:
    size = body.diagonal
    free = free_share(body, some.axis)
    whole = body.partition.few_vertices @ some.axis.T
    along = body.moving.points @ some.axis.T
    span = np.maximum(np.ptp(whole, axis=0), 1e-9)
    behind = along.min(axis=0) - whole.min(axis=0) - (whole.max(axis=0) - along.max(axis=0))
    sides = np.sort(look.extents)
    flat = np.exp(-float(sides[0]) / (0.1 * size))
    inside = np.abs(body.contact.normals @ some.axis.T) < 0.3
    ones = np.ones(len(some))
    return {
        "opposite": free - free.reshape(-1, 2)[:, ::-1].ravel(),
        "size": min(size / body.partition.mesh.diagonal, 1.0) * ones,
        "flat_part": flat * ones,
        "in_plane": flat * (1.0 - np.abs(some.axis @ look.front)),
        "wrapped": inside.mean(axis=0) * min(len(body.contact) / (0.3 * len(body.own)), 1.0),
        "cube": float(sides[0] / max(sides[2], 1e-9)) * ones,
        "reach": _clip(behind / (0.1 * span)),
        "inside": np.minimum(np.ptp(along, axis=0) / span, 1.0),
    }


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
