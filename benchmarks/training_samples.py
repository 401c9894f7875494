"""How fast training examples are made from nothing, on one core.

    python benchmarks/training_samples.py [REUSE]

Stages are making objects, giving them a character, sampling a point pool, and drawing from it. Each
object is pooled once and drawn in REUSE random states (16 unless told otherwise); all of it is
counted. Beside it the obvious way: for every example make an object, open its mesh, sample that
surface. Processor seconds, one JSON line.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterator

import numpy as np

from asset_factory.factory.errors import InputRejected
from asset_factory.factory.geometry.posing import posed
from asset_factory.factory.models.particulate import sampling
from asset_factory.factory.models.particulate.components import component_features
from asset_factory.factory.models.particulate.surface import Surface
from asset_factory.learn.objects import CATEGORIES, MixtureSettings, sample_object
from asset_factory.learn.samples.sample import DrawSettings, draw
from asset_factory.learn.samples.sampled_object import sampled_from

REUSE = 16
OBJECTS = 2
POOL = 16_384
SETTINGS = DrawSettings(components=True, facing_share=0.5, mirrored_share=0.5, stretch=0.3)


def ours(category: str, seed: int, reuse: int) -> tuple[float, float, float]:
    """Processor seconds to make an object, to pool it, and to draw it ``reuse`` times."""
    started = time.process_time()
    rng = np.random.default_rng(seed)
    _, articulation = sample_object(rng, MixtureSettings(categories=(category,)))
    made = time.process_time()
    sampled = sampled_from(articulation, "object", POOL, rng)
    pooled = time.process_time()
    for _ in range(reuse):
        draw(sampled, rng, SETTINGS)
    return made - started, pooled - made, time.process_time() - pooled


def anew(category: str, seed: int) -> float:
    """Processor seconds for one example without a pool: a new object, opened, sampled.

    Its points and component features are computed.
    """
    started = time.process_time()
    rng = np.random.default_rng(seed)
    _, articulation = sample_object(rng, MixtureSettings(categories=(category,)))
    values = {
        joint.name: float(rng.uniform(joint.lower, joint.upper))
        for joint in articulation.movable_joints
    }
    mesh = posed(articulation, values).mesh
    surface = Surface.of(mesh.vertices, mesh.faces)
    cloud = sampling.draw(surface, SETTINGS.points, rng, most_covered=0)
    component_features(cloud.points / mesh.extents.max(), cloud.normals, cloud.components)
    return time.process_time() - started


def rows(reuse: int) -> Iterator[tuple[str, tuple[float, float, float], float]]:
    """Category, seconds by stage, seconds of the obvious way, by object that fits the network."""
    for category in CATEGORIES:
        for seed in range(OBJECTS):
            try:
                yield category, ours(category, seed, reuse), anew(category, seed)
            except InputRejected:
                continue


def main(reuse: int) -> None:
    """Measure and print."""
    ours(CATEGORIES[0], 0, 1)
    found = list(rows(reuse))
    made, pooled, drawn = np.mean([seconds for _, seconds, _ in found], axis=0)
    fast = reuse / (made + pooled + drawn)
    slow = 1.0 / np.mean([seconds for *_, seconds in found])
    rates = {
        category: round(
            1.0 / float(np.mean([seconds[0] for name, seconds, _ in found if name == category]))
        )
        for category in dict.fromkeys(name for name, *_ in found)
    }
    line = {
        "benchmark": "training_samples",
        "reuse": reuse,
        "points": SETTINGS.points,
        "samples_per_s": round(fast),
        "made_anew_per_s": round(slow),
        "times_faster": round(fast / slow, 1),
        "objects_per_s": round(1.0 / made),
        "make_ms": round(1e3 * made, 2),
        "pool_ms": round(1e3 * pooled, 2),
        "draw_ms": round(1e3 * drawn / reuse, 2),
        "objects_per_s_by_category": rates,
    }
    print(json.dumps(line))


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else REUSE)
