"""An object as artists and CAD programs leave it: boards, shells, sheets, little that is closed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
import numpy.typing as npt

from asset_factory.factory.articulation import Articulation
from asset_factory.factory.mesh import FloatArray

from . import surfaces
from .details import lettered, without_handles, without_hidden, without_hidden_pieces
from .labelled import Labelled
from .united import all_united, parts_united

Pass = Callable[[Labelled, np.random.Generator], Labelled]


def _spaced(mesh: Labelled, rng: np.random.Generator) -> Labelled:
    """Shrink pieces, so that hairlines open between them, or grow them, by up to 2 mm."""
    return mesh.grown(float(rng.uniform(-1.0, 1.0)) * min(0.002, 0.004 * mesh.longest))


def _merged(mesh: Labelled, rng: np.random.Generator) -> Labelled:
    """Return the solids of most parts united; in one object of ten all parts are one skin."""
    if rng.random() < 0.1:
        return all_united(mesh)
    return parts_united(mesh, rng, float(rng.choice([0.4, 0.7, 1.0])))


#: What is done to an object, in this order, and in which share of those
#: - of separate solids, most of them closed: CAD exports and other generators;
#: - of one skin a part, cut open where nobody looks, every face twice: artists' models;
#: - in which nothing has a thickness: game assets.
PASSES: tuple[tuple[Pass, tuple[float, float, float]], ...] = (
    (without_hidden_pieces, (0.25, 0.35, 0.4)),
    (without_handles, (0.1, 0.1, 0.2)),
    (lettered, (0.12, 0.15, 0.15)),
    (surfaces.snapped, (0.5, 0.4, 0.3)),
    (surfaces.bevelled, (0.35, 0.0, 0.0)),
    (partial(surfaces.bevelled, share=0.5), (0.0, 0.5, 0.0)),
    (partial(surfaces.flattened, share=0.2), (0.0, 0.15, 0.0)),
    (partial(surfaces.flattened, share=0.8), (0.0, 0.0, 0.9)),
    (_spaced, (0.2, 0.0, 0.0)),
    (_merged, (0.2, 0.75, 0.0)),
    (without_hidden, (0.0, 0.4, 0.2)),
    (surfaces.without_sides, (0.0, 0.3, 0.0)),
    (partial(surfaces.opened, share=0.2), (0.0, 0.15, 0.0)),
    (partial(surfaces.opened, share=0.7), (0.0, 0.0, 0.7)),
    (partial(surfaces.exploded, share=0.2), (0.0, 0.1, 0.0)),
    (partial(surfaces.exploded, share=0.5), (0.0, 0.0, 0.4)),
    (surfaces.patched, (0.1, 0.35, 0.3)),
    (surfaces.subdivided, (0.3, 0.3, 0.3)),
    (surfaces.curved, (0.3, 0.4, 0.2)),
    (partial(surfaces.flipped, share=0.15), (0.1, 0.0, 0.0)),
    (surfaces.flipped, (0.0, 0.0, 0.3)),
    (partial(surfaces.doubled, share=0.2), (0.15, 0.0, 0.0)),
    (surfaces.doubled, (0.0, 0.85, 0.6)),
)
#: How often an object is one of boards, of shells and of sheets.
STYLES = (0.4, 0.5, 0.1)
#: Standard deviation of the logarithm of each axis' factor; twice that is the most.
STRETCH = 0.2
#: Factors of a mirror image.
LEFT_FOR_RIGHT = (-1.0, 1.0, 1.0)
#: A wider range [rad] is that of a knob or a wheel.
ALL_ROUND = 3.5
#: An axis this much off a coordinate axis still counts as along it.
ALONG = 1e-6


def artist_like(articulation: Articulation, seed: int) -> Articulation:
    """Return the object as an artist's file might hold it; same object and seed, same bytes.

    Parts and joints have the same names and tree. The whole may be stretched along its axes, and
    mirrored left for right; joints follow. Plain colours stand for textures. Every part that had
    faces still has some. Best of closed solids that share no vertices, as ``make_object`` gives
    them; pieces that are not closed are carried along.
    """
    rng = np.random.default_rng([seed, 0xA2])
    if rng.random() < 0.5:
        articulation = stretched(articulation, _factors(articulation, rng))
    if rng.random() < 0.5:
        articulation = stretched(articulation, LEFT_FOR_RIGHT)
    style = int(rng.choice(len(STYLES), p=STYLES))
    mesh = Labelled.of(articulation)
    for change, often in PASSES:
        if rng.random() < often[style]:
            mesh = change(mesh, rng)
    return mesh.articulation(articulation, "surface changed to look like an artist's model")


def _factors(articulation: Articulation, rng: np.random.Generator) -> FloatArray:
    """Return the three axes' factors, alike across what turns all round: wheels stay round."""
    logarithms = np.clip(rng.normal(0.0, STRETCH, 3), -2.0 * STRETCH, 2.0 * STRETCH)
    for joint in articulation.joints:
        if joint.turns and joint.range > ALL_ROUND:
            across = np.arange(3) != np.abs(joint.axis).argmax()
            logarithms[across] = logarithms[across].mean()
    return np.asarray(np.exp(logarithms))


def stretched(articulation: Articulation, factors: npt.ArrayLike) -> Articulation:
    """Scale an object along x, y and z; a factor below 0 mirrors it. Opening stays positive.

    Where a joint lies aslant, all factors are as large as their mean. A part turns as rigidly as
    before, but two of its sides may come to meet what they missed.
    """
    wanted = np.asarray(factors, dtype=np.float64)
    size = np.abs(wanted)
    if wanted.shape != (3,) or not (size > 0.0).all():
        raise ValueError(f"factors are {wanted.tolist()}, want three other than 0")
    if any(np.abs(joint.axis).max() < 1.0 - ALONG for joint in articulation.movable_joints):
        size = np.full(3, float(np.prod(size)) ** (1.0 / 3.0))
    way = np.sign(wanted)
    joints = []
    for each in articulation.joints:
        along = 1.0 if each.turns else float(size[np.abs(each.axis).argmax()])
        # In a mirror a turn goes the other way about its axis.
        axis = way * each.axis * (np.prod(way) if each.turns else 1.0)
        moved = replace(each, axis=axis, origin=way * size * each.origin)
        joints.append(replace(moved, lower=each.lower * along, upper=each.upper * along))
    mesh = articulation.mesh.transformed(np.diag([*(way * size), 1.0]))
    return replace(articulation, mesh=mesh, joints=tuple(joints))
