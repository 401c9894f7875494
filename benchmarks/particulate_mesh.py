"""The network articulator's mesh work: sampling, decimation, labels back. One JSON line.

A closed box of about 300,000 bumpy faces is sampled as the released network wants it (102,400
points, and 40,000 more for features); one of about 1.2 million is shown lighter and its labels are
carried back and refined.
"""

from __future__ import annotations

import json
import resource
import time

import numpy as np

from asset_factory.factory.models.particulate.labels import Refinement, refined, with_gaps_filled
from asset_factory.factory.models.particulate.proxy import carried_back, proxy_of
from asset_factory.factory.models.particulate.sampling import sample
from asset_factory.factory.models.particulate.surface import Surface

POINTS = 102_400
CONTEXT = 40_000
MOST_FACES = 50_000


def bumpy_box(across: int) -> Surface:
    """A unit box of ``12 * across**2`` faces with bumps that make many edges sharp."""
    steps = np.linspace(-0.5, 0.5, across + 1)
    u, v = (each.ravel() for each in np.meshgrid(steps, steps))
    first = (np.arange(across)[:, None] * (across + 1) + np.arange(across)).ravel()
    square = np.array([[0, 1, across + 2], [0, across + 2, across + 1]])
    faces = (first[:, None, None] + square).reshape(-1, 3)
    sides = [
        np.roll(np.stack([u, v, np.full(len(u), end)], axis=1), k, axis=1)
        for k in range(3)
        for end in (-0.5, 0.5)
    ]
    vertices = np.concatenate(sides)
    # Bumps by place, so that the sides still meet.
    vertices += 0.2 / across * np.sin(vertices[:, [1, 2, 0]] * across * 2.4)
    return Surface.of(vertices, np.concatenate([faces + i * len(u) for i in range(6)]))


def main() -> None:
    """Print one JSON line."""
    surface = bumpy_box(158)
    started = time.perf_counter()
    seen = sample(surface, POINTS, CONTEXT, 10**6, np.random.default_rng(0))
    sampling = time.perf_counter() - started
    assert len(np.unique(seen.cloud.faces)) == len(surface.faces)

    dense = bumpy_box(320)
    started = time.perf_counter()
    proxy = proxy_of(dense, MOST_FACES)
    lighter = time.perf_counter() - started
    started = time.perf_counter()
    centers = proxy.surface.vertices[proxy.surface.faces].mean(axis=1)
    labels = carried_back(proxy, (centers[:, 0] > 0).astype(np.int64), dense.faces)
    labels = with_gaps_filled(dense, labels, centers, (centers[:, 0] > 0).astype(np.int64))
    labels, _ = refined(dense, labels, Refinement.AUTO, 0.1)
    back = time.perf_counter() - started
    truth = dense.vertices[dense.faces].mean(axis=1)[:, 0] > 0
    result = {
        "benchmark": "particulate_mesh",
        "faces": len(surface.faces),
        "points": len(seen.cloud.points),
        "sampling_s": round(sampling, 2),
        "dense_faces": len(dense.faces),
        "shown_faces": len(proxy.surface.faces),
        "lighter_s": round(lighter, 2),
        "labels_back_s": round(back, 2),
        "labels_right": round(float((labels == truth).mean()), 4),
        "peak_gb": round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024**2, 2),
    }
    print(json.dumps(result))


if __name__ == "__main__":
    main()
