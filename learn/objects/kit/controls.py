"""Knobs, levers, buttons and keys on a face; where the face is, its place says."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from asset_factory.factory.mesh import Material

from .assembly import Assembly, PartDraft
from .axes import BACK, Place, Y
from .looks import BLACK, RED, STEEL, WHITE
from .shapes import Form, block, box, cylinder, lathe, pipe
from .spans import PLAY, Flat, Span, about, between, mid, shares, size, span, within

#: How far knobs turn [rad], unless said otherwise.
TURNS = (np.pi / 2, np.pi, 1.5 * np.pi, 5.2)


def knob(
    a: Assembly,
    name: str,
    at: tuple[float, float],
    radius: float,
    look: Material,
    place: Place,
    *,
    mark: Material = BLACK,
    on: PartDraft | None = None,
    upper: float | None = None,
) -> PartDraft:
    """Return a knob about ``at`` on a face: plain with a mark, stepped, or with a grip across it.

    It turns clockwise by ``upper`` [rad], any of :data:`TURNS` if not given.
    """
    x, z = at
    play = 2 * PLAY if a.hairline else PLAY
    depth = a.draw(0.6, 1.4) * radius
    sides = a.pick(12, 16, 24)
    style = a.count(0, 2)
    part = a.hinge(name, BACK, (x, 0.0, z), upper or a.pick(*TURNS), on=on, look=look, place=place)
    rim = -play - depth
    middle = (x, 0.0, z)
    if style == 0:
        part.add(lathe([(0.85 * radius, rim), (radius, -play)], middle, Y, sides))
        pointer = box(about(0.08 * radius, x), about(0.001, rim), (z, z + 0.8 * radius))
        part.add(pointer, look=mark)
        return part
    step = -play - 0.33 * depth
    part.add(cylinder(Y, at, radius, (step, -play), sides))
    if style == 1:
        part.add(lathe([(0.6 * radius, rim), (0.65 * radius, step)], middle, Y, sides))
    else:
        part.add(box(about(0.2 * radius, x), (rim, step), about(0.95 * radius, z)))
    return part


def lever(at: Flat, y: Span, tip: Flat, radius: float) -> list[Form]:
    """Build a stem through a face at ``at``, and at its end an arm to ``tip``.

    Of ``y``, the first is where the stem begins, the second where the arm ends [m].
    """
    x, z = at
    middle = y[1] + (radius if y[1] < y[0] else -radius)
    arm = pipe([(x, middle, z), (tip[0], middle, tip[1])], 0.8 * radius, 8, up=BACK)
    return [cylinder(Y, at, radius, span(y[0], y[1] - y[0]), 12), arm]


def knob_row(
    a: Assembly, x: Span, z: float, height: float, looks: tuple[Material, ...], place: Place,
    prefix: str = "",
) -> None:  # fmt: skip
    """Add two to eight knobs over ``x`` at ``z``, even or in two groups, in some height [m].

    Looks are those of the knobs and of their marks.
    """
    count = a.count(2, 8)
    radius = min(0.42 * height, a.draw(0.014, 0.026), 0.4 * size(x) / count)
    places = np.linspace(*within(x, 1.5 * radius), count)
    if count >= 4 and a.happens(0.4):
        places = places[np.abs(places - mid(x)) > 0.12 * size(x)]
    for i, at in enumerate(places.tolist()):
        knob(a, f"{prefix}knob_{i}", (at, z), radius, looks[0], place, mark=looks[1])


def key(x: Span, z: Span, proud: Span, style: float) -> Form:
    """Return a key on the plane y = 0, square for ``style`` 0, round for 1 and rounded in between.

    ``proud`` is how far its underside and its top stand out [m].
    """
    y = (-proud[1], -proud[0])
    half = min(size(x), size(z)) / 2
    if style >= 1.0:
        return cylinder(Y, (mid(x), mid(z)), half, y, 16)
    return block(x, y, z, style * half, axis=Y) if style > 0.0 else box(x, y, z)


def button(
    a: Assembly,
    name: str,
    x: Span,
    z: Span,
    look: Material,
    place: Place,
    *,
    stroke: float = 0.002,
    thick: float = 0.004,
    style: float = 1.0,
    on: PartDraft | None = None,
) -> PartDraft:
    """Add a button, see :func:`key`, that goes in by ``stroke`` [m], then ``thick`` proud."""
    part = a.slider(name, BACK, (mid(x), 0.0, mid(z)), stroke, on=on, look=look, place=place)
    part.add(key(x, z, span(stroke + 0.0003, thick), style))
    return part


def control(
    a: Assembly,
    number: int,
    at: Flat,
    radius: float,
    look: Material,
    place: Place,
    turned: float,
) -> None:
    """Build a knob about ``at`` in a share ``turned`` of cases, else a button."""
    if a.happens(turned):
        knob(a, f"knob_{number}", at, radius, look, place, upper=a.degrees(90, 300))
        return
    x, z = (about(0.6 * radius, v) for v in at)
    style = a.draw(0.2, 1.2)
    button(a, f"button_{number}", x, z, look, place, stroke=0.0025, style=style)


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
    if still or a.happens(0.65):
        style = a.pick(0.0, 0.0, 1.0)
        thick = a.draw(0.001, 0.0025)
        for i, (_, key_x, key_z) in enumerate(cells(x, z, a.count(2, 6), a.count(2, 3))):
            if still:
                a.root.add(key(key_x, key_z, (0.0, thick), style).moved(place), look=WHITE)
                continue
            name = f"button_{i}"
            button(a, name, key_x, key_z, WHITE, place, thick=thick, style=style, on=on)
        return
    count = a.count(1, 2)
    radius = min(0.35 * size(x), 0.024, 0.45 * size(z) / (count + 2))
    long_key = about(radius, mid(x))
    button(a, "button_0", long_key, span(z[0], 0.015), WHITE, place, style=0.0, on=on)
    for i, level in enumerate(between(z, count + 1)[1:]):
        knob(a, f"knob_{i}", (mid(x), level), radius, STEEL, place, mark=RED, on=on)
