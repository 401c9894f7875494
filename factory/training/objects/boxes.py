"""Boxes with flaps, cases, suitcases, mailboxes."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...mesh import FloatArray, Material, Mesh
from .castors import castor, disc
from .looks import BLACK, BLUE, BRASS, GREEN, OAK, RED, STEEL, WALNUT, WHITE, pick
from .parts import degrees
from .rounds import block, loft, pipe, ribbon, rounded, swept, turned
from .solids import Span, box, cylinder
from .trees import Limb, hinge, slider, tree, wheel

PLAY = 0.0008


def flap_box(rng: np.random.Generator) -> Articulation:
    """A carton with two to four flaps, closed or standing open at rest.

    Flaps turn outwards. Where two pairs lie on each other, each is free on its own: who opens a
    lower flap pushes the upper ones up.
    """
    u = rng.uniform
    skin = pick(rng, OAK, WHITE, BLUE, BRASS)
    half_x, half_y, high, wall = u(0.06, 0.3), u(0.06, 0.25), u(0.06, 0.4), u(0.0015, 0.005)
    x, y = (-half_x, half_x), (-half_y, half_y)
    body = [
        ribbon(
            2,
            _corners(half_x, half_y),
            _corners(half_x - wall, half_y - wall),
            (0.0, high),
            skin,
            looped=True,
        )
    ]
    body.append(box((x[0] + wall, x[1] - wall), (y[0] + wall, y[1] - wall), (0.0, wall), skin))
    style = str(rng.choice(["four", "four", "long", "short", "lid", "tuck"]))
    limbs: list[Limb] = []
    standing_open = rng.random() < 0.4
    level = high + PLAY
    if style == "lid":
        plate = [box(x, (y[0] - 0.001, y[1]), (level, level + wall), skin)]
        return tree(
            body, [hinge("lid", plate, (-1, 0, 0), (0, y[1], level), degrees(rng, 90, 170))]
        )
    if style == "tuck":
        return tree(body, _tuck_top(rng, half_x, half_y, level, wall, skin))
    share = u(0.6, 1.0)
    if style in {"four", "short"}:
        long = share * min(half_y, half_x) if style == "four" else half_x - PLAY
        limbs += _flap_pair(rng, 0, half_x, half_y - wall, long, level, wall, skin)
        level += wall + PLAY
    if style in {"four", "long"}:
        limbs += _flap_pair(rng, 1, half_y, half_x, half_y - PLAY, level, wall, skin)
    if standing_open:
        # All of them lean outwards, or one would stand in another's way.
        limbs = [
            _opened(limb, rng.uniform(1.62, 0.9 * limb.upper) if limb.upper > 1.9 else 0.0)
            for limb in limbs
        ]
    return tree(body, limbs)


def _tuck_top(
    rng: np.random.Generator,
    half_x: float,
    half_y: float,
    level: float,
    wall: float,
    skin: Material,
) -> list[Limb]:
    """The top of a product box, standing open: a lid with a tongue at its end, and two dust flaps beneath."""
    u = rng.uniform
    dust = _flap_pair(
        rng, 0, half_x, half_y - wall, u(0.5, 0.95) * min(half_x, half_y), level, wall, skin
    )
    limbs = [
        _opened(limb, u(1.62, 0.9 * limb.upper)) if limb.upper > 1.9 else limb for limb in dust
    ]
    value, tongue, low = u(1.65, 2.6), u(0.15, 0.5) * half_y, level + wall + PLAY
    pin = (0.0, half_y + wall, low)
    lid = hinge(
        "lid",
        [box((-half_x, half_x), (-half_y, half_y), (low, low + wall), skin)],
        (-1, 0, 0),
        pin,
        value + u(0.2, 1.0),
    )
    inset, edge = 0.04 * half_x, -half_y - PLAY
    plate = box((-half_x + inset, half_x - inset), (edge - tongue, edge), (low, low + wall), skin)
    [plate] = turned([plate], (-1, 0, 0), value, pin)
    [hem] = turned([box((0.0, 1.0), (edge, 0.0), (low, low + wall), skin)], (-1, 0, 0), value, pin)
    at = hem.vertices[0]
    bend = hinge(
        "tongue",
        [plate],
        (-1, 0, 0),
        (0.0, float(at[1]), float(at[2])),
        0.1,
        -float(np.pi / 2),
        parent="lid",
    )
    return [*limbs, _opened(lid, value), bend]


def _corners(half_x: float, half_y: float) -> FloatArray:
    return np.array([(half_x, half_y), (-half_x, half_y), (-half_x, -half_y), (half_x, -half_y)])


def _flap_pair(
    rng: np.random.Generator,
    axis: int,
    edge: float,
    half: float,
    long: float,
    level: float,
    wall: float,
    skin: Material,
) -> list[Limb]:
    """Two flaps at ``+-edge`` along ``axis``, each reaching inwards by ``long`` [m]."""
    limbs, upper = [], degrees(rng, 180, 250) if rng.random() < 0.6 else degrees(rng, 90, 170)
    side_inset = 0.001 + 0.02 * half
    for name, side in (("near", -1.0), ("far", 1.0)):
        span = sorted((side * edge, side * (edge - long)))
        across = (-half + side_inset, half - side_inset)
        spans = ((span[0], span[1]), across) if axis == 0 else (across, (span[0], span[1]))
        turn = (0.0, side, 0.0) if axis == 0 else (-side, 0.0, 0.0)
        # A little outside the wall it hangs on, or the flap would cut into that.
        pin = side * (edge + wall)
        origin = (pin, 0.0, level) if axis == 0 else (0.0, pin, level)
        plate = box(*spans, (level, level + wall), skin)
        limbs.append(hinge(f"flap_{'xy'[axis]}_{name}", [plate], turn, origin, upper))
    return limbs


def _opened(limb: Limb, value: float) -> Limb:
    """The limb with its rest pose at ``value`` of the old one; ``lower`` stays closed."""
    return Limb(
        limb.name,
        tuple(turned(limb.solids, limb.axis, value, limb.origin)),
        limb.kind,
        limb.axis,
        limb.origin,
        limb.upper - value,
        -value,
    )


def _half_shell(
    x: Span, y: Span, z: Span, wall: float, radius: float, skin: Material, up: bool
) -> Mesh:
    """An open tray with rounded corners that faces up, or down."""
    outer, inner = (
        rounded(x, y, radius),
        rounded((x[0] + wall, x[1] - wall), (y[0] + wall, y[1] - wall), max(radius - wall, 0.001)),
    )
    low, high = (z[0], z[1]) if up else (z[1], z[0])
    floor = low + wall if up else low - wall
    soft = outer * [0.99, 0.98]
    return loft(
        swept(
            2,
            np.array([soft, outer, outer, inner, inner]),
            [low, low + 0.2 * (high - low), high, high, floor],
        ),
        skin,
    )


def case(rng: np.random.Generator) -> Articulation:
    """A briefcase, a tool case or a suitcase lying down: two shells, latches, a grip that folds."""
    u = rng.uniform
    skin, metal = pick(rng, BLACK, WALNUT, BLUE, STEEL, RED), pick(rng, BRASS, STEEL, BLACK)
    half_x, half_y, low, high = u(0.15, 0.35), u(0.11, 0.24), u(0.03, 0.12), u(0.025, 0.1)
    wall, r = 0.004, u(0.006, 0.05)
    x, y = (-half_x, half_x), (-half_y, half_y)
    seam = low + PLAY
    body = [_half_shell(x, y, (0.0, low), wall, r, skin, True)]
    lid = [_half_shell(x, y, (seam, seam + high), wall, r, skin, False)]
    pin_y = half_y + 0.004
    for cx in (-0.6 * half_x, 0.6 * half_x):
        body.append(cylinder(0, (pin_y, seam), 0.003, (cx - 0.03, cx - 0.001), metal, 8))
        lid.append(cylinder(0, (pin_y, seam), 0.003, (cx + 0.001, cx + 0.03), metal, 8))
        body.append(
            box(
                (cx - 0.028, cx - 0.003),
                (half_y - 0.002, pin_y),
                (seam - 0.012, seam - 0.001),
                metal,
            )
        )
        lid.append(
            box(
                (cx + 0.003, cx + 0.028),
                (half_y - 0.002, pin_y),
                (seam + 0.001, seam + 0.012),
                metal,
            )
        )
    limbs = [hinge("lid", lid, (-1, 0, 0), (0, pin_y, seam), degrees(rng, 80, 120))]
    front = y[0]
    if rng.random() < 0.7:
        for i, cx in enumerate((-0.55 * half_x, 0.55 * half_x)):
            latch = box(
                (cx - 0.012, cx + 0.012),
                (front - 0.006, front - PLAY),
                (seam - 0.012, seam + 0.008),
                metal,
            )
            limbs.append(
                hinge(
                    f"latch_{i}",
                    [latch],
                    (1, 0, 0),
                    (cx, front - 0.006, seam - 0.012),
                    degrees(rng, 60, 120),
                )
            )
    grip_half, reach, z = u(0.045, 0.07), u(0.025, 0.04), min(0.6 * low, low - 0.016)
    path = [
        (-grip_half, front - 0.008, z),
        (-0.85 * grip_half, front - reach, z),
        (0.85 * grip_half, front - reach, z),
        (grip_half, front - 0.008, z),
    ]
    grip = pipe(path, 0.004, BLACK, 8)
    for side in (-1.0, 1.0):
        cx = side * (grip_half + 0.008)
        body.append(
            box(
                (cx - 0.003, cx + 0.003),
                (front - 0.011, front + 0.002),
                (z - 0.005, z + 0.005),
                metal,
            )
        )
    if rng.random() < 0.7:
        limbs.append(
            hinge("grip", [grip], (1, 0, 0), (0, front - 0.008, z), degrees(rng, 50, 75), -0.1)
        )
    else:
        body.append(grip)
    return tree(body, limbs)


def trolley_case(rng: np.random.Generator) -> Articulation:
    """An upright suitcase: a telescopic handle, two or four wheels, at times a front that opens."""
    u = rng.uniform
    skin, metal = pick(rng, BLACK, BLUE, RED, GREEN, STEEL), pick(rng, STEEL, BLACK)
    half_x, half_y, high = u(0.17, 0.25), u(0.1, 0.15), u(0.45, 0.7)
    radius, four, r = u(0.018, 0.03), rng.random() < 0.5, u(0.02, 0.06)
    base = 2 * radius + 0.008
    tube, apart = 0.006, u(0.05, 0.5 * half_x)
    well = 0.022
    front_y = (-half_y, half_y - 2 * well)
    opens = rng.random() < 0.5
    split = front_y[0] + u(0.3, 0.65) * (front_y[1] - front_y[0])
    body: list[Mesh] = []
    limbs: list[Limb] = []
    if opens:
        back = _half_shell(
            (base, base + high),
            (-half_x, half_x),
            (split + PLAY, front_y[1]),
            0.004,
            r,
            skin,
            False,
        )
        lid = _half_shell(
            (base, base + high), (-half_x, half_x), (front_y[0], split), 0.004, r, skin, True
        )
        turn = np.array(
            [[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
        )
        body.append(back.transformed(turn))
        side = float(rng.choice([-1.0, 1.0]))
        pin = (side * (half_x + 0.002), split, base + high / 2)
        limbs.append(
            hinge("front", [lid.transformed(turn)], (0.0, 0.0, side), pin, degrees(rng, 80, 170))
        )
    else:
        body.append(block(1, (base, base + high), (-half_x, half_x), front_y, skin, r, bevel=0.015))
    body.append(
        box(
            (-half_x + r, half_x - r),
            (front_y[1] - 0.003, front_y[1] + well),
            (base + 0.01, base + 0.05),
            metal,
        )
    )
    for s in (-1.0, 1.0):
        ring = np.array(
            [
                (s * apart + a * 0.011, front_y[1] + 0.011 + b * 0.0105)
                for a, b in ((1, 1), (-1, 1), (-1, -1), (1, -1))
            ]
        )
        hole = np.array(
            [
                (s * apart + a * (tube + PLAY), front_y[1] + 0.011 + b * (tube + PLAY))
                for a, b in ((1, 1), (-1, 1), (-1, -1), (1, -1))
            ]
        )
        body.append(ribbon(2, ring, hole, (base + 0.051, base + high), metal, looped=True))
    top = base + high + u(0.005, 0.04)
    y = front_y[1] + 0.011
    bars = [cylinder(2, (s * apart, y), tube, (base + 0.055, top), metal, 10) for s in (-1.0, 1.0)]
    bars.append(
        block(
            2,
            (-apart - 0.012, apart + 0.012),
            (y - 0.011, y + 0.011),
            (top, top + 0.022),
            BLACK,
            0.008,
            bevel=0.004,
        )
    )
    limbs.append(slider("handle", bars, (0, 0, 1), (0, y, top), u(0.25, 0.8) * high))
    limbs += _luggage_wheels(rng, body, half_x - r, front_y, radius, base, four, metal)
    return tree(body, limbs)


def _luggage_wheels(
    rng: np.random.Generator,
    body: list[Mesh],
    half: float,
    y: Span,
    radius: float,
    base: float,
    four: bool,
    metal: Material,
) -> list[Limb]:
    limbs: list[Limb] = []
    for row, at in (("rear", y[1] - 0.02), ("front", y[0] + 0.03)):
        for name, side in (("left", -1.0), ("right", 1.0)):
            x = side * (half - 0.012)
            if four:
                at_y = at - (0.02 if row == "rear" else 0.0)
                limbs += castor(f"{row}_{name}", x, at_y, base, radius, 0.012, 0.0, BLACK, metal)
            elif row == "rear":
                limbs.append(
                    wheel(
                        f"{name}_wheel",
                        disc((x, at, radius), radius, 0.02, BLACK, metal),
                        (1, 0, 0),
                        (x, at, radius),
                    )
                )
                body += [
                    box(
                        (x + s * 0.0155 - 0.002, x + s * 0.0155 + 0.002),
                        (at - 0.01, at + 0.01),
                        (0.6 * radius, base + 0.002),
                        metal,
                    )
                    for s in (-1, 1)
                ]
            else:
                body.append(
                    box((x - 0.01, x + 0.01), (at - 0.015, at + 0.015), (0.0, base - 0.008), metal)
                )
    return limbs


def mailbox(rng: np.random.Generator) -> Articulation:
    """An arched box with a door in front and a flag, on a post or on its own; or a wall box with a flap."""
    u = rng.uniform
    skin, flag_skin, metal = (
        pick(rng, BLACK, WHITE, BLUE, STEEL, RED),
        pick(rng, RED, BRASS),
        pick(rng, OAK, STEEL),
    )
    half, long, wall_h, wall = u(0.07, 0.12), u(0.2, 0.28), u(0.06, 0.16), 0.003
    post = u(0.7, 1.0) if rng.random() < 0.5 else 0.0
    angle = np.linspace(0.0, np.pi, 11)
    rise = u(0.5, 1.0)
    arch = np.vstack(
        [
            [(half, 0.0)],
            np.stack([half * np.cos(angle), wall_h + rise * half * np.sin(angle)], axis=1),
            [(-half, 0.0)],
        ]
    )
    inner = np.vstack(
        [
            [(half - wall, wall)],
            np.stack(
                [(half - wall) * np.cos(angle), wall_h + (rise * half - wall) * np.sin(angle)],
                axis=1,
            ),
            [(-half + wall, wall)],
        ]
    )
    lift = [0.0, post]
    body = [
        ribbon(1, (arch + lift)[:, ::-1], (inner + lift)[:, ::-1], (-long, long), skin, looped=True)
    ]
    plate = swept(1, (inner + lift)[:, ::-1], [long - wall, long])
    body.append(loft(plate, skin))
    if post:
        size = u(0.03, 0.05)
        body.append(box((-size, size), (-size, size), (0.0, post), metal))
    door_y = (-long - PLAY - 0.004, -long - PLAY)
    door = [loft(swept(1, (arch + lift)[:, ::-1], door_y), skin)]
    door.append(
        block(
            1,
            (post + wall_h + 0.2 * half, post + wall_h + 0.2 * half + 0.03),
            (-0.01, 0.01),
            (door_y[0] - 0.02, door_y[0]),
            metal,
            0.004,
        )
    )
    limbs = [hinge("door", door, (1, 0, 0), (0, door_y[0], post), degrees(rng, 80, 120))]
    if rng.random() < 0.8:
        x, y, z = half + PLAY, u(-0.5, 0.3) * long, post + 0.7 * wall_h
        reach = u(0.08, 0.14)
        flag = [
            cylinder(0, (y, z), 0.008, (x, x + 0.006), metal, 12),
            box((x + 0.001, x + 0.004), (y, y + reach), (z - 0.006, z + 0.006), flag_skin),
        ]
        flag.append(
            box(
                (x + 0.0012, x + 0.0038),
                (y + 0.7 * reach, y + reach),
                (z + 0.005, z + 0.035),
                flag_skin,
            )
        )
        limbs.append(hinge("flag", flag, (1, 0, 0), (x, y, z), float(np.pi / 2)))
    return tree(body, limbs)


MAKERS = {"flap_box": flap_box, "case": case, "trolley_case": trolley_case, "mailbox": mailbox}
