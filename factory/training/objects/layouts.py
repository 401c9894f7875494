"""How a front is divided into cells.

A cell holds a ``drawer``, a ``pullout`` (a tall drawer with shelves), a ``door``, a ``double``
door, a ``lift`` (hinged at its top), a ``flap`` (at its bottom), two ``sliding`` doors, a ``fixed``
panel, or is ``open``.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .solids import Span

#: What fills a cell (a name), or how it is cut: ``h`` left to right, ``v`` bottom to top, with
#: shares.
Node = str | tuple[str, tuple[tuple[float, "Node"], ...]]
#: Edges of a cell, in this order wherever something is given per edge.


@dataclass(frozen=True)
class Cell:
    """A rectangle of the front.

    Attributes:
        kind: what fills it.
        x, z: up to the middle of the boards around it, or to the outside of the case [m].
        walls: how much of each edge is board [m].
        outer: whether each edge is the case's own.
    """

    kind: str
    x: Span
    z: Span
    walls: tuple[float, ...]
    outer: tuple[bool, ...]

    @property
    def inner(self) -> tuple[Span, Span]:
        """Free spans between the boards, x and z [m]."""
        left, right, bottom, top = self.walls
        return (self.x[0] + left, self.x[1] - right), (self.z[0] + bottom, self.z[1] - top)


@dataclass(frozen=True)
class Divider:
    """A board between cells: upright at x = ``at`` or lying at z = ``at``, over ``span`` [m]."""

    upright: bool
    at: float
    span: Span


#: Half the space left where two drawers have no board between them [m].
BARE = 0.001


def divided(
    node: Node, x: Span, z: Span, board: float, bare: bool
) -> tuple[list[Cell], list[Divider]]:
    """The cells of a front and the boards between them.

    Args:
        node: the whole front.
        x: outer span of the case [m].
        z: outer span of the case [m].
        board: thickness of every board [m].
        bare: whether stacked drawers do without boards between them.
    """
    return _cut(node, x, z, (board,) * 4, (True,) * 4, (board, bare))


def _cut(
    node: Node,
    x: Span,
    z: Span,
    walls: tuple[float, ...],
    outer: tuple[bool, ...],
    boards: tuple[float, bool],
) -> tuple[list[Cell], list[Divider]]:
    if isinstance(node, str):
        return [Cell(node, x, z, walls, outer)], []
    way, children = node
    low, high = (0, 1) if way == "h" else (2, 3)
    span = x if way == "h" else z
    total = sum(share for share, _ in children)
    cuts = span[0] + (span[1] - span[0]) * np.cumsum(
        [0.0, *(share / total for share, _ in children)]
    )
    cells: list[Cell] = []
    dividers: list[Divider] = []
    thin = [
        boards[1] and way == "v" and a == b == "drawer" for (_, a), (_, b) in pairwise(children)
    ]
    for i, (_, child) in enumerate(children):
        edges, mine = list(walls), list(outer)
        if i:
            edges[low], mine[low] = BARE if thin[i - 1] else boards[0] / 2, False
            if not thin[i - 1]:
                dividers.append(Divider(way == "h", float(cuts[i]), z if way == "h" else x))
        if i < len(children) - 1:
            edges[high], mine[high] = BARE if thin[i] else boards[0] / 2, False
        piece = (float(cuts[i]), float(cuts[i + 1]))
        parts = _cut(
            child,
            piece if way == "h" else x,
            z if way == "h" else piece,
            tuple(edges),
            tuple(mine),
            boards,
        )
        cells += parts[0]
        dividers += parts[1]
    return cells, dividers


def stack(*children: tuple[float, Node]) -> Node:
    """Cells upon each other, bottom first, with their shares."""
    return ("v", children)


def row(*children: tuple[float, Node]) -> Node:
    """Cells beside each other, left first, with their shares."""
    return ("h", children)


def drawers(rng: np.random.Generator, count: int) -> Node:
    """Drawers upon each other: equal, or lower ones taller."""
    if count == 1:
        return "drawer"
    taper = float(rng.choice([0.0, 0.0, rng.uniform(0.03, 0.3)]))
    shallow_top = rng.random() < 0.2
    shares = [1.0 - taper * i for i in range(count)]
    shares = [max(0.35, s) for s in shares]
    if shallow_top:
        shares[-1] *= 0.6
    return ("v", tuple((s, "drawer") for s in shares))


def grid(rng: np.random.Generator, columns: int, rows: int, kind: str = "drawer") -> Node:
    """Equal cells in rows and columns; the cuts are upright first or lying first."""
    if columns == 1:
        return ("v", tuple((1.0, kind) for _ in range(rows))) if rows > 1 else kind
    if rows == 1:
        return ("h", tuple((1.0, kind) for _ in range(columns)))
    if rng.random() < 0.5:
        return (
            "h",
            tuple((1.0, ("v", tuple((1.0, kind) for _ in range(rows)))) for _ in range(columns)),
        )
    return (
        "v",
        tuple((1.0, ("h", tuple((1.0, kind) for _ in range(columns)))) for _ in range(rows)),
    )


def filling(rng: np.random.Generator, width: float, height: float, mix: dict[str, float]) -> Node:
    """What one cell of that size [m] is filled with, drawn by the weights of ``mix`` where it fits."""
    fits = {
        "drawer": height < 0.5 and 0.12 < width < 1.3 and height > 0.06,
        "drawers": 0.24 < height < 1.1 and 0.2 < width < 1.2,
        "door": height > 0.22 and 0.15 < width < 0.75,
        "double": height > 0.22 and 0.42 < width < 1.5,
        "lift": 0.15 < height < 0.6 and width > 0.25,
        "flap": 0.15 < height < 0.6 and width > 0.25,
        "sliding": height > 0.25 and width > 0.5,
        "open": True,
        "fixed": True,
        "pullout": height > 0.4 and 0.14 < width < 0.45,
    }
    names = [name for name in mix if fits[name] and mix[name] > 0.0] or ["open"]
    weight = np.array([mix.get(n, 1.0) for n in names])
    kind = names[int(rng.choice(len(names), p=weight / weight.sum()))]
    if kind == "drawers":
        most = max(2, min(6, int(height / 0.1)))
        return drawers(
            rng, int(rng.integers(2, most + 1)) if height < 0.7 else int(rng.integers(3, most + 1))
        )
    return kind


def leaves(node: Node) -> int:
    """How many cells a front is divided into."""
    return 1 if isinstance(node, str) else sum(leaves(child) for _, child in node[1])


def random_node(
    rng: np.random.Generator, width: float, height: float, mix: dict[str, float], depth: int = 3
) -> Node:
    """A front of ``width`` by ``height`` [m], cut again and again until its cells have a handy size."""
    wide, tall = width > 0.65, height > 0.75
    stop = 0.25 if wide or tall else 0.75
    if depth == 0 or (width < 0.36 and height < 0.36) or rng.random() < stop:
        return filling(rng, width, height, mix)
    across = width * float(rng.uniform(0.6, 1.6)) > height
    size = width if across else height
    count = int(min(4, max(2, round(size / float(rng.uniform(0.3, 0.6))))))
    even = rng.random() < 0.6
    shares = np.ones(count) if even else rng.uniform(0.5, 1.5, count)
    shares = shares / shares.sum()
    if even and rng.random() < 0.35:
        part = (width / count, height) if across else (width, height / count)
        child = random_node(rng, *part, mix, depth - 1)
        return ("h" if across else "v", tuple((1.0, child) for _ in range(count)))
    children = tuple(
        (
            float(s),
            random_node(
                rng,
                width * s if across else width,
                height if across else height * s,
                mix,
                depth - 1,
            ),
        )
        for s in shares
    )
    return ("h" if across else "v", children)
