"""Cases with doors, drawers and shelves: what kitchens, wardrobes and windows have in common."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from asset_factory.factory.mesh import Material

from .assembly import EDGES, Assembly, PartDraft
from .axes import DOWN, FRONT, LEFT, RIGHT, UP, X, facing_front
from .boards import carcass, stand, tray
from .hinges import stop, swing
from .layouts import Cell, Node, divided
from .panels import panel
from .pulls import add_pull
from .shapes import box, cylinder
from .spans import Span, about, between, mid, shares, size, span, within
from .styles import Style


@dataclass(frozen=True)
class _Front:
    """A front and the room around it: left, right, bottom, top [m]."""

    x: Span
    z: Span
    rooms: tuple[float, ...]


class Leaf(NamedTuple):
    """What turns in a case: its hinge is at a ``side``, its panel spans x and z [m].

    Of two leaves before one cell, each closes its half of it.
    """

    part: PartDraft
    cell: Cell
    side: str
    x: Span
    z: Span


@dataclass
class Casework:
    """A case under construction, its outer spans [m] without fronts that lie on it.

    Its front is divided into ``cells``; ``doors`` are what turns, ``count`` is of all that moves.
    The names of its parts start with ``prefix``.
    """

    a: Assembly
    style: Style
    x: Span
    y: Span
    z: Span
    prefix: str = ""
    cells: list[Cell] = field(default_factory=list)
    doors: list[Leaf] = field(default_factory=list)
    count: int = 0

    @property
    def face(self) -> float:
        """Return where the faces of the fronts lie, on y [m]."""
        return self.y[0] - self.style.proud

    @property
    def start(self) -> float:
        """Return where the room behind the fronts begins [m]."""
        return self.face + self.style.front + self.style.behind if self.style.inset else self.y[0]

    def _name(self, cell: Cell, kind: str) -> str:
        self.count += 1
        return self.prefix + (cell.name or f"{kind}_{self.count - 1}")

    def build(self, node: Node) -> Casework:
        """Return the case with its boards and all that moves; ``node`` divides its front."""
        style = self.style
        body = self.a.root
        self.cells, dividers = divided(node, self.x, self.z, style.board, style.bare)
        deep = within(self.y, 0.0 if style.inset else 0.0005, 0.004)
        *boards, back = carcass(self.x, self.y, self.z, style.board, sill=style.sill)
        body.add(*boards, look=style.body)
        body.add(*([] if style.backless else [back]), look=style.inside)
        body.add(*(box(x, deep, z) for x, z in dividers), look=style.body)
        for cell in self.cells:
            if not (style.hollow or cell.kind == "open"):
                x, z = cell.inner
                body.add(box(x, (self.start, self.y[1]), z), look=style.body)
            self._fill(cell)
        return self

    def _front(self, cell: Cell) -> _Front:
        style = self.style
        if style.inset:
            x, z = (within(inner, style.gap) for inner in cell.inner)
            return _Front(x, z, (style.gap,) * 4)
        margin = [style.reveal if outer else style.gap / 2 for outer in cell.outer]
        rooms = [float("inf") if outer else style.gap for outer in cell.outer]
        if style.covered and cell.outer[3]:
            rooms[3] = style.reveal
        if style.crowded:
            margin[:2] = [max(edge, style.gap / 2) for edge in margin[:2]]
            rooms[:2] = [style.gap, style.gap]
        return _Front(within(cell.x, *margin[:2]), within(cell.z, *margin[2:]), tuple(rooms))

    def _fill(self, cell: Cell) -> None:
        """Add a cell's boards and its parts."""
        style = self.style
        front = self._front(cell)
        kind = "double" if cell.kind == "sliding" and not style.hollow else cell.kind
        if kind in ("drawer", "pullout"):
            self._drawer(cell, front)
            return
        if kind == "fixed":
            y = span(self.face, style.front)
            panel(self.a.root, style.drawer, front.x, y, front.z, style.rail, style.face)
            return
        if style.hollow or kind == "open":
            self._furnish(cell, kind)
        if kind == "door":
            side = self.a.pick("left", "right")
            if cell.outer[0] != cell.outer[1] and self.a.happens(0.75):
                side = "left" if cell.outer[0] else "right"
            self._door(cell, front, side)
        elif kind == "double":
            self._pair(cell, front)
        elif kind in ("sliding", "hung"):
            self._sliders(cell)
        elif kind != "open":
            self._door(cell, front, "top" if kind == "lift" else "bottom")

    def _pair(self, cell: Cell, front: _Front) -> None:
        """Build two doors; their seam may lie off the middle."""
        left, right, *others = front.rooms
        gap = self.style.gap
        seam = mid(front.x) + self.a.pick(0.0, 0.0, self.a.draw(-0.1, 0.1)) * size(front.x)
        one = _Front((front.x[0], seam - gap / 2), front.z, (left, gap, *others))
        other = _Front((seam + gap / 2, front.x[1]), front.z, (gap, right, *others))
        apart = self.style.board / 2
        self._door(cell.piece(0, (cell.x[0], seam), None, apart), one, "left")
        self._door(cell.piece(0, (seam, cell.x[1]), apart, None), other, "right")

    def _door(self, cell: Cell, front: _Front, side: str) -> None:
        style = self.style
        upright = side in ("left", "right")
        near = list(EDGES).index(side)
        rooms = (front.rooms[near], front.rooms[near ^ 1])
        furthest = 170.0 if np.isinf(rooms[0]) else 92.0
        stopped = style.covered and not upright
        behind = style.taste > 0.5 and (style.reveal > 0.0 or side == "bottom")
        if style.inset or stopped or behind:
            furthest = 90.0
        width = size(front.x if upright else front.z)
        turn = swing(style.front, width, rooms, style.taste)
        margins = [0.0] * 4
        margins[near ^ 1] = turn.trim
        x = within(front.x, *margins[:2])
        z = within(front.z, *margins[2:])
        name = self._name(cell, "door" if upright else "flap")
        depth = self.face + turn.setback
        upper = stop(self.a, furthest)
        door = self.a.swung(name, side, x, z, depth, upper, look=style.face)
        self.doors.append(Leaf(door, cell, side, x, z))
        kind = style.upper if sum(cell.z) > sum(self.z) else style.panel
        panel(door, kind, x, span(self.face, style.front), z, style.rail)
        margin = min(max(0.5 * style.rail, 0.02), 0.4 * width)
        place = facing_front(self.face)
        if not upright:
            level = z[1] - margin if side == "bottom" else z[0] + margin
            add_pull(door, style.pull, (mid(x), level), place, 0.8 * size(x))
            return
        at = x[1] - margin if side == "left" else x[0] + margin
        reach = 0.02
        if style.pull.kind not in ("knob", "ball"):
            reach = 0.55 * min(style.pull.length, 0.8 * size(z))
        level = min(max(z[0] + style.pull_at * size(z), z[0] + reach), z[1] - reach)
        add_pull(door, style.pull, (at, level), place, 0.8 * size(z), True)

    def _drawer(self, cell: Cell, front: _Front) -> None:
        style = self.style
        inside = within((self.start, self.y[1]), 0.002, 0.008)
        reach = size(inside) * self.a.draw(0.75, 0.97)
        at = (mid(front.x), self.face, mid(front.z))
        travel = round(style.slide * reach, 3)
        drawer = self.a.slider(self._name(cell, "drawer"), FRONT, at, travel, look=style.face)
        panel(drawer, style.drawer, front.x, span(self.face, style.front), front.z, style.rail)
        z = front.z
        level = min(max(z[0] + style.drawer_pull_at * size(z), z[0] + 0.02), z[1] - 0.02)
        if style.pull.kind == "lip":
            level = z[1] - 0.013
        places = (0.25, 0.75) if style.pairs and size(front.x) > 0.5 else (0.5,)
        place = facing_front(self.face)
        for share in places if size(z) >= 0.045 else ():
            spot = (front.x[0] + share * size(front.x), level)
            add_pull(drawer, style.pull, spot, place, size(front.x) / len(places))
        if style.hollow and size(cell.inner[1]) > 0.03:
            self._drawer_box(drawer, cell, (self.face + style.front, inside[0] + reach))

    def _drawer_box(self, drawer: PartDraft, cell: Cell, y: Span) -> None:
        """Build bottom, sides and back behind a drawer's front, or a block."""
        look = self.style.inside
        inner_x, inner_z = cell.inner
        x = within(inner_x, self.a.pick(0.002, 0.006, 0.0125) if size(inner_x) > 0.1 else 0.002)
        pullout = cell.kind == "pullout"
        low = inner_z[0] + 0.004
        share = self.a.draw(0.3, 0.55) if pullout else self.a.draw(0.55, 0.9)
        z = span(low, share * (inner_z[1] - low))
        if self.style.solid:
            drawer.add(box(x, y, z), look=look)
            return
        t = min(self.a.pick(0.006, 0.01, 0.014), 0.2 * size(z))
        drawer.add(*tray(x, y, z, t, front=False), look=look)
        if pullout:
            above = (z[1], inner_z[1] - 0.01)
            drawer.add(box(x, span(y[1], -t), above), look=look)
            drawer.add(*(box(x, y, span(v, t)) for v in between(above, 2)), look=look)

    def _furnish(self, cell: Cell, kind: str) -> None:
        """Build shelves, a partition or a clothes rod in a cell."""
        x, z = cell.inner
        body = self.a.root
        look = self.style.inside
        t = self.style.board
        deep = (self.start + (0.052 if kind == "sliding" else 0.002), self.y[1] - 0.008)
        if self.style.shelves and size(z) > 0.9 and self.a.happens(0.3):
            body.add(cylinder(X, (mid(deep), z[1] - 0.12), 0.012, x, 10), look=look)
            if self.a.happens(0.5):
                body.add(box(x, deep, span(z[0] + 0.25, t)), look=look)
            return
        most = min(self.style.shelves, int(size(z) / 0.12))
        deep = within(deep, 0.002 if kind == "open" else self.a.pick(0.002, 0.012, 0.042), 0.0)
        count = most if kind == "open" else self.a.count(0, most)
        body.add(*(box(x, deep, about(t / 2, v)) for v in between(z, count)), look=look)
        if most and size(x) > 0.6 and self.a.happens(0.3):
            body.add(box(about(t / 2, mid(x)), deep, z), look=look)

    def _sliders(self, cell: Cell) -> None:
        """Build panels that cover an opening together; of three, or of ``hung`` ones, one may stay.

        A case has two tracks, a frame as many as are in its depth, three at most.
        """
        style = self.style
        upright = cell.kind == "hung"
        spans = [within(inner, 0.001) for inner in cell.inner]
        way = spans[upright]
        t = min(style.front, 0.04 if style.backless else 0.018)
        count = 2 if not style.backless or upright else min(3, int(size(self.y) / (t + 0.004)))
        stays = count == 3 or (upright and self.a.happens(0.5))
        lap = self.a.draw(0.005, 0.04)
        seen = style.backless or style.panel in ("glazed", "mullion", "planks", "shaker")
        name = self._name(cell, "slider")
        for i, share in enumerate(shares(way, count)):
            last = i == count - 1
            own = spans[upright] = within(share, -lap if i else 0.0, 0.0 if last else -lap)
            x, z = spans
            y = span(self.y[0] + 0.006 + i * (t + 0.002), t)
            part = self.a.root
            if not (last and stays):
                room = min(own[0] - way[0] if last else way[1] - own[1], size(own))
                axis = (LEFT, DOWN) if last else (RIGHT, UP)
                travel = round(room * self.a.draw(0.85, 1.0), 3)
                at = (mid(x), y[0], mid(z))
                part = self.a.slider(f"{name}_{i}", axis[upright], at, travel, look=style.face)
            rail = style.rail if style.backless else min(style.rail, 0.05)
            panel(part, style.panel if seen else "slab", x, y, z, rail, style.face)
            if not (i or upright) and style.pull.kind in ("recess", "bar", "rail", "knob"):
                spot = (x[0] + 0.04, mid(z))
                add_pull(part, style.pull, spot, facing_front(y[0]), 0.5 * size(z), True)


def furniture(
    a: Assembly,
    style: Style,
    sizes: tuple[float, ...],
    node: Node,
    support: str,
    base: float,
    look: Material | None = None,
) -> Casework:
    """Build a case of a width, depth and height [m] on a support; its left edge is x = y = 0."""
    width, depth, height = sizes
    case = Casework(a, style, (0.0, width), (0.0, depth), span(base, height)).build(node)
    stand(a, support, case.x, case.y, base, look or style.body)
    return case
