"""What is fitted to walls and pipes: faucets, valves, panels of switches."""

from __future__ import annotations

import numpy as np

from ....mesh import FloatArray, Material
from ..kit.assembly import BACK, LEFT, RIGHT, UP, Assembly, PartDraft, facing_front
from ..kit.controls import button, knob
from ..kit.looks import BLACK, BRASS, RED, STEEL, WHITE
from ..kit.shapes import (
    Form,
    X,
    Y,
    Z,
    about,
    arc,
    ball,
    block,
    box,
    cylinder,
    lathe,
    mid,
    pipe,
    prism,
    shares,
    span,
)  # fmt: skip

PLAY = 0.0008


def faucet(a: Assembly) -> None:
    """A spout with one lever or two handles; most spouts swivel."""
    body = a.body(a.pick(STEEL, BRASS, BLACK, WHITE))
    if a.happens(0.25):
        _mixer(a)
        return
    two = a.happens(0.55)
    radius, tall = a.draw(0.014, 0.028), a.draw(0.03 if two else 0.06, 0.12)
    _plinth(a, radius, tall)
    half = np.pi if a.happens(0.2) else a.degrees(40, 100)
    spout = a.hinge("spout", UP, (0, 0, tall), half, -half) if a.happens(0.7) else body
    path = _spout(a, spout, radius, tall + PLAY)
    if a.happens(0.2):
        _spray(a, spout, path, radius)
    if two:
        _pair(a, radius)
    else:
        _single(a, radius, tall)


def _mixer(a: Assembly) -> None:
    """A column, the spout in front of it, one lever on top that turns, lifts, or both; at times a plug rod."""
    radius, tall, reach, body = *a.draws((0.018, 0.027), (0.07, 0.2), (0.09, 0.16)), a.root
    _plinth(a, radius, tall)
    low, thin = a.draw(0.45, 0.75) * tall, radius * a.draw(0.45, 0.7)
    end = low + a.draw(-0.02, 0.03)
    path = [(0, -0.8 * radius, low), (0, -0.5 * reach, low + a.draw(-0.01, 0.04)), (0, -reach, end)]
    sides, flat = a.pick(4, 12), a.draw(0.5, 1.0)
    body.add(pipe(path, thin * np.array((1.0, 0.9, 0.8)), sides, up=UP, flat=flat))
    body.add(
        lathe([(0.7 * thin, end), (0.7 * thin, end - 0.018)], (0, 0.8 * thin - reach, 0), sides=14)
    )
    base, high, half = tall + PLAY, a.draw(0.012, 0.03), a.degrees(30, 60)
    level, style = base + high + 0.001, a.pick("turn", "lift", "chain")
    cap = body
    if style != "lift":
        cap = a.hinge("lever" if style == "turn" else "cap", UP, (0, 0, base), half, -half)
    cap.add(lathe([(radius, base), (radius, base + 0.6 * high), (0.7 * radius, base + high)]))
    lever, pivot = cap, (0.0, 0.6 * radius, level)
    if style != "turn":
        lever = a.hinge("lever", LEFT, pivot, a.degrees(15, 40), on=cap)
    long, rise = a.draw(0.06, 0.11), a.draw(0.0, 0.05)
    lever.add(lathe([(0.6 * radius, level), (0.5 * radius, level + 0.012)], sides=16))
    arm = [
        (0, 0, level + 0.007),
        (0, -0.5 * long, level + 0.009 + 0.5 * rise),
        (0, -long, level + 0.009 + rise),
    ]
    lever.add(pipe(arm, [0.006, 0.007, 0.006], 8, up=UP, flat=a.draw(0.5, 1.0)))
    if a.happens(0.35):
        y, top = 1.8 * radius + 0.01, a.draw(0.5, 0.9) * tall
        body.add(lathe([(0.008, 0.0), (0.006, 0.005)], (0, y, 0), sides=14))
        rod = a.slider("plug_rod", UP, (0, y, top), a.draw(0.01, 0.03))
        rod.add(cylinder(Z, (0.0, y), 0.0022, (0.0058, top), 10), ball((0, y, top), 0.006, 10))


def _spray(a: Assembly, spout: PartDraft, path: FloatArray, radius: float) -> None:
    """A head that pulls out of the end of the spout."""
    ahead = path[-1] - path[-2]
    ahead = ahead / np.linalg.norm(ahead)
    start, long = path[-1] + 0.007 * ahead, a.draw(0.02, 0.06)
    axis, at = (tuple(v.tolist()) for v in (ahead, start))
    head = a.slider("spray", axis, at, a.draw(0.05, 0.2), on=spout)
    line = [start + share * long * ahead for share in (0.0, 0.5, 1.0)]
    head.add(pipe(line, radius * np.array((0.6, 0.65, 0.8)), 14, up=RIGHT))


def _plinth(a: Assembly, radius: float, tall: float) -> None:
    foot = radius * a.draw(1.1, 1.7)
    if a.happens(0.2):
        a.root.add(block(about(radius), about(radius), (0.0, tall), 0.003))
        a.root.add(block(about(foot), about(foot), (0.0001, 0.006), 0.004))
        return
    profile = [(foot, 0.0), (foot, 0.005), (1.02 * radius, a.draw(0.012, 0.02)), (radius, tall)]
    a.root.add(lathe(profile, sides=a.pick(16, 24, 32)))


def _spout(a: Assembly, part: PartDraft, radius: float, low: float) -> FloatArray:
    """A pipe that rises and comes down towards -Y, with a collar and a nozzle; its path [m], shape [n, 3]."""
    thin, reach, rise, drop = (
        radius * a.draw(0.45, 0.8),
        *a.draws((0.1, 0.24), (0.05, 0.3), (0.01, 0.06)),
    )
    style, top = a.pick("goose", "goose", "angle", "straight", "slant"), low + rise
    foot = [(0.0, low)]
    if style == "goose":
        bend = arc((reach / 2, top), reach / 2, np.pi, -a.draw(0.0, 0.3), 13)
        line = np.vstack([foot, [(0.0, low + 0.6 * rise)], bend, [bend[-1] - (0.002, drop)]])
    elif style == "angle":
        bow = 2.2 * thin
        first = arc((bow, top), bow, np.pi, np.pi / 2, 5)
        second = arc((reach - bow, top), bow, np.pi / 2, 0.0, 5)
        line = np.vstack([foot, first, second, [(reach, top - drop)]])
    elif style == "straight":
        bow, top = 1.8 * thin, low + max(0.4 * rise, 2.5 * thin)
        corner = arc((bow, top), bow, np.pi, np.pi / 2, 6)
        line = np.vstack([foot, corner, [(reach, top + bow + a.draw(-0.02, 0.03))]])
    else:
        corner = arc((0.03, low + 0.5 * rise), 0.03, np.pi, np.pi * 0.75, 4)
        knee, end = corner[-1] + 0.6 * reach, (reach, corner[-1, 1] + 0.4 * reach)
        line = np.vstack([foot, corner, [knee], [end]])
    path = np.column_stack([np.zeros(len(line)), -line[:, 0], line[:, 1]])
    sides = a.pick(4, 10, 14) if style in {"angle", "straight"} else 12
    part.add(pipe(path, thin, sides, up=RIGHT, flat=a.draw(0.7, 1.3)))
    if a.happens(0.7):
        collar = [(radius, 0.0002), (radius, 0.01), (1.05 * thin, a.draw(0.015, 0.03))]
        part.add(lathe([(r, low + z) for r, z in collar], sides=20))
    if a.happens(0.6):
        ahead = path[-1] - path[-2]
        ahead = ahead / np.linalg.norm(ahead)
        nozzle = [path[-1] - 0.02 * ahead, path[-1] + 0.005 * ahead]
        part.add(pipe(nozzle, thin * a.draw(1.08, 1.3), 14, up=RIGHT))
    return path


def _grip(a: Assembly, style: str, low: float, radius: float, room: float) -> list[Form]:
    """A handle around the z axis, standing on ``low`` and reaching out by ``room`` at most [m]."""
    neck, top, length = (
        radius * a.draw(0.6, 0.9),
        low + a.draw(0.015, 0.04),
        min(a.draw(0.04, 0.09), room),
    )
    stem = lathe([(neck, low), (0.8 * neck, low + 0.7 * (top - low)), (neck, top)], sides=16)
    if style == "knob":
        cap = [(radius, top), (1.25 * radius, top + 0.008), (1.1 * radius, top + 0.022)]
        return [stem, lathe(cap, sides=a.pick(6, 8, 20))]
    if style == "cross":
        z, half, thick = top - 0.008, radius * a.draw(1.4, 2.2), a.draw(0.004, 0.007)
        arms = [cylinder(axis, (0.0, z), thick, about(half), 10) for axis in (X, Y)]
        ends = ((half, 0.0), (-half, 0.0), (0.0, half), (0.0, -half)) if a.happens(0.5) else ()
        return [stem, *arms, *(ball((x, y, z), 1.5 * thick, 8) for x, y in ends)]
    start, lift = top - 0.006, a.draw(-0.2, 0.5) * length
    path = [(0, 0, start), (0, -0.5 * length, start + 0.5 * lift), (0, -length, start + lift)]
    if style == "paddle":
        return [stem, pipe(path, neck * np.array((0.9, 0.8, 0.9)), 8, up=UP, flat=0.35)]
    return [stem, pipe(path, [0.006, 0.005, a.draw(0.005, 0.008)], up=UP)]


def _pair(a: Assembly, radius: float) -> None:
    """Two handles beside the spout, on feet, often on one plate."""
    apart, base = a.draw(0.07, 0.14), a.draw(0.01, 0.05)
    style, low, face = (
        a.pick("lever", "cross", "knob", "paddle"),
        base + PLAY,
        a.pick(0.0, np.pi / 2),
    )
    forms = _grip(a, style, low, radius, apart - 1.7 * radius - 0.012)
    upper = a.degrees(180, 360) if style == "knob" and a.happens(0.5) else a.degrees(80, 100)
    foot = lathe([(1.3 * radius, 0.0), (1.2 * radius, 0.006), (0.8 * radius, base)])
    for name, side in (("left", -1.0), ("right", 1.0)):
        at = (side * apart, 0.0, 0.0)
        a.root.add(foot.shifted(at))
        handle = a.hinge(f"{name}_handle", (0.0, 0.0, -side), (side * apart, 0, low), upper)
        handle.add(*(form.turned(UP, side * face).shifted(at) for form in forms))
    if a.happens(0.6):
        a.root.add(block(about(apart + 0.03), about(0.03), (-0.012, -0.0002), 0.028, 0.004))


def _single(a: Assembly, radius: float, tall: float) -> None:
    """One lever at the side: it turns about its stem, or tips up."""
    side, (thick, length, reach) = a.sign(), a.draws((0.007, 0.012), (0.015, 0.035), (0.05, 0.11))
    # Clear of the flare at the foot, and of the spout above.
    z, start, up = a.draw(0.024 + thick, tall - thick), 1.02 * radius + PLAY, a.happens(0.6)
    lever = a.hinge("lever", RIGHT if up else LEFT, (side * start, 0, z), a.degrees(45, 90))
    lever.add(cylinder(X, (0.0, z), thick, span(side * start, side * length)))
    x = side * (start + 0.6 * length)
    tip = (x + side * a.draw(0.0, 0.03), 0.0, z + reach) if up else (x, -reach, z)
    path = [(x, 0.0, z), ((x + tip[0]) / 2, tip[1] / 2, (z + tip[2]) / 2), tip]
    lever.add(pipe(path, [0.005, 0.005, a.draw(0.005, 0.009)], up=BACK if up else UP))


def valve(a: Assembly) -> None:
    """A valve: a pipe with flanges, a bonnet and a hand wheel that turns without end."""
    skin, bright = a.picks((STEEL, BRASS, BLACK), (STEEL, BRASS))
    radius, half, rim, body = *a.draws((0.012, 0.03), (0.06, 0.12), (0.03, 0.07)), a.body(skin)
    body.add(cylinder(X, (0.0, 0.0), radius, about(half), 20), ball((0, 0, 0), 1.5 * radius, 16))
    for end, way in ((-half - 0.01, 0.012), (half + 0.01, -0.012)):
        body.add(cylinder(X, (0.0, 0.0), 1.6 * radius, span(end, way), 20))
    high = 1.4 * radius + a.draw(0.03, 0.06)
    body.add(lathe([(radius, radius), (0.6 * radius, high - 0.02), (0.8 * radius, high)], sides=16))
    low, z = high + 0.001, high + 0.016
    wheel = a.spin("wheel", UP, (0, 0, low), look=bright)
    ring = [(rim, z - 0.004), (rim + 0.005, z), (rim, z + 0.004), (rim - 0.005, z)]
    wheel.add(cylinder(Z, (0.0, 0.0), 0.004, span(low, 0.02), 10), lathe(ring, looped=True))
    spoke, count = box(about(rim), about(0.003), about(0.003, z)), a.count(2, 4)
    wheel.add(*(spoke.turned(UP, np.pi * (i + 0.1) / count) for i in range(count)))


def switch_panel(a: Assembly) -> None:
    """An upright plate or box with one to twelve controls, mostly of one kind."""
    skin, other = a.picks((WHITE, BLACK, STEEL, BRASS), (WHITE, BLACK, RED, STEEL))
    columns, rows, body = a.count(1, 4), a.pick(1, 1, 2, 3), a.body(skin)
    wide, tall, deep = a.draws((0.028, 0.05), (0.05, 0.09), (0.004, 0.05))
    half, high = columns * wide / 2 + a.draw(0.008, 0.025), rows * tall + a.draw(0.015, 0.05)
    plate = about(half), (0.0, deep), (0.0, high)
    body.add(block(*plate, a.draw(0.001, 0.012), min(0.0015, 0.3 * deep), Y))
    main, mixed = a.pick(*CONTROLS), a.happens(0.3)
    for row, z in enumerate(shares(about(rows * tall / 2, high / 2), rows)):
        for column, x in enumerate(shares(about(columns * wide / 2), columns)):
            kind = a.pick(*CONTROLS) if mixed else main
            CONTROLS[kind](
                a, f"{kind}_{row}_{column}", mid(x), mid(z), 0.38 * wide, 0.38 * tall, other
            )
            if a.happens(0.3):
                label = box(
                    about(0.4 * wide, mid(x)),
                    (-0.0004, 0.0),
                    about(0.01 * tall, z[0] + 0.05 * tall),
                )
                body.add(label, look=other)


def _rocker(
    a: Assembly, name: str, x: float, z: float, wide: float, tall: float, look: Material
) -> None:
    """A shallow wedge on a pin: its upper half stands out, and goes in."""
    tilt = a.draw(0.06, 0.14)
    rise = tall * np.tan(tilt)
    face = -PLAY - rise
    rocker = a.hinge(name, LEFT, (x, face, z), tilt, look=look)
    low, high = z - 0.95 * tall, z + 0.95 * tall
    outline = [
        (face, low),
        (face, high),
        (face - 0.002 - rise, high),
        (face - 0.002 - 0.3 * rise, z),
        (face - 0.0015, low),
    ]
    rocker.add(prism(outline, about(wide, x), X))


def _toggle(
    a: Assembly, name: str, x: float, z: float, wide: float, tall: float, look: Material
) -> None:
    radius, lean, long = min(0.35 * wide, 0.005), *a.draws((0.25, 0.45), (0.012, 0.025))
    toggle = a.hinge(name, RIGHT, (x, -PLAY - 0.0075, z), 2 * lean, look=STEEL)
    end = (x, -PLAY - 0.003 - long * np.cos(lean), z + long * np.sin(lean))
    toggle.add(pipe([(x, -PLAY - 0.0035, z), end], [0.5 * radius, 0.8 * radius], up=RIGHT))


def _turned(
    a: Assembly, name: str, x: float, z: float, wide: float, tall: float, look: Material
) -> None:
    knob(a, name, (x, z), 0.9 * min(wide, tall), look, facing_front(0.0), upper=a.degrees(180, 320))


def _slid(
    a: Assembly, name: str, x: float, z: float, wide: float, tall: float, look: Material
) -> None:
    low = z - 0.8 * tall
    slide = a.slider(name, UP, (x, 0, low), 1.5 * tall, look=look)
    slide.add(box(about(0.001, x), (-PLAY - 0.005, -PLAY), span(low, 0.004)), look=STEEL)
    cap = (
        about(0.5 * wide, x),
        (-PLAY - 0.013, -PLAY - 0.005),
        (z - 0.95 * tall, z - 0.65 * tall + 0.004),
    )
    slide.add(block(*cap, 0.002, axis=Y))


def _pressed(
    a: Assembly, name: str, x: float, z: float, wide: float, tall: float, look: Material
) -> None:
    spot = [about(0.8 * min(wide, tall), v) for v in (x, z)]
    button(
        a, name, *spot, look, facing_front(0.0), stroke=a.draw(0.001, 0.003), style=a.pick(1.0, 0.3)
    )


#: Controls of a switch panel, each made within ``wide`` and ``tall`` of its middle [m].
CONTROLS = {
    "rocker": _rocker,
    "toggle": _toggle,
    "knob": _turned,
    "slider": _slid,
    "button": _pressed,
}

MAKERS = {"faucet": faucet, "valve": valve, "switch_panel": switch_panel}
