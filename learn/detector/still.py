"""Things on which nothing opens: bare furniture, crates, pots, screens, heaps of boxes."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from asset_factory.factory.articulation import Articulation
from asset_factory.factory.mesh import Material

from ..objects.kit.assembly import Assembly
from ..objects.kit.axes import Z
from ..objects.kit.boards import carcass, corners, leg, stand
from ..objects.kit.shapes import block, box, cylinder, frustum, lathe
from ..objects.kit.spans import Span, about, centred, ends, shares, span, upto, within
from ..objects.kit.styles import any_color


def make_still(kind: str, rng: np.random.Generator) -> Articulation:
    """Return an object without joints, z up, its front towards -Y."""
    assembly = Assembly(rng)
    assembly.body(any_color(assembly))
    _MAKERS[kind](assembly)
    return assembly.articulation()


def _shelf(a: Assembly) -> None:
    width, depth, height = a.draws((0.4, 1.6), (0.2, 0.5), (0.5, 2.1))
    x, y, z = upto(width, depth, height)
    wall = a.draw(0.012, 0.04)
    posts = [box(about(wall / 2, u), about(wall / 2, v), z) for u, v in corners(x, y, wall / 2)]
    a.root.add(*(carcass(x, y, z, wall) if a.happens(0.7) else posts))
    inner = within(x, wall)
    for level in shares(z, a.count(2, 6))[1:]:
        look = any_color(a) if a.happens(0.1) else None
        a.root.add(box(inner, y, span(level[0], wall)), look=look)
    if a.happens(0.5):
        for place in shares(inner, a.count(2, 4))[1:]:
            a.root.add(box(span(place[0], wall), y, within(z, wall)))
    for level in shares(within(z, wall), 3):
        if a.happens(0.4):
            _books(a, inner, y, level)


def _books(a: Assembly, x: Span, y: Span, level: Span) -> None:
    for place in shares(x, a.count(3, 12)):
        if a.happens(0.7):
            z = (level[0], level[0] + a.draw(0.4, 0.9) * (level[1] - level[0]))
            a.root.add(box(within(place, 0.002), within(y, 0.02), z), look=any_color(a))


def _table(a: Assembly) -> None:
    width, depth, height, thick = a.draws((0.4, 2.0), (0.4, 1.0), (0.3, 1.0), (0.015, 0.06))
    x, y = upto(width, depth)
    top = span(height, -thick)
    kind = a.pick("feet", "tapered", "round", "turned", "sled")
    if a.happens(0.2):
        round_ = lathe([(width / 2, top[0]), (width / 2, height)], (width / 2, depth / 2, 0.0))
        a.root.add(round_)
    else:
        a.root.add(block(x, y, top, 0.3 * thick) if a.happens(0.3) else box(x, y, top))
    inside = within(x, 0.04)
    stand(a, kind, inside, within(y, 0.04), top[0], any_color(a))
    if a.happens(0.6):
        apron = span(top[0], -a.draw(0.05, 0.15))
        a.root.add(*(box(inside, end, apron) for end in ends(within(y, 0.04), 0.02)))


def _chair(a: Assembly) -> None:
    width, depth, seat, back = a.draws((0.35, 0.6), (0.35, 0.55), (0.35, 0.5), (0.3, 0.6))
    x, y = upto(width, depth)
    a.root.add(block(x, y, span(seat, -0.05), 0.015))
    for at in corners(x, y, 0.03):
        leg(a.root, a.pick("feet", "tapered", "round"), at, seat - 0.05, 0.02, any_color(a))
    rear = span(depth, -0.03)
    if a.happens(0.5):
        a.root.add(box(x, rear, (seat, seat + back)))
    else:
        for place in shares(x, a.count(3, 7)):
            a.root.add(box(within(place, 0.01), rear, (seat, seat + back)))
    if a.happens(0.3):
        for side in ends(x, 0.04):
            post = box(side, ends(y, 0.04)[0], (seat, seat + 0.2))
            a.root.add(box(side, y, span(seat + 0.2, 0.03)), post)


def _sofa(a: Assembly) -> None:
    width, depth, seat, back = a.draws((0.7, 2.4), (0.6, 1.0), (0.3, 0.45), (0.3, 0.5))
    arm = a.draw(0.1, 0.25)
    x, y = upto(width, depth)
    low = a.draw(0.0, 0.12)
    inner = within(x, arm)
    a.root.add(block(x, y, (low, 0.6 * seat), 0.03))
    for place in shares(inner, a.count(1, 4)):
        a.root.add(block(within(place, 0.003), within(y, 0.0, 0.15), (0.6 * seat, seat), 0.04))
        a.root.add(block(within(place, 0.003), span(depth, -0.2), (seat, seat + back), 0.05))
    for side in ends(x, arm):
        a.root.add(block(side, y, (low, seat + a.draw(0.05, 0.25)), 0.04))
    stand(a, a.pick("feet", "tapered", "none"), x, y, low, any_color(a))


def _crate(a: Assembly) -> None:
    width, depth, height = a.draws((0.3, 1.2), (0.3, 1.0), (0.25, 1.1))
    x, y, z = upto(width, depth, height)
    wall = a.draw(0.01, 0.04)
    a.root.add(box(within(x, wall), within(y, wall), within(z, wall)))
    post = a.draw(0.03, 0.12)
    trim = any_color(a) if a.happens(0.5) else None
    for u in ends(x, post):
        for v in ends(y, post):
            a.root.add(box(u, v, z), look=trim)
    for level in ends(z, post):
        a.root.add(*(box(x, v, level) for v in ends(y, wall)), look=trim)
        a.root.add(*(box(u, y, level) for u in ends(x, wall)), look=trim)
    if a.happens(0.6):
        for level in shares(z, a.count(2, 6)):
            a.root.add(box(within(x, wall / 3), within(y, wall / 3), within(level, 0.004)))


def _screen(a: Assembly) -> None:
    width = a.draw(0.4, 1.6)
    height = width * a.draw(0.5, 0.75)
    deep, rim, foot = a.draws((0.03, 0.5), (0.01, 0.06), (0.0, 0.15))
    x, z = upto(width, height)
    z = (z[0] + foot, z[1] + foot)
    a.root.add(box(x, (0.0, deep), z))
    a.root.add(box(within(x, rim), span(-0.004, 0.006), within(z, rim)), look=any_color(a))
    if foot > 0.03:
        a.root.add(box(about(width / 4, width / 2), about(0.12, deep / 2), (0.0, 0.02)))
        a.root.add(box(about(0.03, width / 2), about(0.02, deep / 2), (0.0, foot)))
    for place in range(a.count(0, 3)):
        a.root.add(box(about(0.05, 0.1 + 0.1 * place), span(-0.01, 0.01), span(z[0], rim)))


def _pot(a: Assembly) -> None:
    radius, height = a.draws((0.1, 0.4), (0.2, 0.9))
    rings = [(radius * a.draw(0.5, 1.1), share * height) for share in (0.0, 0.3, 0.6, 1.0)]
    a.root.add(lathe(rings, sides=24))
    for _ in range(a.count(0, 4)):
        at = a.draw(-0.5, 0.5) * radius, a.draw(-0.5, 0.5) * radius
        middle = (a.draw(0.05, 0.3), height + 0.2)
        leaf = [(0.02, height), middle, (0.01, height + a.draw(0.3, 0.8))]
        a.root.add(lathe(leaf, (*at, 0.0), sides=8), look=any_color(a))


def _barrel(a: Assembly) -> None:
    radius, height, bulge = a.draws((0.15, 0.4), (0.3, 1.0), (1.0, 1.25))
    rings = [(radius, 0.0), (radius * bulge, height / 2), (radius, height)]
    a.root.add(lathe(rings, sides=24))
    for share in (0.08, 0.35, 0.65, 0.92):
        wide = radius * (1.0 + (bulge - 1.0) * (1.0 - abs(2 * share - 1.0))) + 0.01
        hoop = cylinder(Z, (0.0, 0.0), wide, about(0.02, share * height), 24)
        a.root.add(hoop, look=any_color(a))


def _heap(a: Assembly) -> None:
    level = 0.0
    half_x, half_y = a.draws((0.2, 0.6), (0.2, 0.5))
    for _ in range(a.count(1, 6)):
        high = a.draw(0.05, 0.5)
        x, y = centred(half_x, half_y)
        z = (level, level + high)
        look: Material | None = any_color(a) if a.happens(0.4) else None
        if a.happens(0.15):
            a.root.add(cylinder(Z, (0.0, 0.0), min(half_x, half_y), z), look=look)
        elif a.happens(0.2):
            shrink = a.draw(0.5, 0.95)
            tip_x, tip_y = centred(shrink * half_x, shrink * half_y)
            a.root.add(frustum((x, y), (tip_x, tip_y), z), look=look)
        else:
            a.root.add(block(x, y, z, 0.1 * high) if a.happens(0.4) else box(x, y, z), look=look)
        if a.happens(0.3):
            a.root.add(box(span(half_x, a.draw(0.01, 0.2)), within(y, 0.05), within(z, 0.01)))
        half_x, half_y = half_x * a.draw(0.6, 1.15), half_y * a.draw(0.6, 1.15)
        level += high


def _bed(a: Assembly) -> None:
    width, length, height, head = a.draws((0.8, 2.0), (1.8, 2.2), (0.25, 0.6), (0.2, 0.7))
    x, y = upto(width, length)
    low = a.draw(0.0, 0.2)
    a.root.add(box(x, y, (low, 0.6 * height)))
    mattress = block(within(x, 0.03), within(y, 0.03), (0.6 * height, height), 0.05)
    a.root.add(mattress, look=any_color(a))
    a.root.add(box(x, span(length, 0.05), (0.0, height + head)))
    if a.happens(0.5):
        a.root.add(box(x, span(0.0, -0.05), (0.0, height + 0.4 * head)))
    stand(a, a.pick("feet", "tapered"), x, y, low, any_color(a))


#: By name: ``still_shelf`` and so on.
_MAKERS: Mapping[str, Callable[[Assembly], None]] = {
    f"still{maker.__name__}": maker
    for maker in (_shelf, _table, _chair, _sofa, _crate, _screen, _pot, _barrel, _heap, _bed)
}
STILL = tuple(_MAKERS)
