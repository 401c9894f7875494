"""An object as artists and CAD programs leave it: shells, sheets, boards, lettering, and little that is closed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from ....articulation import Articulation
from ....mesh import FloatArray
from .bevelled import bevelled, curved, snapped
from .details import lettered, without_handles
from .divided import exploded, patched, subdivided
from .hidden import without_hidden, without_hidden_pieces
from .labelled import Labelled
from .placed import mirrored, stretched
from .sheets import doubled, flattened, flipped, opened, without_sides
from .united import all_united, grown, parts_united

Pass = Callable[[Labelled, np.random.Generator], Labelled]


@dataclass(frozen=True)
class Step:
    """A pass and how often it is taken: 0 to 1."""

    change: Pass
    often: float


def _spaced(mesh: Labelled, rng: np.random.Generator) -> Labelled:
    """Pieces shrunk, so that hairlines open between them, or grown into one another, by up to 2 mm."""
    return grown(mesh, float(rng.uniform(-1.0, 1.0)) * min(0.002, 0.004 * mesh.longest))


def _merged(mesh: Labelled, rng: np.random.Generator) -> Labelled:
    """The solids of most parts united; in one object of ten all parts are one skin."""
    return (
        all_united(mesh, rng)
        if rng.random() < 0.1
        else parts_united(mesh, rng, float(rng.choice([0.4, 0.7, 1.0])))
    )


#: Separate solids, most of them closed: CAD exports and other generators.
BOARDS: tuple[Step, ...] = (
    Step(without_hidden_pieces, 0.25),
    Step(without_handles, 0.1),
    Step(lettered, 0.12),
    Step(snapped, 0.5),
    Step(bevelled, 0.35),
    Step(_spaced, 0.2),
    Step(_merged, 0.2),
    Step(patched, 0.1),
    Step(subdivided, 0.3),
    Step(curved, 0.3),
    Step(partial(flipped, share=0.15), 0.1),
    Step(partial(doubled, share=0.2), 0.15),
)

#: One skin a part, cut open where nobody looks, every face twice: repositories of artists' models.
SHELLS: tuple[Step, ...] = (
    Step(without_hidden_pieces, 0.35),
    Step(without_handles, 0.1),
    Step(lettered, 0.15),
    Step(snapped, 0.4),
    Step(partial(bevelled, share=0.5), 0.5),
    Step(partial(flattened, share=0.2), 0.15),
    Step(_merged, 0.75),
    Step(without_hidden, 0.4),
    Step(without_sides, 0.3),
    Step(partial(opened, share=0.2), 0.15),
    Step(partial(exploded, share=0.2), 0.1),
    Step(patched, 0.35),
    Step(subdivided, 0.3),
    Step(curved, 0.4),
    Step(doubled, 0.85),
)

#: Nothing has a thickness: game assets.
SHEETS: tuple[Step, ...] = (
    Step(without_hidden_pieces, 0.4),
    Step(without_handles, 0.2),
    Step(lettered, 0.15),
    Step(snapped, 0.3),
    Step(partial(flattened, share=0.8), 0.9),
    Step(partial(opened, share=0.7), 0.7),
    Step(without_hidden, 0.2),
    Step(partial(exploded, share=0.5), 0.4),
    Step(patched, 0.3),
    Step(subdivided, 0.3),
    Step(curved, 0.2),
    Step(flipped, 0.3),
    Step(doubled, 0.6),
)

#: Which of them, and how often.
STYLES: tuple[tuple[tuple[Step, ...], float], ...] = ((BOARDS, 0.4), (SHELLS, 0.5), (SHEETS, 0.1))

STRETCH = 0.2
"""Standard deviation of the logarithm of each axis' factor, where an object is stretched; twice that is the most."""
ALL_ROUND = 3.5
"""A wider range [rad] is that of a knob or a wheel."""


def artist_like(articulation: Articulation, seed: int) -> Articulation:
    """The object with another surface, as an artist's file might hold it; parts and joints mean the same.

    Args:
        articulation: labelled, best of closed solids that share no vertices, as ``make_object``
            gives it; pieces that are not closed are carried along.
        seed: same object and seed, same bytes.

    Returns:
        Parts and joints of the same names and tree. The whole may be stretched along its axes, and
        mirrored left for right; joints follow. Plain colours stand for textures. Every part that
        had faces still has some.
    """
    rng = np.random.default_rng([seed, 0xA2])
    if rng.random() < 0.5:
        articulation = stretched(articulation, _factors(articulation, rng))
    if rng.random() < 0.5:
        articulation = mirrored(articulation)
    steps = STYLES[int(rng.choice(len(STYLES), p=[often for _, often in STYLES]))][0]
    mesh = changed(Labelled.of(articulation), steps, rng)
    return mesh.articulation(articulation, "surface changed to look like an artist's model")


def _factors(articulation: Articulation, rng: np.random.Generator) -> FloatArray:
    """Of the three axes; alike across an axis about which something turns all round, so that wheels stay round."""
    logarithms = np.clip(rng.normal(0.0, STRETCH, 3), -2.0 * STRETCH, 2.0 * STRETCH)
    for joint in articulation.joints:
        if joint.turns and joint.range > ALL_ROUND:
            across = np.arange(3) != np.abs(joint.axis).argmax()
            logarithms[across] = logarithms[across].mean()
    return np.asarray(np.exp(logarithms))


def changed(mesh: Labelled, steps: Sequence[Step], rng: np.random.Generator) -> Labelled:
    """The mesh after each step was taken, or not, by chance."""
    for step in steps:
        if rng.random() < step.often:
            mesh = step.change(mesh, rng)
    return mesh
