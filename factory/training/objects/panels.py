"""Fronts of doors and drawers, in the styles that joiners and appliance makers give them."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from ...mesh import Material
from .pieces import Block, Piece, extruded, frustum
from .solids import Span

#: Narrower than this, a front has no room for a frame [m].
FRAMED_FROM = 0.16


def framed(x: Span, y: Span, z: Span, width: float, material: Material) -> list[Piece]:
    """Two stiles and two rails; see :func:`within` for what they enclose."""
    inner = (x[0] + width, x[1] - width)
    return [
        Block((x[0], inner[0]), y, z, material),
        Block((inner[1], x[1]), y, z, material),
        Block(inner, y, (z[0], z[0] + width), material),
        Block(inner, y, (z[1] - width, z[1]), material),
    ]


def within(span: Span, width: float) -> Span:
    """A span less ``width`` at both ends [m]."""
    return (span[0] + width, span[1] - width)


def _slab(x: Span, y: Span, z: Span, face: Material, glass: Material, width: float) -> list[Piece]:
    return [Block(x, y, z, face)]


def _bevel(x: Span, y: Span, z: Span, face: Material, glass: Material, width: float) -> list[Piece]:
    edge = min(0.006, 0.4 * (y[1] - y[0]))
    top = (within(z, edge), within(x, edge))
    return [
        Block(x, (y[0] + edge, y[1]), z, face),
        frustum(1, top, (z, x), (y[0], y[0] + edge), face),
    ]


def _shaker(
    x: Span, y: Span, z: Span, face: Material, glass: Material, width: float
) -> list[Piece]:
    raised = y[0] + 0.35 * (y[1] - y[0])
    return [Block(x, (raised, y[1]), z, face), *framed(x, (y[0], raised), z, width, face)]


def _raised(
    x: Span, y: Span, z: Span, face: Material, glass: Material, width: float
) -> list[Piece]:
    deep = y[0] + 0.45 * (y[1] - y[0])
    field, slope = (within(z, width + 0.01), within(x, width + 0.01)), 0.02
    tip = (within(field[0], slope), within(field[1], slope))
    pieces: list[Piece] = [Block(within(x, width), (deep, y[1]), within(z, width), face)]
    if min(tip[0][1] - tip[0][0], tip[1][1] - tip[1][0]) > 0.01:
        pieces.append(frustum(1, tip, field, (y[0] + 0.001, deep), face))
    return pieces + framed(x, y, z, width, face)


def _glazed(
    x: Span, y: Span, z: Span, face: Material, glass: Material, width: float
) -> list[Piece]:
    middle = (y[0] + y[1]) / 2
    pane = Block(
        within(x, width - 0.004), (middle - 0.002, middle + 0.002), within(z, width - 0.004), glass
    )
    return [*framed(x, y, z, width, face), pane]


def _mullion(
    x: Span, y: Span, z: Span, face: Material, glass: Material, width: float
) -> list[Piece]:
    pieces = _glazed(x, y, z, face, glass, width)
    columns, rows = (round((s[1] - s[0]) / 0.22) + 1 for s in (x, z))
    inner_x, inner_z, bar = within(x, width), within(z, width), 0.008
    for c in np.linspace(*inner_x, columns + 1)[1:-1]:
        pieces.append(Block((c - bar, c + bar), y, inner_z, face))
    for r in np.linspace(*inner_z, rows + 1)[1:-1]:
        pieces.append(Block(inner_x, y, (r - bar, r + bar), face))
    return pieces


def _louvre(
    x: Span, y: Span, z: Span, face: Material, glass: Material, width: float
) -> list[Piece]:
    inner_z, pieces = within(z, width), framed(x, y, z, width, face)
    count = max(2, min(24, int((inner_z[1] - inner_z[0]) / 0.035)))
    pitch, depth = (inner_z[1] - inner_z[0]) / count, y[1] - y[0]
    low, high = y[0] + 0.1 * depth, y[1] - 0.1 * depth
    for i in range(count):
        base = inner_z[0] + pitch * (i + 0.1)
        # Next axes of x in cyclic order are y and z.
        slat = [
            (low, base),
            (low + 0.006, base),
            (high, base + 0.8 * pitch),
            (high - 0.006, base + 0.8 * pitch),
        ]
        pieces.append(extruded(0, slat, within(x, width), face))
    return pieces


def _planks(
    x: Span, y: Span, z: Span, face: Material, glass: Material, width: float
) -> list[Piece]:
    groove = y[0] + 0.3 * (y[1] - y[0])
    count = max(2, round((x[1] - x[0]) / max(0.05, width)))
    cuts = np.linspace(*x, count + 1)
    planks = [Block((a + 0.0015, b - 0.0015), (y[0], groove), z, face) for a, b in pairwise(cuts)]
    return [Block(x, (groove, y[1]), z, face), *planks]


def _bowed(x: Span, y: Span, z: Span, face: Material, glass: Material, width: float) -> list[Piece]:
    t = np.linspace(-1.0, 1.0, 9)
    bulge = 0.6 * (y[1] - y[0])
    arc_x = (x[0] + x[1]) / 2 + t * (x[1] - x[0]) / 2
    arc_y = y[0] + bulge * t**2
    # Counter-clockwise seen from +z: along the arc in front, back along the rear.
    profile = [*zip(arc_x, arc_y, strict=True), (x[1], y[1]), (x[0], y[1])]
    return [extruded(2, profile, z, face)]


def _two_fields(
    x: Span, y: Span, z: Span, face: Material, glass: Material, width: float
) -> list[Piece]:
    middle, half = (z[0] + z[1]) / 2, width / 2
    pieces = _shaker(x, y, z, face, glass, width)
    raised = y[0] + 0.35 * (y[1] - y[0])
    return [*pieces, Block(within(x, width), (y[0], raised), (middle - half, middle + half), face)]


#: Every style: what makes it of spans [m], two looks and the width of its frame [m].
STYLES: dict[str, Callable[[Span, Span, Span, Material, Material, float], list[Piece]]] = {
    "slab": _slab,
    "bevel": _bevel,
    "shaker": _shaker,
    "raised": _raised,
    "glazed": _glazed,
    "mullion": _mullion,
    "louvre": _louvre,
    "planks": _planks,
    "bowed": _bowed,
    "two_fields": _two_fields,
}
#: Styles that one looks through.
OPEN_STYLES = ("glazed", "mullion", "louvre")


def panel(
    style: str, x: Span, y: Span, z: Span, looks: tuple[Material, Material], width: float
) -> list[Piece]:
    """A front that fills its spans [m] and never leaves them.

    Args:
        style: one of :data:`STYLES`; on a front too small for a frame, a slab.
        x: left and right [m].
        y: face and back [m].
        z: bottom and top [m].
        looks: of the front, and of its glass.
        width: of stiles and rails [m].
    """
    small = min(x[1] - x[0], z[1] - z[0])
    if style not in ("slab", "bevel", "bowed") and small < max(FRAMED_FROM, 3 * width):
        style = "slab"
    return STYLES[style](x, y, z, looks[0], looks[1], width)
