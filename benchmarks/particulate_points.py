"""A trained network's face labels from fewer points against those from the release's number.

    python benchmarks/particulate_points.py CHECKPOINT

One JSON line per number of points: processor seconds saved, the share of the surface that keeps its
part, and the share that has its true one. Weights must be trained, and want no features: labels of
an untrained network mean nothing.
"""

from __future__ import annotations

import json
import sys
import time

import numpy as np
from scipy.optimize import linear_sum_assignment

from asset_factory.factory.config import ParticulateConfig
from asset_factory.factory.geometry.posing import face_parts
from asset_factory.factory.geometry.triangles import face_areas
from asset_factory.factory.mesh import FloatArray, IntArray, Mesh
from asset_factory.factory.models.particulate.inference import infer
from asset_factory.factory.models.particulate.model import Model, Particulate, load_model
from asset_factory.learn.objects import make_object

CATEGORIES = (
    "cabinet",
    "fridge",
    "oven",
    "microwave",
    "dishwasher",
    "laptop",
    "chest",
    "trash_can",
)
RELEASED = 102_400
FEWER = (RELEASED, 16_384, 8_192, 4_096, 2_048)
SEED = 5001


def labels(mesh: Mesh, model: Model, points: int, seed: int) -> tuple[IntArray, float]:
    """Part of every face, and processor seconds."""
    config = ParticulateConfig(points=points, context_points=1, seed=seed)
    started = time.process_time()
    found = infer(mesh.vertices, mesh.faces, Particulate(model), config)
    return found.chosen.face_part, time.process_time() - started


def agreement(one: IntArray, other: IntArray, areas: FloatArray) -> float:
    """Largest share of the surface on which two labellings can be matched."""
    shared = np.zeros((one.max() + 1, other.max() + 1))
    np.add.at(shared, (one, other), areas)
    return float(shared[linear_sum_assignment(-shared)].sum() / areas.sum())


def main(checkpoint: str) -> None:
    """Measure on one unseen object of every category."""
    model = load_model(checkpoint)
    rows = []
    for category in CATEGORIES:
        articulation = make_object(category, SEED)
        mesh = articulation.mesh
        truth = face_parts(articulation)
        areas = face_areas(mesh)
        reference, seconds = labels(mesh, model, RELEASED, seed=0)
        # The same number again is another sample: what mere chance changes.
        again = [labels(mesh, model, points, seed=1) for points in FEWER]
        rows.append(
            [
                (seconds / s, agreement(found, reference, areas), agreement(found, truth, areas))
                for found, s in again
            ]
        )
    for points, (faster, same, true) in zip(FEWER, np.mean(rows, axis=0).tolist(), strict=True):
        line = {
            "benchmark": "particulate_points",
            "points": points,
            "times_faster": round(faster, 1),
        }
        print(json.dumps({**line, "same_label": round(same, 4), "true_label": round(true, 4)}))


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(sys.argv[1])
    else:
        print(
            json.dumps({"benchmark": "particulate_points", "skipped": "name a trained checkpoint"})
        )
