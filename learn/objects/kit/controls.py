"""Knobs, levers, buttons and keys on a face; where the face is, its place says."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from asset_factory.factory.mesh import Material

from .assembly import Assembly, PartDraft
from .axes import BACK, Place, Y
from .looks import BLACK, RED, STEEL, WHITE
from .shapes import Form, block, box, cylinder, lathe, pipe
from .spans import PLAY, Flat, Span, about, between, mid, shares, size, span, within

#: How far knobs turn [rad], unless said otherwise.
TURNS = (np.pi / 2, np.pi, 1.5 * np.pi, 5.2)


@dataclass(frozen=True)
class ControlPanel:
    """A face of an object that controls sit on.

    Attributes:
        a: the object.
        place: of the face.
        look, mark: of controls, and of the marks on knobs.
        on: the part that controls hang on; the body if not given.
    """

    a: Assembly
    place: Place
    look: Material
    mark: Material = BLACK
    on: PartDraft | None = None

    def knob(self, name: str, at: Flat, radius: float, upper: float | None = None) -> PartDraft:
        """Return a knob about ``at``: plain with a mark, stepped, or with a grip across it.

        It turns clockwise by ``upper`` [rad], any of :data:`TURNS` if not given.
        """
        a = self.a
        x, z = at
        middle = (x, 0.0, z)
        play = 2 * PLAY if a.hairline else PLAY
        depth = a.draw(0.6, 1.4) * radius
        sides = a.pick(12, 16, 24)
        style = a.count(0, 2)
        turn = upper or a.pick(*TURNS)
        part = a.hinge(name, BACK, middle, turn, on=self.on, look=self.look, place=self.place)
        rim = -play - depth
        if style == 0:
            part.add(lathe([(0.85 * radius, rim), (radius, -play)], middle, Y, sides))
            pointer = box(about(0.08 * radius, x), about(0.001, rim), (z, z + 0.8 * radius))
            part.add(pointer, look=self.mark)
            return part
        step = -play - 0.33 * depth
        part.add(cylinder(Y, at, radius, (step, -play), sides))
        if style == 1:
            part.add(lathe([(0.6 * radius, rim), (0.65 * radius, step)], middle, Y, sides))
        else:
            part.add(box(about(0.2 * radius, x), (rim, step), about(0.95 * radius, z)))
        return part

    def knob_row(self, x: Span, z: float, height: float, prefix: str = "") -> None:
        """Add two to eight knobs over ``x`` at ``z``, even or in two groups, in a height [m]."""
        count = self.a.count(2, 8)
        radius = min(0.42 * height, self.a.draw(0.014, 0.026), 0.4 * size(x) / count)
        places = np.linspace(*within(x, 1.5 * radius), count)
        if count >= 4 and self.a.happens(0.4):
            places = places[np.abs(places - mid(x)) > 0.12 * size(x)]
        for i, at in enumerate(places.tolist()):
            self.knob(f"{prefix}knob_{i}", (at, z), radius)

    def button(
        self, name: str, x: Span, z: Span, stroke: float = 0.002, thick: float = 0.004,
        style: float = 1.0,
    ) -> PartDraft:  # fmt: skip
        """Add a button, see :func:`key`, that goes in by ``stroke`` [m], then ``thick`` proud."""
        at = (mid(x), 0.0, mid(z))
        part = self.a.slider(name, BACK, at, stroke, on=self.on, look=self.look, place=self.place)
        part.add(key(x, z, span(stroke + 0.0003, thick), style))
        return part

    def control(self, number: int, at: Flat, radius: float, turned: float) -> None:
        """Build a knob about ``at`` in a share ``turned`` of cases, else a button."""
        if self.a.happens(turned):
            self.knob(f"knob_{number}", at, radius, self.a.degrees(90, 300))
            return
        x, z = (about(0.6 * radius, v) for v in at)
        style = self.a.draw(0.2, 1.2)
        self.button(f"button_{number}", x, z, stroke=0.0025, style=style)


def lever(at: Flat, y: Span, tip: Flat, radius: float) -> list[Form]:
    """Build a stem through a face at ``at``, and at its end an arm to ``tip``.

    Of ``y``, the first is where the stem begins, the second where the arm ends [m].
    """
    x, z = at
    middle = y[1] + (radius if y[1] < y[0] else -radius)
    arm = pipe([(x, middle, z), (tip[0], middle, tip[1])], 0.8 * radius, 8, up=BACK)
    return [cylinder(Y, at, radius, span(y[0], y[1] - y[0]), 12), arm]


def key(x: Span, z: Span, proud: Span, style: float) -> Form:
    """Return a key on the plane y = 0, square for ``style`` 0, round for 1 and rounded in between.

    ``proud`` is how far its underside and its top stand out [m].
    """
    y = (-proud[1], -proud[0])
    half = min(size(x), size(z)) / 2
    if style >= 1.0:
        return cylinder(Y, (mid(x), mid(z)), half, y, 16)
    return block(x, y, z, style * half, axis=Y) if style > 0.0 else box(x, y, z)


def cells(
    x: Span, z: Span, rows: int, columns: int, margin: float = 0.1
) -> Iterator[tuple[str, Span, Span]]:
    """Return names and places of rows and columns of keys, less a share at every edge."""
    for r, high in enumerate(shares(z, rows)):
        for c, wide in enumerate(shares(x, columns)):
            yield f"{r}_{c}", within(wide, margin * size(wide)), within(high, margin * size(high))


def keypad(
    a: Assembly, x: Span, z: Span, place: Place, on: PartDraft | None = None, still: bool = False
) -> None:
    """Build a pad of keys, or one or two knobs over a long key; ``still`` ones do not move."""
    panel = ControlPanel(a, place, WHITE, on=on)
    if still or a.happens(0.65):
        style = a.pick(0.0, 0.0, 1.0)
        thick = a.draw(0.001, 0.0025)
        for i, (_, key_x, key_z) in enumerate(cells(x, z, a.count(2, 6), a.count(2, 3))):
            if still:
                a.root.add(key(key_x, key_z, (0.0, thick), style).moved(place), look=WHITE)
            else:
                panel.button(f"button_{i}", key_x, key_z, thick=thick, style=style)
        return
    count = a.count(1, 2)
    radius = min(0.35 * size(x), 0.024, 0.45 * size(z) / (count + 2))
    panel.button("button_0", about(radius, mid(x)), span(z[0], 0.015), style=0.0)
    for i, level in enumerate(between(z, count + 1)[1:]):
        replace(panel, look=STEEL, mark=RED).knob(f"knob_{i}", (mid(x), level), radius)
