"""Meshes of Sweet Home 3D's libraries of furniture, as a folder for training.

``python -m asset_factory.learn.detector.sweethome3d /usr/share/sweethome3d/furniture OUT``: the
package ``sweethome3d-furniture`` of Debian installs them. OUT gets a GLB for every model that has
a label (:mod:`.labelled`), and ``INVENTORY.csv`` with authors and terms.
"""

from __future__ import annotations

import argparse
import csv
import io
import re
import tempfile
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import numpy as np

from asset_factory.factory.runtime.terminal import say

from .labelled import labelled_objects

#: Libraries by file, the beginning of their meshes' names, and their terms; the fifth one holds
#: people only.
LIBRARIES = {
    "BlendSwap-CC-0.sh3f": ("blendswap0", "CC0-1.0"),
    "BlendSwap-CC-BY.sh3f": ("blendswapby", "CC-BY-3.0"),
    "KatorLegaz.sh3f": ("katorlegaz", "CC-BY-3.0"),
    "Scopia.sh3f": ("scopia", "CC-BY-3.0"),
}
CATALOGUE = "PluginFurnitureCatalog.properties"


@dataclass(frozen=True)
class Furniture:
    """One of a library: its OBJ's place in the file, its author, its turn to stand upright."""

    path: PurePosixPath
    author: str
    turn: str | None


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("libraries", type=Path)
    parser.add_argument("out", type=Path)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    labels = labelled_objects()
    with (options.out / "INVENTORY.csv").open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(("file", "kind", "opens", "license", "author"))
        for library, (prefix, license) in LIBRARIES.items():
            with zipfile.ZipFile(options.libraries / library) as opened:
                for model in read_catalogue(opened.read(CATALOGUE).decode("latin-1")):
                    name = f"{prefix}__{re.sub('[^A-Za-z0-9_]', '_', model.path.stem)}"
                    label = labels.get(name)
                    if label is not None:
                        (options.out / f"{name}.glb").write_bytes(_glb(opened, model))
                        opens = "yes" if label.opens else "no"
                        row = (f"{name}.glb", label.kind, opens, license, model.author)
                        table.writerow(row)
    say(f"{options.out}: written")


def read_catalogue(text: str) -> Iterator[Furniture]:
    """Yield the models of a library by the text of its catalogue: ``key#number=value`` lines."""
    entries: dict[str, dict[str, str]] = {}
    for key, number, value in re.findall(r"^(\w+)#(\d+)=(.*)$", text, re.MULTILINE):
        entries.setdefault(number, {})[key] = value.strip()
    for each in entries.values():
        path = PurePosixPath(each["model"].lstrip("/"))
        yield Furniture(path, each.get("creator", ""), each.get("modelRotation"))


def _glb(library: zipfile.ZipFile, model: Furniture) -> bytes:
    """Return a model of a library with its materials."""
    import trimesh

    with tempfile.TemporaryDirectory() as folder:
        beside = [n for n in library.namelist() if PurePosixPath(n).parent == model.path.parent]
        for each in beside:
            (Path(folder) / PurePosixPath(each).name).write_bytes(library.read(each))
        path = Path(folder) / model.path.name
        scene = trimesh.load_scene(path, process=False)
        turn = np.eye(4)
        if model.turn:
            turn[:3, :3] = np.array(model.turn.split(), dtype=np.float64).reshape(3, 3)
        scene.apply_transform(turn)
        kept = io.BytesIO()
        scene.export(kept, file_type="glb")
    return kept.getvalue()


if __name__ == "__main__":
    main()
