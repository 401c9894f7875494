"""Openings that people labelled on held-out artists' meshes: how many are predicted right.

    python benchmarks/openings.py OUT

Predicts what opens on each mesh of ``train_static`` that the detector did not learn from, as it is
and made one bumpy, coloured piece as image-to-3D tools give it (``OUT/skins``, GLB files). The
data's own ``score.py`` compares with the labels; ``results/held_out_openings.toml`` is written.
Left out are meshes that are drawn open, and those that open and have no label.
"""

from __future__ import annotations

import argparse
import csv
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
from asset_factory.learn.detector.real import is_held_out, real_objects
from asset_factory.learn.surfaces import coloured_skin

COLUMNS = ("", "joints right", "of", "spurious", "of those that stay shut something opens on")


def main() -> int:
    """Predict and score; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", type=Path, help="folder of skins and predictions")
    parser.add_argument("--data", type=Path, default=DATA, help="folder of train_static, generated")
    parser.add_argument("--workers", type=int, default=2)
    asked = parser.parse_args()
    source = asked.data / "train_static"
    labels = labels_of(source)
    names = [name for name in labels if ":" not in name]
    write_skins(source, names, asked.output / "skins")
    rows = []
    for what, meshes in (
        ("as artists made them", source),
        ("made one piece", asked.output / "skins"),
    ):
        predictions = asked.output / what.replace(" ", "_")
        predictions.mkdir(exist_ok=True)
        files = [meshes / f"{name}.glb" for name in names]
        with get_context("spawn").Pool(asked.workers) as pool:
            pool.map(partial(write_prediction, folder=predictions), files, chunksize=1)
        rows.append((what, *scored(asked.data, labels, predictions)))
    renew("held_out_openings", COLUMNS, rows)
    return 0


def labels_of(source: Path) -> dict[str, Any]:
    """Return the labels of held-out meshes; those that stay shut have none."""
    labels = json.loads((source / "openings.json").read_text())
    fronts = json.loads((source / "fronts.json").read_text())
    drawn_open = {name.split()[0] for name in fronts["open_as_given"]}
    taken = {}
    with (source / "INVENTORY.csv").open(newline="") as inventory:
        for row in csv.DictReader(inventory):
            name = Path(row["file"]).stem
            if not is_held_out(name) or name in drawn_open:
                continue
            if row["opens"] == "no" or (row["opens"] == "yes" and name in labels):
                taken |= {key: labels.get(key, []) for key in (name, f"{name}:optional")}
    return taken


def write_skins(source: Path, names: list[str], folder: Path) -> None:
    """Write each mesh as one bumpy, coloured piece."""
    import trimesh
    from PIL import Image

    folder.mkdir(parents=True, exist_ok=True)
    for seed, each in enumerate(real_objects(source, held_out=True)):
        if each.name not in names or (folder / f"{each.name}.glb").exists():
            continue
        skin = coloured_skin(each.mesh, seed)
        corners = skin.vertices[skin.faces].reshape(-1, 3)[:, [0, 2, 1]] * [1.0, 1.0, -1.0]
        picture = Image.open(io.BytesIO(skin.materials[0].texture.data))
        paint = trimesh.visual.material.PBRMaterial(baseColorTexture=picture)
        look = trimesh.visual.TextureVisuals(skin.corner_uv.reshape(-1, 2), material=paint)
        faces = np.arange(len(corners)).reshape(-1, 3)
        made = trimesh.Trimesh(corners, faces, visual=look, process=False)
        made.export(folder / f"{each.name}.glb")


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
