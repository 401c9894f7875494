"""Eyeglasses."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...mesh import FloatArray, Material, Mesh
from .looks import BLACK, BLUE, BRASS, GLASS, RED, STEEL, WALNUT, pick
from .parts import degrees
from .rounds import loft, pipe, ribbon
from .trees import hinge, tree


def eyeglasses(rng: np.random.Generator) -> Articulation:
    """A front with two lenses or a shield, and two temples, spread as they are worn; positive values fold them in."""
    u = rng.uniform
    skin, tint = pick(rng, BLACK, STEEL, BRASS, RED, WALNUT), pick(rng, GLASS, STEEL, BLUE)
    half, wide, high = u(0.062, 0.074), u(0.022, 0.028), u(0.016, 0.025)
    long, bar, rim, level = u(0.12, 0.15), u(0.0018, 0.005), u(0.0012, 0.003), 0.05
    shield = rng.random() < 0.2
    if shield:
        bend = u(0.01, 0.022)
        body, front, start = _shield(half, high, bend, level, tint), bend + 0.001, half
    else:
        body, start = _front(rng, half, wide, high, level, rim, skin, tint), half - 0.006
        front = 0.0
    z, thick, pivot_y = level + u(0.0, 0.6) * high, bar * u(1.0, 2.2), front + u(0.012, 0.02)
    path = _temple(rng, long)
    sharp = int(rng.choice([4, 8]))
    upper = degrees(rng, 75, 88)
    limbs = []
    for name, side in (("left", -1.0), ("right", 1.0)):
        x = side * half
        corner = [(side * start, front, z), (x, front + 0.003, z), (x, pivot_y - bar - 0.001, z)]
        body.append(pipe(corner, bar * 0.95, skin, 4, flat=thick / bar))
        line = np.column_stack([np.full(len(path), x), pivot_y + path[:, 0], z + path[:, 1]])
        width = [bar, 0.9 * bar, 0.8 * bar, *[bar] * (len(path) - 3)]
        temple = pipe(line, width, skin, sharp, up=(side, 0.0, 0.0), flat=1.0)
        squeezed = temple.vertices * [1.0, 1.0, thick / bar] + [0.0, 0.0, z * (1.0 - thick / bar)]
        temple = Mesh(squeezed, temple.faces, None, None, temple.face_material, temple.materials)
        limbs.append(hinge(f"{name}_temple", [temple], (0.0, 0.0, side), (x, pivot_y, z), upper))
    return tree(body, limbs)


def _temple(rng: np.random.Generator, long: float) -> FloatArray:
    """Backward and upward coordinates of a temple's middle line, from its hinge [m], shape [point_count, 2]."""
    drop, bend = rng.uniform(0.01, 0.04), rng.uniform(0.6, 0.8)
    straight = [(0.0, 0.0), (0.3 * long, 0.0), (bend * long, 0.0)]
    curl = [(bend * long + t * (1 - bend) * long, -drop * t**1.5) for t in (0.33, 0.66, 1.0)]
    return np.array([*straight, *curl])


def _front(
    rng: np.random.Generator, half: float, wide: float, high: float, level: float, rim: float, skin: Material,
    tint: Material,
) -> list[Mesh]:  # fmt: skip
    """Two rims around lenses, a bridge, at times pads for the nose."""
    u = rng.uniform
    power, rimless = float(rng.choice([2.0, 2.5, 3.5])), rng.random() < 0.15
    wide = min(wide, 0.42 * half)
    center, lean = half - wide - 0.004, u(0.0, 0.12)
    angle = 2.0 * np.pi * np.arange(28) / 28
    x = wide * np.sign(np.cos(angle)) * np.abs(np.cos(angle)) ** (2 / power)
    z = high * np.sign(np.sin(angle)) * np.abs(np.sin(angle)) ** (2 / power)
    # Higher on the outer side, as cat-eye frames are.
    z += u(0.0, 0.15) * high * x / wide
    solids: list[Mesh] = []
    for side in (-1.0, 1.0):
        line = np.stack([side * (center + x), lean * x, level + z], axis=1)
        if not rimless:
            solids.append(pipe(line, rim, skin, 6, looped=True, up=(0.0, 1.0, 0.0)))
        if not rng.random() < 0.1:
            depth = np.array([0.0, 0.0006, 0.0])
            solids.append(loft(np.stack([line - depth, line + depth]), tint))
    inner, lift = center - 0.97 * wide, u(0.0, 0.45) * high
    y = -lean * wide
    span = [(-inner, y, level + lift), (-0.4 * inner, y - 0.002, level + lift + 0.004)]
    solids.append(
        pipe([*span, *[(-px, py, pz) for px, py, pz in span[::-1]]], max(rim, 0.0015), skin, 8)
    )
    if rng.random() < 0.5:
        for side in (-1.0, 1.0):
            end = (side * 0.6 * inner, y + 0.009, level - 0.3 * high)
            solids.append(pipe([(side * inner, y, level - 0.1 * high), end], 0.0008, skin, 6))
            pad = [(end[0], end[1], end[2] - 0.006), end, (end[0], end[1], end[2] + 0.006)]
            solids.append(pipe(pad, [0.0015, 0.003, 0.0015], tint, 8, up=(0.0, 1.0, 0.0)))
    return solids


def _shield(half: float, high: float, bend: float, level: float, tint: Material) -> list[Mesh]:
    """One bent lens over both eyes, with a notch for the nose."""
    x = np.linspace(-half, half, 17)
    back = bend * (x / half) ** 2
    notch = level - high + 0.7 * high * np.exp(-((x / 0.012) ** 2))
    top = level + high - 0.15 * high * (x / half) ** 2
    rings = np.stack([
        np.stack([x, back, notch], axis=1), np.stack([x, back + 0.0016, notch], axis=1),
        np.stack([x, back + 0.0016, top], axis=1), np.stack([x, back, top], axis=1),
    ], axis=1)  # fmt: skip
    brow = ribbon(
        2,
        np.stack([x, back - 0.001], axis=1),
        np.stack([x, back + 0.003], axis=1),
        (level + 0.8 * high, level + high + 0.003),
        tint,
    )
    return [loft(rings, tint), brow]


MAKERS = {"eyeglasses": eyeglasses}
