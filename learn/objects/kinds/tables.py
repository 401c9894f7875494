"""Tables and desks: drawers under a top, cases beside the knees, leaves that fold."""

from __future__ import annotations

from dataclasses import replace

from ..kit.assembly import BACK, FRONT, LEFT, RIGHT, Assembly
from ..kit.boards import stand
from ..kit.casework import Casework, furniture
from ..kit.layouts import column, drawers, grid, row
from ..kit.shapes import block, box
from ..kit.spans import Span, about, ends, mid, size, span, upto, within
from ..kit.styles import any_color, any_style

UNDER = {"tapered": 0.35, "round": 0.25, "feet": 0.2, "turned": 0.2}


def _top(a: Assembly, x: Span, y: Span, z: float) -> float:
    """Build a table top under ``z``; returns the height of its underside [m]."""
    level = span(z, -a.draw(0.015, 0.05))
    radius = 0.0 if a.happens(0.7) else a.draw(0.02, 0.1)
    top = block(x, y, level, radius) if radius else box(x, y, level)
    a.root.add(top, look=any_color(a))
    return level[0]


def table(a: Assembly) -> None:
    """Build a table with one to four drawers in its apron; a shelf below at times."""
    width, depth, height, apron = a.draws((0.4, 1.9), (0.35, 0.9), (0.4, 0.95), (0.08, 0.2))
    style = replace(any_style(a, {"slab": 0.7, "bevel": 0.3}, 0.6), shelves=0, covered=True)
    over = a.pick(0.0, 0.01, 0.03, 0.06)
    under = _top(a, (-over, width + over), (-over - 0.03, depth + over), height)
    count = min(4, max(1, round(width / a.draw(0.35, 0.9))))
    fixed = [(1.0, "fixed")] if count < 3 and a.happens(0.3) else []
    node = row(*fixed, *[(1.0, "drawer")] * count, *fixed)
    base = under - apron
    case = furniture(a, style, (width, depth, apron), node, a.weighted(UNDER), base)
    if a.happens(0.3):
        shelf = span(a.draw(0.15, 0.5) * base, 0.018)
        a.root.add(box(within(case.x, 0.03), within(case.y, 0.03), shelf), look=style.body)


def desk(a: Assembly) -> None:
    """Build a desk: a case on one side or on both, drawers over the knees at times."""
    width, depth, height = a.draws((0.9, 2.0), (0.45, 0.85), (0.68, 0.8))
    panels = {"slab": 0.5, "bevel": 0.15, "shaker": 0.2, "raised": 0.15}
    style = replace(any_style(a, panels), covered=True, crowded=True, shelves=2)
    over, base = a.picks((0.0, 0.01, 0.03), (0.0, 0.03, 0.08, 0.2))
    under = _top(a, (-over, width + over), (-over - 0.03, depth + over), height)
    x, y = upto(width, depth)
    sides = ends(x, a.draw(0.24, 0.4) * min(width, 1.4))
    taken = sides if a.happens(0.45) else [a.pick(*sides)]
    for i, side in enumerate(taken):
        closed = a.pick("door", column((0.65, "door"), (0.35, "drawer")))
        node = closed if a.happens(0.3) else drawers(a, a.count(2, 4))
        Casework(a, style, side, y, (base, under), f"side_{i}_").build(node)
        stand(a, a.weighted(UNDER | {"plinth": 1.0}), side, y, base, style.body)
    knees = (sides[0][1], sides[1][0])
    if len(taken) == 1:
        left = taken[0] == sides[0]
        post = ends(x, 0.03)[1 if left else 0]
        knees = (sides[0][1], post[0]) if left else (post[1], sides[1][0])
        deep = [y] if a.happens(0.5) else ends(y, 0.03)
        a.root.add(*(box(post, each, (0.0, under)) for each in deep), look=style.body)
    if a.happens(0.5):
        node = grid(a, min(3, max(1, round(size(knees) / 0.5))), 1)
        high = (under - a.draw(0.08, 0.13), under)
        Casework(a, replace(style, board=0.012), knees, y, high, "knee_").build(node)
    if a.happens(0.5):
        modesty = box(knees, span(depth - 0.03, 0.018), (0.35 * under, under - 0.15))
        a.root.add(modesty, look=style.body)


def folding_table(a: Assembly) -> None:
    """Build a table whose side leaves hang and come up."""
    width, depth, height, thick = a.draws((0.3, 0.8), (0.6, 1.2), (0.6, 0.8), (0.015, 0.03))
    x, y = upto(width, depth)
    under = height - thick
    body = a.body(any_color(a), box(x, y, (under, height)))
    frame_x = within(x, 0.04)
    frame_y = within(y, 0.08)
    stand(a, a.weighted(UNDER), frame_x, frame_y, under, any_color(a))
    body.add(*(box(frame_x, end, span(under, -0.08)) for end in ends(frame_y, 0.018)))
    gap, length = a.draws((0.001, 0.004), (0.25 * height, 0.6 * height))
    for i, side in enumerate((-1.0, 1.0) if a.happens(0.7) else (1.0,)):
        # The axis lies at the edge's lower corner, a gap outside: a hanging leaf faces outwards.
        edge = x[1] + gap if side > 0 else x[0] - gap
        at = (edge, depth / 2, under)
        leaf = a.hinge(f"leaf_{i}", FRONT if side > 0 else BACK, at, a.degrees(90, 90))
        leaf.add(box(span(edge, side * thick), y, span(under, -length)))


def vanity(a: Assembly) -> None:
    """Build a dressing table: drawers under the top, a mirror on it that tilts."""
    width, depth, height, high = a.draws((0.7, 1.4), (0.35, 0.5), (0.68, 0.8), (0.1, 0.35))
    style = any_style(a, {"slab": 0.6, "bevel": 0.2, "raised": 0.2})
    style = replace(style, covered=True, shelves=0)
    under = _top(a, (-0.01, width + 0.01), (-0.035, depth + 0.01), height)
    node = grid(a, a.count(1, 3), 1)
    if high > 0.22:
        node = row((1.0, drawers(a, 2)), (1.2, "drawer"), (1.0, drawers(a, 2)))
    furniture(a, style, (width, depth, high), node, a.weighted(UNDER), under - high)
    x = about(a.draw(0.2, 0.4) * width, width / 2)
    y = span(depth - 0.06, 0.015)
    z = span(height + 0.04, a.draw(0.4, 0.7))
    for post in ends(within(x, -0.025), 0.02):
        upright = (height, z[0] + 0.6 * size(z))
        a.root.add(box(post, within(y, -0.01, -0.005), upright), look=style.body)
    at = (width / 2, mid(y), mid(z))
    mirror = a.hinge("mirror", a.pick(LEFT, RIGHT), at, a.degrees(15, 30), look=any_color(a))
    mirror.add(box(x, y, z))
