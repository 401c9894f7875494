"""The continuous sweep of a big cabinet against the obvious loop.

Ten joints, about three hundred hulls of boards with broken edges. The obvious loop looks at 64
fixed poses a joint, builds every hull anew for each, and asks every pair. That takes the better
part of an hour, so it is timed over a few poses and scaled; what it would find is found with far
pairs skipped, which changes no depth. One JSON line.
"""

from __future__ import annotations

import itertools
import json
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from asset_factory.sim_checks.checks.penetration import check_penetration
from asset_factory.sim_checks.config import PenetrationConfig
from asset_factory.sim_checks.description import (
    DescribedShape,
    Description,
    FloatArray,
    JointLine,
    Link,
)
from asset_factory.sim_checks.geometry.depth import overlap
from asset_factory.sim_checks.geometry.hull import CollisionHull, convex_hull
from asset_factory.sim_checks.geometry.kinematics import build_tree, sweep_range

POSES = 64
TIMED_POSES = 2
COLUMNS = 2
ROWS = 5
BOARD = 0.018
GAP = 0.002
CELL = (0.5, 0.3)
DEPTH = 0.5
#: A rod this thick [m] stands before one door, where no fixed pose has the door's middle.
ROD = 0.003
ROD_AT = (0.4, 0.81)

Span = tuple[float, float]
Hulls = dict[tuple[str, int], CollisionHull]


def cabinet(*, rod: bool) -> Description:
    """Two columns of five rows; drawers and doors take turns. The rod stands in one door's way."""
    width = COLUMNS * CELL[0]
    height = ROWS * CELL[1]
    columns = [(i * CELL[0], (i + 1) * CELL[0]) for i in range(COLUMNS)]
    rows = [(i * CELL[1], (i + 1) * CELL[1]) for i in range(ROWS)]
    carcass = [*board((0.0, width), (DEPTH, DEPTH + BOARD), (0.0, height), (4, 1, 5))]
    for i in range(COLUMNS + 1):
        x = np.clip(i * CELL[0], BOARD / 2, width - BOARD / 2)
        carcass += board((x - BOARD / 2, x + BOARD / 2), (0.0, DEPTH), (0.0, height), (1, 1, ROWS))
    for i in range(ROWS + 1):
        z = np.clip(i * CELL[1], BOARD / 2, height - BOARD / 2)
        carcass += board(
            (0.0, width), (0.0, DEPTH), (z - BOARD / 2, z + BOARD / 2), (COLUMNS, 1, 1)
        )
    if rod:
        radius, angle = ROD_AT
        x = GAP + radius * np.cos(angle)
        y = -GAP - BOARD - radius * np.sin(angle)
        carcass += board((x, x + ROD), (y, y + ROD), (0.65, 0.85), (1, 1, 1))
    made = [
        (drawer if number % 2 else door)(number, x, z)
        for number, (x, z) in enumerate(itertools.product(columns, rows))
    ]
    links = [body("carcass", carcass), *(link for link, _ in made)]
    joints = [joint for _, joint in made]
    return Description(Path("cabinet.urdf"), "urdf", tuple(links), tuple(joints))


def drawer(number: int, x: Span, z: Span) -> tuple[Link, JointLine]:
    """A box with an overlay front and a bar, pulled along -y."""
    inner_x = (x[0] + BOARD + GAP, x[1] - BOARD - GAP)
    inner_z = (z[0] + BOARD + GAP, z[1] - 0.06)
    back = DEPTH - GAP - 0.02
    wall = 0.012
    pieces = [*front(x, z)]
    pieces += board((inner_x[0], inner_x[0] + wall), (-GAP, back), inner_z, (1, 3, 1))
    pieces += board((inner_x[1] - wall, inner_x[1]), (-GAP, back), inner_z, (1, 3, 1))
    pieces += board(inner_x, (back - wall, back), inner_z, (3, 1, 1))
    pieces += board(inner_x, (-GAP, back), (inner_z[0], inner_z[0] + wall), (3, 3, 1))
    return body(f"drawer_{number}", pieces), joint(
        f"slide_{number}", "prismatic", f"drawer_{number}", (0, -1, 0), 0.4
    )


def door(number: int, x: Span, z: Span) -> tuple[Link, JointLine]:
    """An overlay panel with a shelf on its inside and a bar, hinged at its left front edge."""
    pieces = [*front(x, z)]
    shelf = (x[0] + 0.08, x[1] - 0.08)
    pieces += board(shelf, (-GAP, 0.06), (z[0] + 0.1, z[0] + 0.112), (6, 2, 1))
    hinge = np.array([x[0] + GAP, -GAP - BOARD, 0.0])
    shapes = [piece - hinge for piece in pieces]
    turn = joint(f"hinge_{number}", "revolute", f"door_{number}", (0, 0, -1), 1.6)
    turn.origin[:3, 3] = hinge
    return body(f"door_{number}", shapes), turn


def front(x: Span, z: Span) -> Iterator[FloatArray]:
    """A panel over the cell's edges and a bar on two posts."""
    yield from board(
        (x[0] + GAP, x[1] - GAP), (-GAP - BOARD, -GAP), (z[0] + GAP, z[1] - GAP), (3, 1, 2)
    )
    bar = (x[1] - 0.2, x[1] - 0.06)
    face = -GAP - BOARD
    middle = (z[0] + z[1]) / 2
    yield from board(bar, (face - 0.03, face - 0.02), (middle - 0.005, middle + 0.005), (2, 1, 1))
    for end in bar:
        yield from board(
            (end - 0.005, end + 0.005),
            (face - 0.02, face),
            (middle - 0.005, middle + 0.005),
            (1, 1, 1),
        )


def board(x: Span, y: Span, z: Span, cuts: tuple[int, int, int]) -> Iterator[FloatArray]:
    """A board as ``cuts`` pieces with edges chamfered by a tenth of its thinnest side [m].

    Each piece has 24 corners.
    """
    ends = [
        np.linspace(span[0], span[1], count + 1)
        for span, count in zip((x, y, z), cuts, strict=True)
    ]
    signs = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
    for i, j, k in itertools.product(*(range(count) for count in cuts)):
        low = np.array([ends[0][i], ends[1][j], ends[2][k]])
        high = np.array([ends[0][i + 1], ends[1][j + 1], ends[2][k + 1]])
        half = (high - low) / 2
        broken = np.full((3, 3), 0.1 * half.min()) - np.diag(np.full(3, 0.1 * half.min()))
        yield np.vstack([(low + high) / 2 + signs * (half - cut) for cut in broken])


def body(name: str, pieces: Sequence[FloatArray]) -> Link:
    """A link that looks as it collides."""
    shapes = []
    for number, points in enumerate(pieces):
        hull = convex_hull(points)
        shapes.append(DescribedShape(f"{name}_{number}", "mesh", hull.vertices, hull.triangles))
    return Link(name, None, tuple(shapes), tuple(shapes))


def joint(name: str, kind: str, child: str, axis: Sequence[float], upper: float) -> JointLine:
    """A joint below the carcass."""
    return JointLine(
        name, kind, "carcass", child, np.eye(4), np.array(axis, dtype=float), 0.0, upper
    )


def poses_of(description: Description) -> list[dict[str, float]]:
    """Rest, then every joint through 64 places."""
    moving = build_tree(description).moving
    spans = {item.name: sweep_range(item) or (0.0, 0.0) for item in moving}
    lower = {name: span[0] for name, span in spans.items()}
    steps = [
        {**lower, name: float(at)}
        for name, span in spans.items()
        for at in np.linspace(*span, POSES)
    ]
    return [lower, *steps]


def built(description: Description, values: dict[str, float]) -> Hulls:
    """Every hull, from its points, where it is."""
    poses = build_tree(description).link_poses(values)
    return {
        (link.name, number): convex_hull(shape.vertices).moved(poses[link.name])
        for link in description.links
        for number, shape in enumerate(link.collisions)
    }


def depths(hulls: Hulls) -> dict[tuple[str, int, str, int], float]:
    """Every pair of different links [m]."""
    pairs = ((a, b) for a, b in itertools.combinations(hulls, 2) if a[0] != b[0])
    return {(*a, *b): max(0.0, overlap(hulls[a], hulls[b]).depth) for a, b in pairs}


def near_depths(hulls: Hulls) -> dict[tuple[str, int, str, int], float]:
    """The same without the pairs whose boxes do not meet: their depth is 0."""
    names = list(hulls)
    boxes = np.array([hulls[name].bounds for name in names])
    meet = np.triu(
        (boxes[:, None, 0] <= boxes[None, :, 1]).all(2)
        & (boxes[None, :, 0] <= boxes[:, None, 1]).all(2),
        1,
    )
    pairs = [
        (names[i], names[j]) for i, j in np.argwhere(meet).tolist() if names[i][0] != names[j][0]
    ]
    return {(*a, *b): max(0.0, overlap(hulls[a], hulls[b]).depth) for a, b in pairs}


def moved(local: Hulls, description: Description, values: dict[str, float]) -> Hulls:
    """Hulls in their links' frames, where they are."""
    poses = build_tree(description).link_poses(values)
    return {name: hull.moved(poses[name[0]]) for name, hull in local.items()}


def obvious_worst(description: Description) -> float:
    """Worst depth over rest [m] at the fixed poses."""
    local = {
        (link.name, i): convex_hull(shape.vertices)
        for link in description.links
        for i, shape in enumerate(link.collisions)
    }
    rest = near_depths(moved(local, description, poses_of(description)[0]))
    worst = 0.0
    for values in poses_of(description)[1:]:
        found = near_depths(moved(local, description, values))
        worst = max(worst, *(depth - rest.get(pair, 0.0) for pair, depth in found.items()), 0.0)
    return worst


def timed(work: object) -> float:
    """Core seconds [s] of a call without arguments."""
    started = time.process_time()
    work()  # type: ignore[operator]
    return time.process_time() - started


def main() -> None:
    """Time both on the same cabinet, and again with a rod before a door."""
    sound = cabinet(rod=False)
    broken = cabinet(rod=True)
    config = PenetrationConfig()
    check_penetration(sound, config)  # imports and first calls are not the check's own work
    ours = min(timed(lambda: check_penetration(sound, config)) for _ in range(3))
    diagnosed = min(timed(lambda: check_penetration(broken, config)) for _ in range(3))
    every = poses_of(sound)
    step = (
        timed(lambda: [depths(built(sound, values)) for values in every[:TIMED_POSES]])
        / TIMED_POSES
    )
    result = check_penetration(broken, config)
    line = {
        "benchmark": "penetration_sweep",
        "hulls": result.measurements["hulls"],
        "joints": len(result.measurements["joints"]),
        "core_s": round(ours, 3),
        "core_s_fault_explained": round(diagnosed, 3),
        "obvious_loop_core_s": round(step * len(every)),
        "obvious_loop_scaled_from_poses": f"{TIMED_POSES} of {len(every)}",
        "times_less_work": round(step * len(every) / ours),
        "worst_excess_mm": {
            "continuous": max(joint["excess_mm"] for joint in result.measurements["joints"]),
            "obvious_loop": round(obvious_worst(broken) * 1000.0, 4),
        },
    }
    print(json.dumps(line))


if __name__ == "__main__":
    main()
