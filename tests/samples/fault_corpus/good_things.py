"""Sound furniture and appliances: nothing about them rejects."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from .things import Body, FloatArray, Move, Thing, at, box

#: Thickness of every board, and the gap between neighbours [m].
BOARD = 0.018
GAP = 0.004
Z = (0.0, 0.0, 1.0)


def carcass(size: Sequence[float], boards: Sequence[float] = ()) -> tuple[FloatArray, ...]:
    """An open box of boards on z = 0, its open front at y = 0; shelves at heights ``boards``."""
    w, d, h = size
    inside = w - 2 * BOARD
    sides = [box((s * (w - BOARD) / 2, d / 2, h / 2), (BOARD, d, h)) for s in (-1, 1)]
    levels = [box((0.0, d / 2, z), (inside, d, BOARD)) for z in (BOARD / 2, h - BOARD / 2, *boards)]
    return (*sides, *levels, box((0.0, d - BOARD / 2, h / 2), (inside, BOARD, h - 2 * BOARD)))


def drawer(
    width: float, low: float, high: float, depth: float, front: tuple[float, float]
) -> tuple[FloatArray, ...]:
    """An open tub between two heights behind a centred overlay front of given width and height."""
    middle = (low + high) / 2
    wall = 0.012
    tall = high - low
    return (
        *(box((s * (width - wall) / 2, depth / 2, middle), (wall, depth, tall)) for s in (-1, 1)),
        box((0.0, depth - wall / 2, middle), (width - 2 * wall, wall, tall)),
        box((0.0, (depth - wall) / 2, low + wall / 2), (width - 2 * wall, depth - wall, wall)),
        box((0.0, -BOARD / 2, middle), (front[0], BOARD, front[1])),
    )


def cabinet() -> Thing:
    """A 0.6 x 0.4 x 0.7 m cabinet: drawer below, door above (hinged left), lid on top (behind)."""
    w = 0.6
    d = 0.4
    h = 0.7
    middle = 0.3
    inside = w - 2 * BOARD
    bottom = BOARD + GAP
    top = middle - BOARD / 2 - GAP
    tub = drawer(inside - 2 * GAP, bottom, top, d - BOARD - GAP, (w, middle - GAP))
    *walls, front = (np.add(piece, (0.0, -GAP, 0.0)) for piece in tub)
    tub = (*walls, np.add(front, (0.0, 0.0, -0.003)))
    door = box((0.0, -GAP - BOARD / 2, (middle + h) / 2), (w, BOARD, h - middle - GAP))
    lid = box((0.0, d / 2, h + GAP + BOARD / 2), (w, d, BOARD))
    bodies = (
        Body("carcass", carcass((w, d, h), (middle,)), at(0, 0, 0), 20.0),
        Body("drawer", tub, at(0, -GAP, (bottom + top) / 2), 3.0),
        Body("door", (door,), at(-w / 2, -GAP, (middle + h) / 2), 2.5),
        Body("lid", (lid,), at(0, d, h + GAP), 2.5),
    )
    moves = (
        Move("slide", "prismatic", "carcass", "drawer", (0.0, -1.0, 0.0), 0.0, 0.3),
        Move("hinge", "revolute", "carcass", "door", (0.0, 0.0, -1.0), 0.0, 1.57),
        Move("flap", "revolute", "carcass", "lid", (-1.0, 0.0, 0.0), 0.0, 1.2),
    )
    return Thing("cabinet", bodies, moves)


def kiosk() -> Thing:
    """The simplest thing with the cabinet's names: a block, two panels before it, one on top."""
    front = -GAP - BOARD / 2
    lid = box((0.0, 0.2, 0.7 + GAP + BOARD / 2), (0.6, 0.4, BOARD))
    bodies = (
        Body("carcass", (box((0.0, 0.2, 0.35), (0.6, 0.4, 0.7)),), at(0, 0, 0), 20.0),
        Body("drawer", (box((0.0, front, 0.15), (0.6, BOARD, 0.29)),), at(0, -GAP, 0.15), 3.0),
        Body("door", (box((0.0, front, 0.5), (0.6, BOARD, 0.396)),), at(-0.3, -GAP, 0.5), 2.5),
        Body("lid", (lid,), at(0, 0.4, 0.7 + GAP), 2.5),
    )
    return Thing("kiosk", bodies, cabinet().moves)


def fridge() -> Thing:
    """Two doors one above the other, hinged on the right, each with a bar as a handle."""
    w = 0.6
    d = 0.6
    h = 1.7
    split = 0.6
    bodies = [Body("shell", carcass((w, d, h), (split,)), at(0, 0, 0), 60.0)]
    moves = []
    for name, low, high in (("freezer", 0.0, split), ("cooler", split, h)):
        middle = (low + high) / 2
        tall = high - low - GAP
        panel = box((0.0, -GAP - 0.025, middle), (w, 0.05, tall))
        bar = box((-w / 2 + 0.05, -GAP - 0.07, middle), (0.03, 0.03, 0.3))
        posts = [
            box((-w / 2 + 0.05, -GAP - 0.0525, middle + s * 0.12), (0.03, 0.01, 0.03))
            for s in (-1, 1)
        ]
        bodies.append(Body(name, (panel, bar, *posts), at(w / 2, -GAP, middle), 9.0))
        moves.append(Move(f"{name}_hinge", "revolute", "shell", name, Z, 0.0, 1.5))
    return Thing("fridge", tuple(bodies), tuple(moves))


def oven() -> Thing:
    """A door that drops about its lower edge before a cavity, and a rack that then slides out."""
    w = 0.6
    d = 0.55
    h = 0.6
    door = box((0.0, -GAP - 0.02, 0.3), (w - 0.04, 0.04, 0.48))
    rack = box((0.0, 0.25, 0.25), (w - 2 * BOARD - 2 * GAP, 0.44, 0.01))
    bodies = (
        Body("shell", carcass((w, d, h)), at(0, 0, 0), 30.0),
        Body("door", (door,), at(0, -GAP, 0.06), 5.0),
        Body("rack", (rack,), at(0, 0.03, 0.25), 1.5),
    )
    moves = (
        Move("hinge", "revolute", "shell", "door", (1.0, 0.0, 0.0), 0.0, 1.5),
        Move("slide", "prismatic", "shell", "rack", (0.0, -1.0, 0.0), 0.0, 0.35),
    )
    return Thing("oven", bodies, moves)


def laptop(gap: float = GAP) -> Thing:
    """A thin slab on another, a gap between them [m], hinged at the rear edge, closed at 0."""
    screen = box((0.0, 0.11, 0.02 + gap + 0.004), (0.32, 0.22, 0.008))
    bodies = (
        Body("base", (box((0.0, 0.11, 0.01), (0.32, 0.22, 0.02)),), at(0, 0, 0), 1.2),
        Body("screen", (screen,), at(0, 0.22, 0.02 + gap), 0.5),
    )
    return Thing(
        "laptop", bodies, (Move("hinge", "revolute", "base", "screen", (-1.0, 0.0, 0.0), 0.0, 2.0),)
    )


def nested() -> Thing:
    """A small drawer that slides out of the inner side of a swinging door."""
    door = box((0.0, -GAP - BOARD / 2, 0.35), (0.6, BOARD, 0.7))
    bodies = (
        Body("carcass", carcass((0.6, 0.4, 0.7)), at(0, 0, 0), 20.0),
        Body("door", (door,), at(-0.3, -GAP, 0.35), 2.5),
        Body("tray", (box((0.0, 0.06, 0.35), (0.3, 0.1, 0.1)),), at(0.0, 0.06, 0.35), 0.5),
    )
    moves = (
        Move("hinge", "revolute", "carcass", "door", (0.0, 0.0, -1.0), 0.0, 1.57),
        Move("slide", "prismatic", "door", "tray", (0.0, 1.0, 0.0), 0.0, 0.2),
    )
    return Thing("nested", bodies, moves)


def turned() -> Thing:
    """The cabinet, link frames turned: carcass by 90 degrees, door by 180, drawer by both."""
    quarter = np.diag([0.0, 0.0, 1.0, 1.0])
    quarter[:2, :2] = [[0.0, -1.0], [1.0, 0.0]]
    headlong = np.diag([1.0, -1.0, -1.0, 1.0])
    thing = cabinet()
    frames = {"carcass": quarter, "door": headlong, "drawer": headlong @ quarter}
    bodies = tuple(
        replace(body, frame=body.frame @ frames.get(body.name, np.eye(4))) for body in thing.bodies
    )
    return replace(thing, name="turned", bodies=bodies)


def button() -> Thing:
    """A button in a ceiling panel that travels straight down by 5 mm and back: its weight opens it.

    It hangs below its panel, so that nothing but friction holds it.
    """
    bodies = (
        Body("panel", (box((0.0, 0.0, 0.5), (0.2, 0.2, 0.02)),), at(0, 0, 0), 1.0),
        Body("button", (box((0.0, 0.0, 0.47), (0.03, 0.03, 0.01)),), at(0.0, 0.0, 0.48), 0.02),
    )
    moves = (Move("press", "prismatic", "panel", "button", (0.0, 0.0, -1.0), 0.0, 0.005),)
    return Thing("button", bodies, moves)


GOOD = (cabinet, kiosk, fridge, oven, laptop, nested, turned, button)
