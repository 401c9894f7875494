"""Openings that people labelled on held-out artists' meshes: how many are predicted right.

    python benchmarks/openings.py OUT

Predicts what opens on each mesh of ``train_static`` that the detector did not learn from, as it is
and made one bumpy, coloured piece as image-to-3D tools give it (``OUT/one_piece``, GLB files). The
data's own ``score.py`` compares with the labels; ``results/held_out_openings.toml`` is written.
Left out are meshes that are drawn open, and those that open and have no label.
"""

from __future__ import annotations

import argparse
import io
import json
import subprocess
import sys
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from real_yield import DATA
from results_file import renew

from asset_factory.factory.articulate.predict import predict
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.mesh import Mesh
from asset_factory.learn.detector.real import real_objects
from asset_factory.learn.surfaces import coloured_skin

COLUMNS = ("", "joints right", "of", "spurious", "of those that stay shut something opens on")


def main() -> int:
    """Predict and score; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", type=Path, help="folder of meshes and predictions")
    parser.add_argument("--data", type=Path, default=DATA, help="folder of train_static, generated")
    parser.add_argument("--workers", type=int, default=2)
    asked = parser.parse_args()
    source = asked.data / "train_static"
    labels = write_inputs(source, asked.output / "one_piece")
    names = [name for name in labels if ":" not in name]
    rows = []
    for what, meshes in (
        ("as artists made them", source),
        ("made one piece", asked.output / "one_piece"),
    ):
        predictions = asked.output / what.replace(" ", "_")
        predictions.mkdir(exist_ok=True)
        files = [meshes / f"{name}.glb" for name in names]
        with get_context("spawn").Pool(asked.workers) as pool:
            pool.map(partial(write_prediction, folder=predictions), files, chunksize=1)
        rows.append((what, *scored(asked.data, labels, predictions)))
    renew("held_out_openings", COLUMNS, rows)
    return 0


def write_inputs(source: Path, folder: Path) -> dict[str, Any]:
    """Write held-out meshes as one piece; return labels by name, none of those that stay shut."""
    labels = json.loads((source / "openings.json").read_text())
    folder.mkdir(parents=True, exist_ok=True)
    taken: dict[str, Any] = {}
    for seed, each in enumerate(real_objects(source, held_out=True)):
        if each.label.opens and each.name not in labels:
            continue
        taken |= {key: labels.get(key, []) for key in (each.name, f"{each.name}:optional")}
        if not (written := folder / f"{each.name}.glb").exists():
            write_glb(coloured_skin(each.mesh, seed), written)
    return taken


def write_glb(mesh: Mesh, path: Path) -> None:
    """Write a mesh of one textured material."""
    import trimesh
    from PIL import Image

    corners = mesh.vertices[mesh.faces].reshape(-1, 3)[:, [0, 2, 1]] * [1.0, 1.0, -1.0]
    picture = Image.open(io.BytesIO(mesh.materials[0].texture.data))
    paint = trimesh.visual.material.PBRMaterial(baseColorTexture=picture)
    look = trimesh.visual.TextureVisuals(mesh.corner_uv.reshape(-1, 2), material=paint)
    faces = np.arange(len(corners)).reshape(-1, 3)
    trimesh.Trimesh(corners, faces, visual=look, process=False).export(path)


def write_prediction(file: Path, folder: Path) -> None:
    """Write what opens on a mesh; a rejected one is data, too."""
    written = folder / f"{file.stem}.json"
    if not written.exists():
        told = predict(file, BuildConfig())
        written.write_text(json.dumps(told) if "parts" in told else "")


def scored(data: Path, labels: dict[str, Any], predictions: Path) -> tuple[str, ...]:
    """Return joints right, joints expected, spurious ones, and on how many still meshes any."""
    expected = predictions.parent / "expected.json"
    expected.write_text(json.dumps(labels))
    score = [sys.executable, data / "generated" / "score.py", expected]
    said = subprocess.run(
        [*score, "--predictions", predictions], check=True, capture_output=True, text=True
    ).stdout
    print(said)
    *meshes, last = said.splitlines()
    total = json.loads(last)
    still = [line for line in meshes if " expected 0 " in line]
    open_ = sum(not line.endswith("spurious 0") for line in still)
    figures = (total["right"], total["expected"], total["spurious"], f"{open_} of {len(still)}")
    return tuple(map(str, figures))


if __name__ == "__main__":
    raise SystemExit(main())
