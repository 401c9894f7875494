"""How a front is divided into cells.

A cell holds a ``drawer``, a ``pullout`` (a tall drawer with shelves), a ``door``, a ``double``
door, a ``lift`` (hinged at its top), a ``flap`` (at its bottom), ``sliding`` doors or ``hung`` ones
(which slide up and down), a ``fixed`` panel, or is ``open``. Written as ``flap:door``, the part
that moves in it is called ``door``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from .chance import Chance
from .spans import Span, about, within

#: What fills a cell (a name), or its cut, ``h`` left to right or ``v`` bottom up, with shares.
Node = str | tuple[str, tuple[tuple[float, "Node"], ...]]
#: Half the space left where two drawers have no board between them [m].
BARE = 0.001


@dataclass(frozen=True)
class Cell:
    """A rectangle of the front; values per edge come left, right, bottom, top.

    Attributes:
        kind: of the part in it.
        name: of the moving part; made up if empty.
        x, z: up to the middle of the boards around it, or to the outside of the case [m].
        walls: how much of each edge is board [m].
        outer: whether each edge is the case's own.
    """

    kind: str
    name: str
    x: Span
    z: Span
    walls: tuple[float, ...]
    outer: tuple[bool, ...]

    @property
    def inner(self) -> tuple[Span, Span]:
        """Return free spans between the boards, x and z [m]."""
        left, right, bottom, top = self.walls
        return (self.x[0] + left, self.x[1] - right), (self.z[0] + bottom, self.z[1] - top)

    def piece(self, along: int, own: Span, *walls: float | None) -> Cell:
        """Return the part over a span of x (``along`` 0) or z (1), between ``walls`` of board [m].

        ``None``: it ends where the cell does.
        """
        inner = {2 * along + end: wall for end, wall in enumerate(walls) if wall is not None}
        x, z = (self.x, own) if along else (own, self.z)
        edges = tuple(inner.get(edge, wall) for edge, wall in enumerate(self.walls))
        outer = tuple(mine and edge not in inner for edge, mine in enumerate(self.outer))
        return replace(self, x=x, z=z, walls=edges, outer=outer)


def divided(
    node: Node, x: Span, z: Span, board: float, bare: bool
) -> tuple[list[Cell], list[tuple[Span, Span]]]:
    """Return the cells of a front and the boards between them, each by its spans across x and z.

    Spans are the outer ones of the case [m]; ``board`` is the thickness of every board [m]. Stacked
    drawers of a ``bare`` case do without boards between them.
    """
    cells: list[Cell] = []
    boards: list[tuple[Span, Span]] = []

    def cut(node: Node, cell: Cell) -> None:
        if isinstance(node, str):
            kind, _, name = node.partition(":")
            cells.append(replace(cell, kind=kind, name=name))
            return
        way, children = node
        along = 0 if way == "h" else 1
        span, other = (cell.x, cell.z)[:: 1 - 2 * along]
        parts = np.cumsum([0.0, *(share for share, _ in children)])
        ends = (span[0] + (span[1] - span[0]) * parts / parts[-1]).tolist()
        thin = [bare and way == "v" and a == b == "drawer" for (_, a), (_, b) in pairwise(children)]
        walls = [None, *(BARE if each else board / 2 for each in thin), None]
        for i, (_, child) in enumerate(children):
            if i and not thin[i - 1]:
                seen = (about(board / 2, ends[i]), within(other, board / 2))
                boards.append(seen if way == "h" else seen[::-1])
            cut(child, cell.piece(along, (ends[i], ends[i + 1]), walls[i], walls[i + 1]))

    cut(node, Cell("", "", x, z, (board,) * 4, (True,) * 4))
    return cells, boards


def column(*children: tuple[float, Node]) -> Node:
    """Return the cells upon each other, bottom first, with their shares."""
    return children[0][1] if len(children) == 1 else ("v", children)


def row(*children: tuple[float, Node]) -> Node:
    """Return the cells beside each other, left first, with their shares."""
    return children[0][1] if len(children) == 1 else ("h", children)


def drawers(chance: Chance, count: int) -> Node:
    """Return the drawers upon each other: equal, or lower ones taller."""
    taper = chance.pick(0.0, 0.0, chance.draw(0.03, 0.3))
    heights = [max(0.35, 1.0 - taper * i) for i in range(count)]
    if count > 1 and chance.happens(0.2):
        heights[-1] *= 0.6
    return column(*((height, "drawer") for height in heights))


def grid(chance: Chance, columns: int, rows: int, kind: str = "drawer") -> Node:
    """Return equal cells in rows and columns; the cuts are upright first or lying first."""
    if chance.happens(0.5):
        return row(*((1.0, column(*((1.0, kind),) * rows)),) * columns)
    return column(*((1.0, row(*((1.0, kind),) * columns)),) * rows)


def filling(chance: Chance, width: float, height: float, mix: Mapping[str, float]) -> Node:
    """Return what a cell of that size [m] holds, drawn by the weights of ``mix`` where it fits."""
    fits = {
        "drawer": 0.06 < height < 0.5 and 0.12 < width < 1.3,
        "drawers": 0.24 < height < 1.1 and 0.2 < width < 1.2,
        "door": height > 0.22 and 0.15 < width < 0.75,
        "double": height > 0.22 and 0.42 < width < 1.5,
        "lift": 0.15 < height < 0.6 and width > 0.25,
        "flap": 0.15 < height < 0.6 and width > 0.25,
        "sliding": height > 0.25 and width > 0.5,
        "pullout": height > 0.4 and 0.14 < width < 0.45,
    }
    fitting = {kind: weight for kind, weight in mix.items() if fits.get(kind, True) and weight}
    kind = chance.weighted(fitting or {"open": 1.0})
    if kind != "drawers":
        return kind
    most = max(2, min(6, int(height / 0.1)))
    return drawers(chance, chance.count(2 if height < 0.7 else 3, most))


def random_node(
    chance: Chance, width: float, height: float, mix: Mapping[str, float], depth: int = 3
) -> Node:
    """Return a front of some width and height [m], cut until its cells have a handy size."""
    stop = 0.25 if width > 0.65 or height > 0.75 else 0.75
    if depth == 0 or max(width, height) < 0.36 or chance.happens(stop):
        return filling(chance, width, height, mix)
    across = width * chance.draw(0.6, 1.6) > height
    count = min(4, max(2, round((width if across else height) / chance.draw(0.3, 0.6))))
    even = chance.happens(0.6)
    cuts = [1.0 if even else chance.draw(0.5, 1.5) for _ in range(count)]

    def child(share: float) -> Node:
        part = share / sum(cuts)
        wide, tall = (width * part, height) if across else (width, height * part)
        return random_node(chance, wide, tall, mix, depth - 1)

    alike = child(1.0) if even and chance.happens(0.35) else None
    children = [(share, alike or child(share)) for share in cuts]
    return row(*children) if across else column(*children)
