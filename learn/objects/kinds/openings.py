"""Doors and windows in their frames, with handles that turn on them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from asset_factory.factory.mesh import Material

from ..kit.assembly import Assembly, PartDraft
from ..kit.axes import BACK, FRONT, LEFT, UP, Y, facing_front
from ..kit.boards import frame
from ..kit.casework import Casework, Leaf
from ..kit.controls import lever
from ..kit.hinges import stop
from ..kit.layouts import Cell, row
from ..kit.looks import BLACK, GLASS
from ..kit.panels import panel
from ..kit.pulls import add_pull, any_pull
from ..kit.shapes import box, cylinder, lathe
from ..kit.spans import Flat, Profile, Span, about, ends, mid, size, span, within
from ..kit.styles import Style, any_color, any_metal, any_style

LEAVES: dict[str, float] = {
    "slab": 0.3, "shaker": 0.12, "raised": 0.12, "two_fields": 0.14, "glazed": 0.12,
    "mullion": 0.08, "louvre": 0.05, "planks": 0.07,
}  # fmt: skip
SASHES = {"door": 0.35, "lift": 0.15, "flap": 0.1, "sliding": 0.2, "hung": 0.12, "pivot": 0.08}
#: A round door knob, from its leaf outwards: radius and height as shares.
_KNOB = ((0.45, 0.0), (0.4, 0.3), (0.9, 0.4), (1.0, 0.7), (0.6, 1.0))


def _framed(
    a: Assembly, panels: dict[str, float], bar: float, thick: float, rail: float, *kinds: str
) -> Style:
    """Return a style of leaves in a frame: inset, at the front of it, with pulls of some kinds."""
    style = any_style(a, panels, 1.0)
    pull = any_pull(a, any_metal(a), *kinds)
    return replace(
        style, board=bar, front=thick, recess=0.0, gap=a.draw(0.0015, 0.005), rail=rail, pull=pull,
        taste=a.pick(0.0, -0.2, -0.1), hollow=True, shelves=0, backless=True, drawer=style.panel,
        pull_at=a.draw(0.42, 0.5), upper=style.panel,
    )  # fmt: skip


def _lever(a: Assembly, leaf: PartDraft, at: Flat, y: Span, inward: float, look: Material) -> None:
    """Build a lever or a round knob on both sides of a leaf, on one spindle."""
    x, z = at
    flat = a.happens(0.75)
    reach, r, length = a.draws((0.04, 0.065), (0.007, 0.011), (0.09, 0.14))
    axis = FRONT if flat and inward > 0.0 else BACK
    name = f"{leaf.name}_handle"
    handle = a.hinge(name, axis, (x, mid(y), z), a.degrees(30, 60), on=leaf, look=look)
    tip = (x + inward * length, z - a.pick(0.0, 0.0, 0.02))
    for face, side in ((y[0], -1.0), (y[1], 1.0)):
        near = face + side * 0.0015
        if flat:
            handle.add(*lever(at, (near, face + side * reach), tip, r))
        else:
            knob: Profile = [(0.028 * s, side * t * (reach - 0.0015)) for s, t in _KNOB]
            handle.add(lathe(knob, (x, near, z), Y, 16))


def door(a: Assembly) -> None:
    """Build one or two leaves in a frame, with side lights or a fan light at times."""
    double, sill, levers = a.happen(0.25, 0.3, 0.65)
    width = a.draw(1.2, 1.9) if double else a.draw(0.65, 1.1)
    height, bar, wall, thick = a.draws((1.85, 2.3), (0.025, 0.09), (0.06, 0.2), (0.03, 0.06))
    kinds = ("none",) if levers or a.happens(0.3) else ("bar", "rail", "bow", "knob", "ball")
    rail = min(0.13, 0.2 * width / (2.0 if double else 1.0))
    style = _framed(a, LEAVES, bar, thick, rail, *kinds)
    style = replace(style, sill=sill)
    body = a.body(style.body)
    x = (-bar, width + bar)
    opening = (0.0, width)
    y = (0.0, max(wall, thick + 0.01))
    case = Casework(a, style, x, y, (0.0, height + bar)).build("double" if double else "door")
    top = height + bar
    if a.happens(0.25):
        light = span(top, a.draw(0.25, 0.5))
        body.add(*frame(x, y, light, bar))
        body.add(box(opening, span(0.4 * wall, 0.006), within(light, bar)), look=GLASS)
    if a.happens(0.5):
        trim = a.draw(0.04, 0.09)
        around = within(x, -trim)
        body.add(*frame(around, span(y[1], 0.012), (0.0, top + trim), trim, False))
    if a.happens(0.5) and wall > thick + 0.02:
        # A stop behind the leaf, as real frames have.
        low = bar if sill else 0.0
        body.add(*frame(opening, span(thick + 0.002, 0.012), (low, height), 0.012, False))
    plated = a.happens(0.5)
    both = (-0.0005, thick + 0.0005)
    for leaf in case.doors:
        leaf.part.upper = stop(a, 112.0)
        if not levers or (leaf is not case.doors[0] and a.happens(0.35)):
            continue
        left = leaf.side == "left"
        at = (leaf.x[1] - 0.06 if left else leaf.x[0] + 0.06, a.draw(0.85, 1.1))
        if plated:
            plate = box(about(0.022, at[0]), both, (at[1] - 0.09, at[1] + 0.06))
            leaf.part.add(plate, look=style.pull.look)
        _lever(a, leaf.part, at, both, -1.0 if left else 1.0, style.pull.look)


def sliding_door(a: Assembly) -> None:
    """Build a leaf on a rail before a wall, or two on two tracks in a frame."""
    width, height, thick = a.draws((0.7, 1.1), (1.9, 2.3), (0.025, 0.05))
    panels = LEAVES | {"glazed": 0.5}
    if a.happens(0.5):
        bar = a.draw(0.04, 0.08)
        style = _framed(a, panels, bar, thick, bar, "recess", "bar")
        a.body(style.body)
        _on_tracks(a, style, 2 * width, height, "sliding")
        return
    metal = any_metal(a)
    body = a.body(any_color(a))
    opening = (0.0, width)
    body.add(*frame(within(opening, -0.08), (0.0, 0.1), (0.0, height), 0.08, False))
    rail = height + 0.12
    away = a.sign()
    reach = within(opening, -0.1 if away > 0.0 else -0.1 - width, -0.1 - max(away, 0.0) * width)
    body.add(box(reach, (-0.02, -0.012), span(rail, 0.04)), look=metal)
    brackets = ends(within(opening, -0.08), 0.04)
    body.add(*(box(bracket, (-0.012, 0.1), (height, rail + 0.03)) for bracket in brackets))
    x = (-0.03, width + 0.03)
    y = span(-0.012, -thick)
    at = (width / 2, y[0], height / 2)
    leaf = a.slider("door", (away, 0.0, 0.0), at, round(0.95 * width, 3), look=any_color(a))
    panel(leaf, a.weighted(panels), x, y, (0.01, height + 0.08), 0.11)
    strap = span(y[0], -0.006)
    for v in (0.1, width - 0.1):
        leaf.add(box(about(0.015, v), strap, (height - 0.1, rail + 0.08)), look=metal)
        leaf.add(cylinder(Y, (v, rail + 0.063), 0.022, (strap[1], -0.008)), look=metal)
    pull = any_pull(a, metal, "bar", "rail", "recess")
    edge = x[1] - 0.06 if away < 0 else x[0] + 0.06
    add_pull(leaf, pull, (edge, 1.0), facing_front(y[0]), 0.6, True)


def _on_tracks(a: Assembly, style: Style, width: float, height: float, kind: str) -> None:
    """Build sashes that slide past each other in a frame: ``sliding`` or ``hung``."""
    tracks = 2 if kind == "hung" else a.pick(2, 2, 2, 3)
    deep = tracks * (style.front + 0.004) + 0.01
    Casework(a, style, (0.0, width), (0.0, deep), (0.0, height)).build(f"{kind}:sash")


def window(a: Assembly) -> None:
    """Build sashes in a frame: side, top or bottom hung, sliding, or turning about their middle."""
    width, height, bar, thick = a.draws((0.45, 2.0), (0.45, 1.7), (0.03, 0.07), (0.025, 0.05))
    deep, rail = a.draws((0.06, 0.14), (0.03, 0.055))
    panels = {"mullion": 0.3, "glazed": 0.7}
    kind = a.weighted(SASHES)
    slides = kind in ("sliding", "hung")
    style = _framed(a, panels, bar, thick, bar if slides else rail, "recess", "bar")
    body = a.body(style.body)
    if slides:
        _on_tracks(a, style, width, height, kind)
        return
    style = replace(style, pull=replace(style.pull, kind="none"))
    columns = max(1, min(3, round(width / a.draw(0.45, 0.9))))
    cells = [f"{'open' if kind == 'pivot' else kind}:sash_{i}" for i in range(columns)]
    if columns == 3 and a.happens(0.6):
        cells[1] = "fixed"
    node = row(*((1.0, cell) for cell in cells))
    case = Casework(a, style, (0.0, width), (0.0, deep), (0.0, height)).build(node)
    if a.happens(0.3):
        body.add(box((-0.05, width + 0.05), (-0.06, deep), (-0.03, 0.0)))
    for leaf in case.doors:
        leaf.part.upper = stop(a, 100.0 if kind == "door" else 70.0)
        if a.happens(0.6):
            _latch(a, leaf, rail)
    for cell in case.cells:
        if cell.kind == "open":
            _pivoted(a, style, cell)


def _latch(a: Assembly, leaf: Leaf, rail: float) -> None:
    """Build a handle that hangs, and turns over its own sash, where no neighbour's handle is."""
    sash, _, side, x, z = leaf
    at = {"left": x[1] - rail / 2, "right": x[0] + rail / 2}.get(side, mid(x))
    level = {"top": z[0] + 0.15, "bottom": z[1] - rail / 2}.get(side, mid(z))
    axis = FRONT if side == "right" else BACK
    handle = a.hinge(f"{sash.name}_handle", axis, (at, 0.0, level), np.pi / 2, on=sash, look=BLACK)
    handle.add(*lever((at, level), (-0.001, -0.045), (at, level - a.draw(0.08, 0.13)), 0.009))


def _pivoted(a: Assembly, style: Style, cell: Cell) -> None:
    """Build a sash about its horizontal or upright middle; trimmed so that it clears the frame."""
    x, z = (within(inner, style.gap) for inner in cell.inner)
    upright = a.happens(0.4)
    half = size(x if upright else z) / 2
    trim = float(np.hypot(half, style.front / 2)) - half
    x = within(x, trim if upright else 0.0)
    z = within(z, 0.0 if upright else trim)
    at = (mid(x), style.front / 2, mid(z))
    sash = a.hinge(cell.name, UP if upright else LEFT, at, a.degrees(45, 90), look=style.face)
    panel(sash, style.panel, x, (0.0, style.front), z, style.rail)
