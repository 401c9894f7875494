"""Fittings of walls and pipes: faucets, valves, panels of switches."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.mesh import FloatArray, Material

from ..kit.assembly import Assembly, PartDraft
from ..kit.axes import BACK, LEFT, RIGHT, UP, X, Y, Z, facing_front
from ..kit.controls import ControlPanel
from ..kit.looks import BLACK, BRASS, RED, STEEL, WHITE
from ..kit.outlines import arc, raised
from ..kit.shapes import Form, ball, block, box, cylinder, lathe, pipe, prism
from ..kit.spans import PLAY, Flat, about, mid, shares, span


def faucet(a: Assembly) -> None:
    """Build a spout with one lever or two handles; most spouts swivel."""
    body = a.body(a.pick(STEEL, BRASS, BLACK, WHITE))
    if a.happens(0.25):
        _mixer(a)
        return
    two, swivels, sprays = a.happen(0.55, 0.7, 0.2)
    radius = a.draw(0.014, 0.028)
    tall = a.draw(0.03 if two else 0.06, 0.12)
    _plinth(a, radius, tall)
    half = np.pi if a.happens(0.2) else a.degrees(40, 100)
    spout = a.hinge("spout", UP, (0, 0, tall), half, -half) if swivels else body
    end, ahead = _spout(a, spout, radius, tall + PLAY)
    if sprays:
        long = a.draw(0.02, 0.06)
        line = [end + (0.007 + share * long) * ahead for share in (0.0, 0.5, 1.0)]
        head = a.slider("spray", ahead, line[0], a.draw(0.05, 0.2), on=spout)
        head.add(pipe(line, radius * np.array((0.6, 0.65, 0.8)), 14, up=RIGHT))
    if two:
        _pair(a, radius)
    elif _single(a, radius, tall) > tall:
        # A spout does not swing into a lever that stands beside it.
        spout.upper = min(spout.upper, 1.2)
        spout.lower = -spout.upper


def _mixer(a: Assembly) -> None:
    """Build a column with a spout in front of it and a lever on top that turns, lifts, or both."""
    radius, tall, reach, high = a.draws((0.018, 0.027), (0.07, 0.2), (0.09, 0.16), (0.012, 0.03))
    body = a.root
    _plinth(a, radius, tall)
    low = a.draw(0.45, 0.75) * tall
    middle, end = a.draws((low - 0.01, low + 0.04), (low - 0.02, low + 0.03))
    thin = radius * a.draw(0.45, 0.7)
    path = [(0, -0.8 * radius, low), (0, -0.5 * reach, middle), (0, -reach, end)]
    width = thin * np.array((1.0, 0.9, 0.8))
    body.add(pipe(path, width, a.pick(4, 12), up=UP, flat=a.draw(0.5, 1.0)))
    nozzle = [(0.7 * thin, end), (0.7 * thin, end - 0.018)]
    body.add(lathe(nozzle, (0, 0.8 * thin - reach, 0), sides=14))
    base = tall + PLAY
    level = base + high + 0.001
    style = a.pick("turn", "lift", "chain")
    cap = body
    if style != "lift":
        half = a.degrees(30, 60)
        cap = a.hinge("lever" if style == "turn" else "cap", UP, (0, 0, base), half, -half)
    cap.add(lathe([(radius, base), (radius, base + 0.6 * high), (0.7 * radius, base + high)]))
    lever = cap
    if style != "turn":
        lever = a.hinge("lever", LEFT, (0.0, 0.6 * radius, level), a.degrees(15, 40), on=cap)
    lever.add(lathe([(0.6 * radius, level), (0.5 * radius, level + 0.012)], sides=16))
    long, rise = a.draws((0.06, 0.11), (0.0, 0.05))
    bend = ((0.0, 0.007), (0.5, 0.009 + 0.5 * rise), (1.0, 0.009 + rise))
    arm = [(0, -share * long, level + up) for share, up in bend]
    lever.add(pipe(arm, [0.006, 0.007, 0.006], 8, up=UP, flat=a.draw(0.5, 1.0)))
    if a.happens(0.35):
        y = 1.8 * radius + 0.01
        top = a.draw(0.5, 0.9) * tall
        body.add(lathe([(0.008, 0.0), (0.006, 0.005)], (0, y, 0), sides=14))
        rod = a.slider("plug_rod", UP, (0, y, top), a.draw(0.01, 0.03))
        rod.add(cylinder(Z, (0.0, y), 0.0022, (0.0058, top), 10), ball((0, y, top), 0.006, 10))


def _plinth(a: Assembly, radius: float, tall: float) -> None:
    foot = radius * a.draw(1.1, 1.7)
    if a.happens(0.2):
        a.root.add(block(about(radius), about(radius), (0.0, tall), 0.003))
        a.root.add(block(about(foot), about(foot), (0.0001, 0.006), 0.004))
        return
    profile = [(foot, 0.0), (foot, 0.005), (1.02 * radius, a.draw(0.012, 0.02)), (radius, tall)]
    a.root.add(lathe(profile, sides=a.pick(16, 24, 32)))


def _spout(
    a: Assembly, part: PartDraft, radius: float, low: float
) -> tuple[FloatArray, FloatArray]:
    """Build a pipe that rises and comes down towards -Y; returns its end [m] and direction."""
    reach, rise, drop = a.draws((0.1, 0.24), (0.05, 0.3), (0.01, 0.06))
    thin = radius * a.draw(0.45, 0.8)
    style = a.pick("goose", "goose", "angle", "straight", "slant")
    top = low + rise
    if style == "goose":
        bend = arc((reach / 2, top), reach / 2, np.pi, -a.draw(0.0, 0.3), 13)
        line = [(0.0, low + 0.6 * rise), *bend, bend[-1] - (0.002, drop)]
    elif style == "angle":
        bow = 2.2 * thin
        first = arc((bow, top), bow, np.pi, np.pi / 2, 5)
        second = arc((reach - bow, top), bow, np.pi / 2, 0.0, 5)
        line = [*first, *second, (reach, top - drop)]
    elif style == "straight":
        bow = 1.8 * thin
        top = low + max(0.4 * rise, 2.5 * thin)
        corner = arc((bow, top), bow, np.pi, np.pi / 2, 6)
        line = [*corner, (reach, top + bow + a.draw(-0.02, 0.03))]
    else:
        corner = arc((0.03, low + 0.5 * rise), 0.03, np.pi, np.pi * 0.75, 4)
        line = [*corner, corner[-1] + 0.6 * reach, (reach, corner[-1, 1] + 0.4 * reach)]
    path = raised(np.array([(0.0, low), *line]) * (-1.0, 1.0), 0.0, X)
    sides = a.pick(4, 10, 14) if style in {"angle", "straight"} else 12
    part.add(pipe(path, thin, sides, up=RIGHT, flat=a.draw(0.7, 1.3)))
    if a.happens(0.7):
        collar = [(radius, 0.0002), (radius, 0.01), (1.05 * thin, a.draw(0.015, 0.03))]
        part.add(lathe([(r, low + z) for r, z in collar], sides=20))
    ahead = path[-1] - path[-2]
    ahead = ahead / np.linalg.norm(ahead)
    if a.happens(0.6):
        nozzle = [path[-1] - 0.02 * ahead, path[-1] + 0.005 * ahead]
        part.add(pipe(nozzle, thin * a.draw(1.08, 1.3), 14, up=RIGHT))
    return path[-1], ahead


def _grip(a: Assembly, style: str, low: float, radius: float, room: float) -> list[Form]:
    """Build a handle around z, standing on ``low``, reaching out by ``room`` at most [m]."""
    neck = radius * a.draw(0.6, 0.9)
    top = low + a.draw(0.015, 0.04)
    stem = lathe([(neck, low), (0.8 * neck, low + 0.7 * (top - low)), (neck, top)], sides=16)
    if style == "knob":
        cap = [(radius, top), (1.25 * radius, top + 0.008), (1.1 * radius, top + 0.022)]
        return [stem, lathe(cap, sides=a.pick(6, 8, 20))]
    if style == "cross":
        z = top - 0.008
        half = radius * a.draw(1.4, 2.2)
        thick = a.draw(0.004, 0.007)
        arms = [cylinder(axis, (0.0, z), thick, about(half), 10) for axis in (X, Y)]
        tips = ((half, 0.0), (-half, 0.0), (0.0, half), (0.0, -half)) if a.happens(0.5) else ()
        return [stem, *arms, *(ball((x, y, z), 1.5 * thick, 8) for x, y in tips)]
    length = min(a.draw(0.04, 0.09), room)
    lift = a.draw(-0.2, 0.5) * length
    path = [(0, -share * length, top - 0.006 + share * lift) for share in (0.0, 0.5, 1.0)]
    if style == "paddle":
        return [stem, pipe(path, neck * np.array((0.9, 0.8, 0.9)), 8, up=UP, flat=0.35)]
    return [stem, pipe(path, [0.006, 0.005, a.draw(0.005, 0.008)], up=UP)]


def _pair(a: Assembly, radius: float) -> None:
    """Build two handles beside the spout, on feet, often on one plate."""
    apart, base = a.draws((0.07, 0.14), (0.01, 0.05))
    style = a.pick("lever", "cross", "knob", "paddle")
    face = a.pick(0.0, np.pi / 2)
    low = base + PLAY
    forms = _grip(a, style, low, radius, apart - 1.7 * radius - 0.012)
    wide = style == "knob" and a.happens(0.5)
    upper = a.degrees(180, 360) if wide else a.degrees(80, 100)
    foot = lathe([(1.3 * radius, 0.0), (1.2 * radius, 0.006), (0.8 * radius, base)])
    for name, side in (("left", -1.0), ("right", 1.0)):
        at = (side * apart, 0.0, 0.0)
        a.root.add(foot.shifted(at))
        axis = (0.0, 0.0, -side)
        handle = a.hinge(f"{name}_handle", axis, (side * apart, 0, low), upper)
        handle.add(*(form.turned(UP, side * face).shifted(at) for form in forms))
    if a.happens(0.6):
        a.root.add(block(about(apart + 0.03), about(0.03), (-0.012, -0.0002), 0.028, 0.004))


def _single(a: Assembly, radius: float, tall: float) -> float:
    """Build a lever at the side that turns about its stem, or tips up; returns its top [m]."""
    thick, length, reach, lean = a.draws((0.007, 0.012), (0.015, 0.035), (0.05, 0.11), (0.0, 0.03))
    side = a.sign()
    # Clear of the flare at the foot, and of the spout above.
    z = a.draw(0.024 + thick, tall - thick)
    start = side * (1.02 * radius + PLAY)
    up = a.happens(0.6)
    lever = a.hinge("lever", RIGHT if up else LEFT, (start, 0, z), a.degrees(45, 90))
    lever.add(cylinder(X, (0.0, z), thick, span(start, side * length)))
    x = start + side * 0.6 * length
    tip = (x + side * lean, 0.0, z + reach) if up else (x, -reach, z)
    path = np.linspace((x, 0.0, z), tip, 3)
    lever.add(pipe(path, [0.005, 0.005, a.draw(0.005, 0.009)], up=BACK if up else UP))
    return tip[2]


def valve(a: Assembly) -> None:
    """Build a valve: a pipe with flanges, a bonnet and a hand wheel that turns without end."""
    radius, half, rim, neck = a.draws((0.012, 0.03), (0.06, 0.12), (0.03, 0.07), (0.03, 0.06))
    skin, bright = a.picks((STEEL, BRASS, BLACK), (STEEL, BRASS))
    body = a.body(skin)
    body.add(cylinder(X, (0.0, 0.0), radius, about(half), 20), ball((0, 0, 0), 1.5 * radius, 16))
    for end, way in ((-half - 0.01, 0.012), (half + 0.01, -0.012)):
        body.add(cylinder(X, (0.0, 0.0), 1.6 * radius, span(end, way), 20))
    high = 1.4 * radius + neck
    body.add(lathe([(radius, radius), (0.6 * radius, high - 0.02), (0.8 * radius, high)], sides=16))
    low = high + 0.001
    z = low + 0.015
    wheel = a.spin("wheel", UP, (0, 0, low), look=bright)
    ring = [(rim, z - 0.004), (rim + 0.005, z), (rim, z + 0.004), (rim - 0.005, z)]
    wheel.add(cylinder(Z, (0.0, 0.0), 0.004, span(low, 0.02), 10), lathe(ring, looped=True))
    spoke = box(about(rim), about(0.003), about(0.003, z))
    count = a.count(2, 4)
    wheel.add(*(spoke.turned(UP, np.pi * (i + 0.1) / count) for i in range(count)))


def switch_panel(a: Assembly) -> None:
    """Build an upright plate or box with one to twelve controls, mostly of one kind."""
    wide, tall, deep = a.draws((0.028, 0.05), (0.05, 0.09), (0.004, 0.05))
    skin, other = a.picks((WHITE, BLACK, STEEL, BRASS), (WHITE, BLACK, RED, STEEL))
    columns, rows = a.picks((1, 2, 3, 4), (1, 1, 2, 3))
    half = columns * wide / 2
    high = rows * tall + a.draw(0.015, 0.05)
    body = a.body(skin)
    plate = (0.0, deep)
    corner = a.draw(0.001, 0.012)
    side = about(half + a.draw(0.008, 0.025))
    body.add(block(side, plate, (0.0, high), corner, min(0.0015, 0.3 * deep), Y))
    main = a.pick(*CONTROLS)
    mixed = a.happens(0.3)
    for row, z in enumerate(shares(about(rows * tall / 2, high / 2), rows)):
        for column, x in enumerate(shares(about(half), columns)):
            kind = a.pick(*CONTROLS) if mixed else main
            at = (mid(x), mid(z))
            CONTROLS[kind](a, f"{kind}_{row}_{column}", at, 0.38 * wide, 0.38 * tall, other)
            if a.happens(0.3):
                label = about(0.01 * tall, z[0] + 0.05 * tall)
                body.add(box(about(0.4 * wide, at[0]), (-0.0004, 0.0), label), look=other)


def _rocker(a: Assembly, name: str, at: Flat, wide: float, tall: float, look: Material) -> None:
    """Build a shallow wedge on a pin: its upper half stands out, and goes in."""
    x, z = at
    tilt = a.draw(0.06, 0.14)
    rise = tall * np.tan(tilt)
    face = -PLAY - rise
    rocker = a.hinge(name, LEFT, (x, face, z), tilt, look=look)
    low, high = about(0.95 * tall, z)
    back = [(face, low), (face, high)]
    front = [(face - 0.002 - rise, high), (face - 0.002 - 0.3 * rise, z), (face - 0.0015, low)]
    rocker.add(prism([*back, *front], about(wide, x), X))


def _toggle(a: Assembly, name: str, at: Flat, wide: float, tall: float, look: Material) -> None:
    x, z = at
    lean, long = a.draws((0.25, 0.45), (0.012, 0.025))
    toggle = a.hinge(name, RIGHT, (x, -PLAY - 0.0075, z), 2 * lean, look=STEEL)
    end = (x, -PLAY - 0.003 - long * np.cos(lean), z + long * np.sin(lean))
    width = np.array((0.5, 0.8)) * min(0.35 * wide, 0.005)
    toggle.add(pipe([(x, -PLAY - 0.0035, z), end], width, up=RIGHT))


def _turned(a: Assembly, name: str, at: Flat, wide: float, tall: float, look: Material) -> None:
    upper = a.degrees(180, 320)
    ControlPanel(a, facing_front(0.0), look).knob(name, at, 0.9 * min(wide, tall), upper)


def _slid(a: Assembly, name: str, at: Flat, wide: float, tall: float, look: Material) -> None:
    x, z = at
    low = z - 0.8 * tall
    slide = a.slider(name, UP, (x, 0, low), 1.5 * tall, look=look)
    slide.add(box(about(0.001, x), (-PLAY - 0.005, -PLAY), span(low, 0.004)), look=STEEL)
    cap = (z - 0.95 * tall, z - 0.65 * tall + 0.004)
    slide.add(block(about(0.5 * wide, x), (-PLAY - 0.013, -PLAY - 0.005), cap, 0.002, axis=Y))


def _pressed(a: Assembly, name: str, at: Flat, wide: float, tall: float, look: Material) -> None:
    x, z = (about(0.8 * min(wide, tall), v) for v in at)
    stroke = a.draw(0.001, 0.003)
    panel = ControlPanel(a, facing_front(0.0), look)
    panel.button(name, x, z, stroke, style=a.pick(1.0, 0.3))


#: Controls of a switch panel, each made within ``wide`` and ``tall`` of its middle [m].
CONTROLS = {
    "rocker": _rocker, "toggle": _toggle, "knob": _turned, "slider": _slid, "button": _pressed,
}  # fmt: skip
