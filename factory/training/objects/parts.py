"""What furniture and appliances are assembled from: carcasses, drawers, fronts, handles, knobs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...articulation import Articulation, Joint, JointKind, Part
from ...mesh import Material, Mesh, concatenate
from .solids import Span, box, cylinder

#: Boards that meet are set back by this much, so that no two of them share a corner [m].
REVEAL = 0.001
#: Between anything that moves and anything else [m].
GAP = 0.003


@dataclass(frozen=True)
class Moving:
    """A part that one joint moves, closed at joint value 0 and open at ``upper``.

    Attributes:
        name: of the part; its joint is called ``<name>_joint``.
        solids: closed convex solids in the closed pose, object frame [m].
        kind: revolute or prismatic.
        axis: unit vector; positive values open.
        origin: a point on the axis [m].
        upper: fully open [rad] or [m].
    """

    name: str
    solids: tuple[Mesh, ...]
    kind: JointKind
    axis: tuple[float, float, float]
    origin: tuple[float, float, float]
    upper: float


def assemble(body: Sequence[Mesh], moving: Sequence[Moving]) -> Articulation:
    """One articulation: the body is the root, every moving part hangs on it."""
    groups: list[Sequence[Mesh]] = [body, *(m.solids for m in moving)]
    counts = [sum(len(solid.faces) for solid in group) for group in groups]
    ends = np.cumsum(counts)
    names = ["body", *(m.name for m in moving)]
    parts = [
        Part(n, np.arange(end - count, end))
        for n, count, end in zip(names, counts, ends, strict=True)
    ]
    joints = [
        Joint(
            f"{m.name}_joint", m.kind, 0, i + 1, np.array(m.axis), np.array(m.origin), 0.0, m.upper
        )
        for i, m in enumerate(moving)
    ]
    mesh = concatenate([solid for group in groups for solid in group])
    return Articulation(mesh, tuple(parts), tuple(joints), "procedural")


def millimetres(rng: np.random.Generator, low: float, high: float) -> float:
    """A length between ``low`` and ``high`` [m], in whole millimetres."""
    return float(rng.integers(round(low * 1000), round(high * 1000) + 1)) / 1000.0


def degrees(rng: np.random.Generator, low: float, high: float) -> float:
    """An angle between ``low`` and ``high`` [degrees], in whole degrees, as radians."""
    return float(np.radians(rng.integers(round(low), round(high) + 1)))


def carcass(
    x: Span, y: Span, z: Span, wall: float, material: Material, back: float = 0.008
) -> list[Mesh]:
    """Two sides, a bottom, a top and a back around a cavity that is open towards -Y.

    Args:
        x: outer span [m].
        y: outer span [m].
        z: outer span [m].
        wall: thickness of sides, bottom and top [m].
        material: of all boards.
        back: thickness of the back [m].

    Returns:
        Boards that touch and do not overlap; see :func:`cavity` for what they enclose.
    """
    inner_x = (x[0] + wall, x[1] - wall)
    board_y = (y[0] + REVEAL, y[1] - REVEAL)
    return [
        box((x[0], inner_x[0]), y, z, material),
        box((inner_x[1], x[1]), y, z, material),
        box(inner_x, board_y, (z[0] + REVEAL, z[0] + wall), material),
        box(inner_x, board_y, (z[1] - wall, z[1] - REVEAL), material),
        box(
            inner_x,
            (y[1] - 2 * REVEAL - back, y[1] - 2 * REVEAL),
            (z[0] + wall, z[1] - wall),
            material,
        ),
    ]


def cavity(x: Span, y: Span, z: Span, wall: float, back: float = 0.008) -> tuple[Span, Span, Span]:
    """Inner spans of a :func:`carcass` of the same arguments [m]."""
    return (x[0] + wall, x[1] - wall), (y[0], y[1] - 2 * REVEAL - back), (z[0] + wall, z[1] - wall)


def tub(x: Span, y: Span, z: Span, wall: float, material: Material) -> list[Mesh]:
    """An open-topped box without its front: two sides, a back and a bottom; outer spans [m]."""
    inner_x = (x[0] + wall, x[1] - wall)
    return [
        box((x[0], inner_x[0]), y, z, material),
        box((inner_x[1], x[1]), y, z, material),
        box(inner_x, (y[1] - REVEAL - wall, y[1] - REVEAL), (z[0] + wall, z[1] - REVEAL), material),
        box(inner_x, (y[0], y[1] - 2 * REVEAL), (z[0] + REVEAL, z[0] + wall), material),
    ]


def front(x: Span, y: Span, z: Span, style: str, material: Material) -> list[Mesh]:
    """A door or drawer front: ``slab``, or ``shaker`` with a raised frame. It never leaves its spans [m]."""
    frame, raised = 0.055, 0.006
    if style == "slab" or min(x[1] - x[0], z[1] - z[0]) < 3 * frame:
        return [box(x, y, z, material)]
    face = y[0] + raised
    rails_x = (x[0] + frame, x[1] - frame)
    return [
        box(x, (face, y[1]), z, material),
        box((x[0] + REVEAL, rails_x[0]), (y[0], face), (z[0] + REVEAL, z[1] - REVEAL), material),
        box((rails_x[1], x[1] - REVEAL), (y[0], face), (z[0] + REVEAL, z[1] - REVEAL), material),
        box(rails_x, (y[0] + REVEAL, face), (z[0] + 2 * REVEAL, z[0] + frame), material),
        box(rails_x, (y[0] + REVEAL, face), (z[1] - frame, z[1] - 2 * REVEAL), material),
    ]


def handle(
    style: str, x: float, face: float, z: float, upright: bool, length: float, material: Material
) -> list[Mesh]:
    """Something to pull at, on a face that looks towards -Y.

    Args:
        style: ``bar`` (round), ``rail`` (square) or ``knob``.
        x: of its middle [m].
        face: plane it stands on [m].
        z: of its middle [m].
        upright: along z instead of x.
        length: of bar or rail [m].
        material: of all its pieces.
    """
    reach, radius = 0.035, 0.006
    if style == "knob":
        return [
            cylinder(1, (z, x), radius, (face - 0.018, face), material, sides=12),
            cylinder(1, (z, x), 0.015, (face - 0.03, face - 0.018), material),
        ]
    half, post = length / 2, length / 2 - 0.02
    along = (z - half, z + half) if upright else (x - half, x + half)
    grip = (face - reach - radius, face - reach + radius)
    if style == "bar":
        axis, center = (2, (x, face - reach)) if upright else (0, (face - reach, z))
        pieces, post_y = (
            [cylinder(axis, center, radius, along, material, sides=16)],
            (face - reach, face),
        )
    else:
        across = (x - radius, x + radius) if upright else (z - radius, z + radius)
        pieces = [
            box(across, grip, along, material) if upright else box(along, grip, across, material)
        ]
        post_y = (grip[1], face)
    for offset in (-post, post):
        px, pz = (x, z + offset) if upright else (x + offset, z)
        pieces.append(box((px - 0.004, px + 0.004), post_y, (pz - 0.004, pz + 0.004), material))
    return pieces


def drawer(
    name: str,
    panel: Sequence[Mesh],
    x: Span,
    y: Span,
    z: Span,
    material: Material,
    wall: float = 0.012,
) -> Moving:
    """A drawer: a front with its handle, and the box behind it.

    Args:
        name: of the part.
        panel: front and handle.
        x: outer span of the box [m].
        y: outer span of the box; ``y[0]`` is the back of the front [m].
        z: outer span of the box [m].
        material: of the box.
        wall: thickness of the box [m].

    Returns:
        A part that slides out by 80 % of its depth.
    """
    center = ((x[0] + x[1]) / 2, y[0], (z[0] + z[1]) / 2)
    solids = (*panel, *tub(x, y, z, wall, material))
    return Moving(
        name, solids, JointKind.PRISMATIC, (0.0, -1.0, 0.0), center, round(0.8 * (y[1] - y[0]), 3)
    )


def side_door(
    name: str, solids: Sequence[Mesh], x: Span, face: float, z: Span, hinge: str, upper: float
) -> Moving:
    """A door that turns about its own front edge, as on a real hinge: it clears its frame and its neighbours.

    Args:
        name: of the part.
        solids: closed pose.
        x: span of the door [m].
        face: its frontmost plane, handle apart [m].
        z: span of the door [m].
        hinge: ``left`` or ``right``, seen from the front.
        upper: fully open [rad].
    """
    left = hinge == "left"
    axis = (0.0, 0.0, -1.0) if left else (0.0, 0.0, 1.0)
    origin = (x[0] if left else x[1], face, (z[0] + z[1]) / 2)
    return Moving(name, tuple(solids), JointKind.REVOLUTE, axis, origin, upper)


def drop_door(
    name: str, solids: Sequence[Mesh], x: Span, face: float, bottom: float, upper: float
) -> Moving:
    """A door that drops open about its lower front edge; arguments as in :func:`side_door`."""
    origin = ((x[0] + x[1]) / 2, face, bottom)
    return Moving(name, tuple(solids), JointKind.REVOLUTE, (1.0, 0.0, 0.0), origin, upper)


def knob(
    name: str, x: float, face: float, z: float, radius: float, material: Material, mark: Material
) -> Moving:
    """A knob that turns clockwise through 270 degrees, a gap in front of ``face`` [m]."""
    back, rim = face - 0.002, face - 0.024
    solids = (
        cylinder(1, (z, x), radius, (rim, back), material),
        box((x - 0.003, x + 0.003), (rim - 0.006, rim), (z - 0.8 * radius, z + 0.8 * radius), mark),
    )
    return Moving(
        name, solids, JointKind.REVOLUTE, (0.0, 1.0, 0.0), (x, back, z), float(np.radians(270.0))
    )


def feet(x: Span, y: Span, height: float, size: float, material: Material) -> list[Mesh]:
    """Four square feet under the corners of a body whose underside is at ``height`` [m]."""
    inset = 0.004
    return [
        box((fx, fx + size), (fy, fy + size), (0.0, height), material)
        for fx in (x[0] + inset, x[1] - inset - size)
        for fy in (y[0] + inset, y[1] - inset - size)
    ]
