"""Meshes of Sweet Home 3D's libraries of furniture, as a folder for training.

``python -m asset_factory.learn.detector.sweethome3d /usr/share/sweethome3d/furniture OUT``: the
package ``sweethome3d-furniture`` of Debian installs them. OUT gets a GLB for every model that has
a label (:mod:`.labelled`), and ``INVENTORY.csv`` with authors and terms.
"""

from __future__ import annotations

import csv
import io
import re
import tempfile
import zipfile
from collections.abc import Collection
from pathlib import Path, PurePosixPath

import numpy as np
import tyro

from asset_factory.factory.runtime.terminal import say

from ..labelled import labelled_objects

#: Beginning of meshes' names, and terms, by library; the fifth one holds people only.
LIBRARIES = {
    "BlendSwap-CC-0.sh3f": ("blendswap0", "CC0-1.0"),
    "BlendSwap-CC-BY.sh3f": ("blendswapby", "CC-BY-3.0"),
    "KatorLegaz.sh3f": ("katorlegaz", "CC-BY-3.0"),
    "Scopia.sh3f": ("scopia", "CC-BY-3.0"),
}
CATALOGUE = "PluginFurnitureCatalog.properties"


def main(libraries: Path, out: Path, /) -> None:
    """Write the labelled models of a folder of libraries, and their inventory."""
    out.mkdir(parents=True, exist_ok=True)
    with (out / "INVENTORY.csv").open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(("file", "license", "author"))
        for library, (prefix, license) in LIBRARIES.items():
            with zipfile.ZipFile(libraries / library) as opened:
                for model in read_catalogue(opened.read(CATALOGUE).decode("latin-1")):
                    stem = re.sub("[^A-Za-z0-9_]", "_", PurePosixPath(model["model"]).stem)
                    if (name := f"{prefix}__{stem}") in labelled_objects():
                        (out / f"{name}.glb").write_bytes(_glb(opened, model))
                        table.writerow((f"{name}.glb", license, model["creator"]))
    say(f"{out}: written")


def read_catalogue(text: str) -> Collection[dict[str, str]]:
    """Return the models of a library by the text of its catalogue: ``key#number=value`` lines."""
    models: dict[str, dict[str, str]] = {}
    for key, number, value in re.findall(r"^(\w+)#(\d+)=(.*)$", text, re.MULTILINE):
        models.setdefault(number, {})[key] = value.strip()
    return models.values()


def _glb(library: zipfile.ZipFile, model: dict[str, str]) -> bytes:
    """Return a model of a library, upright, with its materials."""
    import trimesh

    place = PurePosixPath(model["model"].lstrip("/"))
    with tempfile.TemporaryDirectory() as folder:
        for each in map(PurePosixPath, library.namelist()):
            if each.parent == place.parent:
                (Path(folder) / each.name).write_bytes(library.read(str(each)))
        scene = trimesh.load_scene(Path(folder) / place.name, process=False)
        turn = np.eye(4)
        if "modelRotation" in model:
            turn[:3, :3] = np.array(model["modelRotation"].split(), float).reshape(3, 3)
        kept = io.BytesIO()
        scene.apply_transform(turn).export(kept, file_type="glb")
    return kept.getvalue()


if __name__ == "__main__":
    tyro.cli(main)
