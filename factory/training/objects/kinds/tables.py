"""Tables and desks: drawers under a top, cases beside the knees, leaves that fold."""

from __future__ import annotations

from dataclasses import replace

from ..kit.assembly import BACK, FRONT, LEFT, RIGHT, Assembly
from ..kit.boards import stand
from ..kit.casework import Style, casework, furniture
from ..kit.layouts import column, drawers, grid, row
from ..kit.shapes import Form, Span, about, block, box, mid, size, span, within
from ..kit.styles import any_color, any_style

UNDER = {"tapered": 0.35, "round": 0.25, "feet": 0.2, "turned": 0.2}


def _top(a: Assembly, x: Span, y: Span, z: float) -> float:
    """A table top under ``z``, square or with rounded corners; the height of its underside [m]."""
    thick = a.draw(0.015, 0.05)
    level = span(z, -thick)
    square = a.happens(0.7)
    top: Form = box(x, y, level) if square else block(x, y, level, a.draw(0.02, 0.1))
    a.root.add(top, look=any_color(a))
    return z - thick


def table(a: Assembly) -> None:
    """A table with one to four drawers in its apron; a shelf below at times."""
    width, depth, height, apron = a.draws((0.4, 1.9), (0.35, 0.9), (0.4, 0.95), (0.08, 0.2))
    style = any_style(a, {"slab": 0.7, "bevel": 0.3}, 0.6)
    style = replace(style, shelves=0, covered=True)
    over = a.pick(0.0, 0.01, 0.03, 0.06)
    under = _top(a, (-over, width + over), (-over - 0.03, depth + over), height)
    count = min(4, max(1, round(width / a.draw(0.35, 0.9))))
    ends = [(1.0, "fixed")] if count < 3 and a.happens(0.3) else []
    node = row(*ends, *[(1.0, "drawer")] * count, *ends)
    base = under - apron
    case = furniture(a, style, (width, depth, apron), node, a.weighted(UNDER), base)
    if a.happens(0.3):
        shelf = span(a.draw(0.15, 0.5) * base, 0.018)
        a.root.add(box(within(case.x, 0.03), within(case.y, 0.03), shelf), look=style.body)


def desk(a: Assembly) -> None:
    """A desk: a case on one side or on both, drawers over the knees at times."""
    width, depth, height = a.draws((0.9, 2.0), (0.45, 0.85), (0.68, 0.8))
    panels = {"slab": 0.5, "bevel": 0.15, "shaker": 0.2, "raised": 0.15}
    style = replace(any_style(a, panels), covered=True, crowded=True, shelves=2)
    over, base = a.pick(0.0, 0.01, 0.03), a.pick(0.0, 0.03, 0.08, 0.2)
    under = _top(a, (-over, width + over), (-over - 0.03, depth + over), height)
    side = a.draw(0.24, 0.4) * min(width, 1.4)
    both, y, body = a.happens(0.45), (0.0, depth), a.root
    ends = [(0.0, side), (width - side, width)]
    taken = ends if both else [a.pick(*ends)]
    for i, x in enumerate(taken):
        closed = a.pick("door", column((0.65, "door"), (0.35, "drawer")))
        node = closed if a.happens(0.3) else drawers(a, a.count(2, 4))
        casework(a, style, x, y, (base, under), node, f"side_{i}_")
        stand(a, a.weighted(UNDER | {"plinth": 1.0}), x, y, base, style.body)
    knees = (side, width - side)
    if not both:
        left = taken[0] == ends[0]
        post = span(width, -0.03) if left else (0.0, 0.03)
        knees = (side, post[0]) if left else (post[1], width - side)
        rows = [y] if a.happens(0.5) else [span(0.0, 0.03), span(depth, -0.03)]
        body.add(*(box(post, deep, (0.0, under)) for deep in rows), look=style.body)
    if a.happens(0.5):
        node = grid(a, min(3, max(1, round(size(knees) / 0.5))), 1)
        high = (under - a.draw(0.08, 0.13), under)
        casework(a, replace(style, board=0.012), knees, y, high, node, "knee_")
    if a.happens(0.5):
        modesty = box(knees, span(depth - 0.03, 0.018), (0.35 * under, under - 0.15))
        body.add(modesty, look=style.body)


def folding_table(a: Assembly) -> None:
    """A table whose side leaves hang and come up."""
    width, depth, height, thick = a.draws((0.3, 0.8), (0.6, 1.2), (0.6, 0.8), (0.015, 0.03))
    look, x, y, under = any_color(a), (0.0, width), (0.0, depth), height - thick
    a.body(look).add(box(x, y, (under, height)))
    frame_x, frame_y, legs = within(x, 0.04), within(y, 0.08), any_color(a)
    stand(a, a.weighted(UNDER), frame_x, frame_y, under, legs)
    for end, way in zip(frame_y, (0.018, -0.018), strict=True):
        a.root.add(box(frame_x, span(end, way), span(under, -0.08)))
    gap, length = a.draw(0.001, 0.004), a.draw(0.25, 0.6) * height
    for i, side in enumerate((-1.0, 1.0) if a.happens(0.7) else (1.0,)):
        # The axis lies at the edge's lower corner, a gap outside: hanging, the leaf's face looks
        # outwards.
        edge = x[1] + gap if side > 0 else x[0] - gap
        at = (edge, depth / 2, under)
        leaf = a.hinge(f"leaf_{i}", FRONT if side > 0 else BACK, at, a.degrees(90, 90))
        leaf.add(box(span(edge, side * thick), y, span(under, -length)))


def vanity(a: Assembly) -> None:
    """A dressing table: drawers under the top, a mirror on it that tilts."""
    width, depth, height, high = a.draws((0.7, 1.4), (0.35, 0.5), (0.68, 0.8), (0.1, 0.35))
    panels = {"slab": 0.6, "bevel": 0.2, "raised": 0.2}
    style: Style = replace(any_style(a, panels), covered=True, shelves=0)
    under = _top(a, (-0.01, width + 0.01), (-0.035, depth + 0.01), height)
    node = grid(a, a.count(1, 3), 1)
    if high > 0.22:
        node = row((1.0, drawers(a, 2)), (1.2, "drawer"), (1.0, drawers(a, 2)))
    furniture(a, style, (width, depth, high), node, a.weighted(UNDER), under - high)
    half, tall = a.draw(0.2, 0.4) * width, a.draw(0.4, 0.7)
    y, z, x = span(depth - 0.06, 0.015), span(height + 0.04, tall), about(half, width / 2)
    for start in (x[0] - 0.025, x[1] + 0.005):
        post = box(span(start, 0.02), within(y, -0.01, -0.005), (height, z[0] + 0.6 * tall))
        a.root.add(post, look=style.body)
    at = (width / 2, mid(y), mid(z))
    mirror = a.hinge("mirror", a.pick(LEFT, RIGHT), at, a.degrees(15, 30), look=any_color(a))
    mirror.add(box(x, y, z))


MAKERS = {"table": table, "desk": desk, "folding_table": folding_table, "vanity": vanity}
