"""Furniture of boards: frames, carcasses, trays, racks; and their feet."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.mesh import Material

from .assembly import Assembly, PartDraft
from .axes import X, Y
from .looks import BLACK, STEEL
from .shapes import Form, box, cylinder, frustum, lathe
from .spans import Flat, Span, about, between, ends, mid, size, span, within

#: Legs from bottom to top: shares of the height and of the half width.
_TURNED = ((0.0, 0.5), (0.12, 0.8), (0.2, 0.45), (0.75, 0.9), (0.8, 0.6), (0.85, 1.0), (1.0, 1.0))


def corners(x: Span, y: Span, inset: float = 0.0) -> list[Flat]:
    """Return the four corners of a rectangle less ``inset`` on every side."""
    return [(cx, cy) for cx in within(x, inset) for cy in within(y, inset)]


def frame(x: Span, y: Span, z: Span, width: float, sill: bool = True) -> list[Form]:
    """Return two stiles and two rails around an opening, or one rail where there is no sill."""
    stiles = [box(end, y, z) for end in ends(x, width)]
    foot, head = ends(z, width)
    rails = [box(within(x, width), y, rail) for rail in ((foot, head) if sill else (head,))]
    return [*stiles, *rails]


def carcass(
    x: Span, y: Span, z: Span, wall: float, back: float = 0.006, sill: bool = True
) -> list[Form]:
    """Build sides, bottom, top and back around a room open towards -Y; outer spans."""
    rear = box(within(x, wall), span(y[1], -back), within(z, wall))
    return [*frame(x, y, z, wall, sill), rear]


def tray(x: Span, y: Span, z: Span, wall: float, front: bool = True) -> list[Form]:
    """Return a box without its top, and without its front if so wished; outer spans."""
    inner = within(x, wall)
    near, rear = ends(y, wall)
    walls = [box(end, y, z) for end in ends(x, wall)]
    walls += [box(inner, end, z) for end in ((near, rear) if front else (rear,))]
    return [*walls, box(inner, within(y, wall if front else 0.0, wall), span(z[0], wall))]


def rack(x: Span, y: Span, z: float, rods: int, along_y: bool = True) -> list[Form]:
    """Return a wire shelf: a rim and rods across it."""
    level = span(z, 0.006)
    wire = span(z + 0.001, 0.003)
    inner_x = within(x, 0.006)
    inner_y = within(y, 0.006)
    rim = [box(x, end, level) for end in ends(y, 0.006)]
    rim += [box(end, inner_y, level) for end in ends(x, 0.006)]
    if along_y:
        return rim + [box(about(0.0015, v), inner_y, wire) for v in between(inner_x, rods)]
    return rim + [box(inner_x, about(0.0015, v), wire) for v in between(inner_y, rods)]


def stand(a: Assembly, kind: str, x: Span, y: Span, height: float, look: Material) -> None:
    """Build supports under a body over ``x`` and ``y`` whose underside is at ``height`` [m].

    Kinds are plinth, feet, tapered, round, turned, sled, castors, skirt and none.
    """
    if kind == "none" or height <= 0.0:
        return
    low = (0.0, height)
    width = a.draw(0.025, 0.06)
    forms: list[Form] = []
    if kind == "plinth":
        inset = within(x, a.pick(0.0, 0.0, 0.01))
        forms = [box(inset, within(y, a.pick(0.0, 0.03, 0.06), 0.0), low)]
    elif kind == "skirt":
        forms = [box(end, y, low) for end in ends(x, 0.02)]
        forms.append(box(within(x, 0.02), span(y[0], 0.02), (0.35 * height, height)))
    elif kind == "sled":
        long = within(y, 0.02)
        for bar in ends(within(x, 0.02), 0.5 * width):
            forms.append(box(bar, long, (0.0, 0.5 * width)))
            forms += [box(bar, end, (0.5 * width, height)) for end in ends(long, 0.5 * width)]
    else:
        for at in corners(x, y, a.draw(0.0, 0.03) + width / 2):
            leg(a.root, kind, at, height, width / 2, look)
    a.root.add(*forms, look=look)


def leg(body: PartDraft, kind: str, at: Flat, height: float, half: float, look: Material) -> None:
    """Build one leg of some ``half`` width under ``height`` [m]; kinds as in :func:`stand`."""
    x, y = at
    up = (0.0, height)
    if kind == "feet":
        body.add(box(about(half, x), about(half, y), up), look=look)
    elif kind == "tapered":
        foot = (about(0.6 * half, x), about(0.6 * half, y))
        body.add(frustum(foot, (about(half, x), about(half, y)), up), look=look)
    elif kind == "round":
        body.add(lathe([(0.6 * half, 0.0), (half, height)], (x, y, 0.0), sides=12), look=look)
    elif kind == "turned":
        profile = [(r * half, share * height) for share, r in _TURNED]
        body.add(lathe(profile, (x, y, 0.0), sides=12), look=look)
    else:
        wheel = min(0.03, 0.4 * height)
        crown = 2 * wheel + 0.004
        at_wheel = (y, wheel / np.cos(np.pi / 12))
        body.add(cylinder(X, at_wheel, wheel, about(0.009, x), 12), look=BLACK)
        body.add(box(about(0.014, x), about(0.014, y), (crown, height)), look=look)
        for side in (-0.012, 0.012):
            body.add(box(about(0.002, x + side), about(0.01, y), (wheel, crown)), look=look)


def slab(x: Span, y: Span, z: float, thick: float, over: float = 0.0) -> Form:
    """Return a board on a body, standing out at its front and its sides by ``over`` [m]."""
    return box(within(x, -over), within(y, -over, 0.0), span(z, thick))


def cornice(x: Span, y: Span, z: float) -> list[Form]:
    """Return two steps around a body's top."""
    return [slab(x, y, z, 0.03, 0.012), slab(x, y, z + 0.03, 0.025, 0.03)]


def ring_of_boards(outer: tuple[Span, Span], hole: tuple[Span, Span], z: Span) -> list[Form]:
    """Return a lying board with a rectangular hole; spans across x and y."""
    x, y = outer
    u, v = hole
    sides = [box((x[0], u[0]), y, z), box((u[1], x[1]), y, z)]
    return [*sides, box(u, (y[0], v[0]), z), box(u, (v[1], y[1]), z)]


def put_top(a: Assembly, kind: str, x: Span, y: Span, z: float, look: Material) -> float:
    """Put a top on a body whose upper side is at ``z``, and return the height of its own [m].

    Kinds are flush (nothing), board, cornice, sink and vessel.
    """
    if kind == "board":
        thick = a.draw(0.015, 0.045)
        a.root.add(slab(x, y, z, thick, a.pick(0.0, 0.01, 0.025)), look=look)
        return z + thick
    if kind == "cornice":
        a.root.add(*cornice(x, y, z), look=look)
    elif kind != "flush":
        _put_basin(a, kind, x, y, z, look)
    return z


def _put_basin(a: Assembly, kind: str, x: Span, y: Span, z: float, stone: Material) -> None:
    """Put a stone around a sink that hangs in the body, or under a vessel; and a spout."""
    body = a.root
    top = z + 0.03
    at = (mid(x), mid(y) - 0.02)
    if kind == "sink":
        basin_x = about(min(0.25, 0.35 * size(x)), mid(x))
        basin_y = within(y, 0.08, 0.13)
        body.add(*ring_of_boards((x, y), (basin_x, basin_y), (z, top)), look=stone)
        basin = (z - a.draw(0.1, 0.18), z)
        body.add(*tray(within(basin_x, -0.006), within(basin_y, -0.006), basin, 0.006), look=STEEL)
        spout = basin_y[1] + 0.06
        reach = 0.16
    else:
        radius = min(0.2, 0.38 * min(size(x), size(y)))
        body.add(slab(x, y, z, 0.03), look=stone)
        bowl = [(0.7 * radius, 0.0), (radius, 0.12), (0.95 * radius, 0.12), (0.7 * radius, 0.012)]
        body.add(lathe(bowl, (*at, top)), look=STEEL)
        spout = at[1] + radius + 0.03
        reach = 0.7 * radius + 0.03
    high = top + a.draw(0.15, 0.3)
    pole = [(0.025, top), (0.025, top + 0.008), (0.012, top + 0.009), (0.012, high)]
    body.add(lathe(pole, (mid(x), spout, 0.0), sides=12), look=STEEL)
    arm = (spout - reach, spout + 0.01)
    body.add(cylinder(Y, (mid(x), high), 0.01, arm, 12), look=STEEL)
