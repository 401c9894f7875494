"""Things to pull at and to turn, on a face that looks towards -Y."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...mesh import Material
from .limbs import Limb, sliding, turning
from .pieces import Block, Form, Piece, extruded, pipe, rod, turned
from .solids import Span

#: Kinds of grip and how often each is drawn; ``none`` is a front that is pushed or pulled by its
#: edge.
KINDS: dict[str, float] = {
    "bar": 0.2, "rail": 0.12, "bow": 0.16, "knob": 0.16, "ball": 0.07, "cup": 0.06,
    "lip": 0.05, "recess": 0.06, "strap": 0.04, "none": 0.08,
}  # fmt: skip
#: How far a grip's feet reach into its panel, so that they meet it under any relief [m].
ROOT = 0.008


@dataclass(frozen=True)
class Grip:
    """The grip that all fronts of one object wear.

    Attributes:
        kind: one of :data:`KINDS`.
        length: along it [m]; of a knob, nothing.
        reach: how far it stands out [m].
        thickness: of its bar [m].
        material: its look.
    """

    kind: str
    length: float
    reach: float
    thickness: float
    material: Material


def any_grip(rng: np.random.Generator, material: Material, kinds: tuple[str, ...] = ()) -> Grip:
    """A grip of the given kinds, or of any."""
    names = kinds or tuple(KINDS)
    weight = np.array([KINDS[n] for n in names])
    kind = names[int(rng.choice(len(names), p=weight / weight.sum()))]
    return Grip(
        kind,
        float(rng.uniform(0.08, 0.32)),
        float(rng.uniform(0.018, 0.045)),
        float(rng.uniform(0.006, 0.016)),
        material,
    )


def gripped(grip: Grip, x: float, z: float, face: float, upright: bool, room: float) -> list[Piece]:
    """A grip about ``(x, z)`` on the plane y = ``face`` [m].

    Args:
        grip: which.
        x: of its middle [m].
        z: of its middle [m].
        face: the plane that it stands on [m].
        upright: along z instead of x.
        room: the longest it may be [m].
    """
    length = min(grip.length, 0.9 * room)
    if grip.kind == "none" or length < 0.02:
        return []
    if grip.kind in ("knob", "ball"):
        return [_knob(grip, x, z, face)]
    half = length / 2
    if grip.kind == "bow":
        return [_bow(grip, x, z, face, upright, half)]
    along = (z - half, z + half) if upright else (x - half, x + half)
    if grip.kind == "recess":
        return _recess(grip, x, z, face, along, upright)
    if grip.kind in ("cup", "lip") and not upright:
        return _hood(grip, z, face, along)
    return _bar(grip, x, z, face, along, upright)


def _bar(grip: Grip, x: float, z: float, face: float, along: Span, upright: bool) -> list[Piece]:
    r = grip.thickness / 2
    middle = face - grip.reach + r
    pieces: list[Piece] = []
    if grip.kind == "bar":
        pieces.append(
            rod(
                2 if upright else 0,
                (x, middle) if upright else (middle, z),
                r,
                along,
                grip.material,
                10,
            )
        )
    else:
        wide = (1.8 if grip.kind == "strap" else 1.0) * r
        across = (x - wide, x + wide) if upright else (z - wide, z + wide)
        y = (middle - r, middle + r)
        pieces.append(
            Block(across, y, along, grip.material)
            if upright
            else Block(along, y, across, grip.material)
        )
    inset = min(0.02 if grip.kind == "bar" else r, (along[1] - along[0]) / 4)
    foot = 0.7 * r
    for end in (along[0] + inset, along[1] - inset):
        px, pz = (x, end) if upright else (end, z)
        pieces.append(
            Block(
                (px - foot, px + foot), (middle, face + ROOT), (pz - foot, pz + foot), grip.material
            )
        )
    return pieces


def _bow(grip: Grip, x: float, z: float, face: float, upright: bool, half: float) -> Form:
    t = np.linspace(-1.0, 1.0, 9)
    path = np.empty((9, 3))
    path[:, 1] = face + ROOT - (grip.reach - grip.thickness / 2 + ROOT) * (1.0 - np.abs(t) ** 3)
    path[:, 0], path[:, 2] = (x, z + half * t) if upright else (x + half * t, z)
    return pipe(path, grip.thickness / 2, grip.material)


def _knob(grip: Grip, x: float, z: float, face: float) -> Form:
    r, tip = 0.8 * grip.thickness + 0.006, face - grip.reach
    if grip.kind == "ball":
        s = np.linspace(0.15, np.pi - 0.3, 6)
        profile = [(tip + r - r * float(np.cos(v)), r * float(np.sin(v))) for v in s]
        profile = [p for p in profile if p[0] < face - 0.002]
        return turned(
            1,
            (z, x),
            [*profile, (face - 0.001, 0.5 * r), (face + ROOT, 0.5 * r)],
            grip.material,
            12,
        )
    head = tip + 0.45 * grip.reach
    profile = [
        (tip, 0.85 * r),
        (tip + 0.003, r),
        (head, r),
        (head + 0.002, 0.5 * r),
        (face + ROOT, 0.5 * r),
    ]
    return turned(1, (z, x), profile, grip.material, 12)


def _recess(grip: Grip, x: float, z: float, face: float, along: Span, upright: bool) -> list[Piece]:
    """A shell let into the face; its rim stands a hair proud of it."""
    half = max(0.012, grip.thickness)
    across = (x - half, x + half) if upright else (z - half, z + half)
    low, high = (face - 0.0015, face + 0.004), (face - 0.0004, face + 0.004)
    rim = 0.004
    inner_a, inner_b = (along[0] + rim, along[1] - rim), (across[0] + rim, across[1] - rim)
    frames = [(along, (across[0], inner_b[0])), (along, (inner_b[1], across[1]))]
    frames += [((along[0], inner_a[0]), inner_b), ((inner_a[1], along[1]), inner_b)]
    pairs = [(a, b, low) for a, b in frames] + [(inner_a, inner_b, high)]
    return [
        Block(b, y, a, grip.material) if upright else Block(a, y, b, grip.material)
        for a, b, y in pairs
    ]


def _hood(grip: Grip, z: float, face: float, along: Span) -> list[Piece]:
    """A quarter shell to reach under, or a lip bent from a plate."""
    reach, m = min(grip.reach, 0.03), grip.material
    if grip.kind == "lip":
        return [
            Block(along, (face - 0.002, face + ROOT), (z - 0.012, z + 0.012), m),
            Block(along, (face - reach, face - 0.002), (z + 0.009, z + 0.012), m),
            Block(along, (face - reach, face - reach + 0.003), (z - 0.002, z + 0.009), m),
        ]
    angle = np.linspace(0.0, np.pi / 2, 6)
    outer = np.stack([face - reach * np.cos(angle), z - 0.015 + 0.03 * np.sin(angle)], axis=1)
    inner = outer * [1.0, 1.0] + np.stack([0.003 * np.cos(angle), -0.003 * np.sin(angle)], axis=1)
    pieces: list[Piece] = []
    for i in range(len(angle) - 1):
        stave = np.array([outer[i], inner[i], inner[i + 1], outer[i + 1]])
        pieces.append(extruded(0, stave, along, m))
    cheek = np.array([(face + 0.001, z - 0.015), *outer[::-1]])
    pieces += [
        extruded(0, cheek, span, m)
        for span in ((along[0], along[0] + 0.003), (along[1] - 0.003, along[1]))
    ]
    return pieces


def dial(
    rng: np.random.Generator,
    name: str,
    x: float,
    z: float,
    face: float,
    radius: float,
    looks: tuple[Material, Material],
) -> Limb:
    """A knob to turn, a gap in front of ``face``: plain, stepped or with a grip across it."""
    back = face - float(rng.uniform(0.0, 0.002))
    depth = float(rng.uniform(0.6, 1.4)) * radius
    rim, sides = back - depth, int(rng.choice([12, 16, 24]))
    style = int(rng.integers(3))
    pieces: list[Piece] = []
    if style == 0:
        pieces = [turned(1, (z, x), [(rim, 0.85 * radius), (back, radius)], looks[0], sides)]
        pieces.append(
            Block(
                (x - 0.08 * radius, x + 0.08 * radius),
                (rim - 0.001, rim + 0.001),
                (z, z + 0.8 * radius),
                looks[1],
            )
        )
    elif style == 1:
        step = back - 0.35 * depth
        profile = [
            (rim, 0.6 * radius),
            (step - 0.0005, 0.65 * radius),
            (step, radius),
            (back, radius),
        ]
        pieces = [turned(1, (z, x), profile, looks[0], sides)]
    else:
        step = back - 0.3 * depth
        pieces = [
            rod(1, (z, x), radius, (step, back), looks[0], sides),
            Block(
                (x - 0.2 * radius, x + 0.2 * radius),
                (rim, step),
                (z - 0.95 * radius, z + 0.95 * radius),
                looks[0],
            ),
        ]
    upper = float(rng.choice([np.pi / 2, np.pi, 1.5 * np.pi, 5.2]))
    return turning(name, pieces, (0.0, 1.0, 0.0), (x, back, z), upper)


def button(
    name: str, x: Span, z: Span, face: float, proud: float, material: Material, is_round: bool
) -> Limb:
    """A button that goes in by half of what it stands out."""
    center = ((x[0] + x[1]) / 2, face, (z[0] + z[1]) / 2)
    back = face - 0.5 * proud
    radius = min(x[1] - x[0], z[1] - z[0]) / 2
    piece: Piece = Block(x, (face - proud, back), z, material)
    if is_round:
        piece = rod(1, (center[2], center[0]), radius, (face - proud, back), material)
    return sliding(name, [piece], (0.0, 1.0, 0.0), center, 0.5 * proud)
