"""Real objects and textures in one small file, to be carried to where training runs.

``python -m asset_factory.learn.detector.pack OUT --real train_static --described train_infinigen
--textures train_textures``.
"""

from __future__ import annotations

import argparse
import io
import json
import lzma
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image

from asset_factory.factory.geometry.posing import closed
from asset_factory.factory.models.detector.canvas import CANVAS, NOTHING, SIDES
from asset_factory.factory.runtime.terminal import say

from ..datasets.objects import described
from .kinds import kind_number
from .real import is_held_out, real_objects
from .sides import LabelledSides, WholeTruth, labelled_sides

#: Depths of real objects are kept in this many steps of the canvas's.
COARSE = 4
#: Pixels along a texture.
TEXTURE = 128


@dataclass(frozen=True, eq=False)
class Packed:
    """One object as learning takes it.

    Attributes:
        truth: about it as a whole.
        held_out: not trained on.
        color, depth, part: see :class:`~asset_factory.learn.detector.looks.ObjectBatch`.
        table: of moving parts, [n, 10].
    """

    truth: WholeTruth
    held_out: bool
    color: npt.NDArray[np.uint8]
    depth: npt.NDArray[np.int16]
    part: npt.NDArray[np.uint8]
    table: npt.NDArray[np.float32]


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path)
    parser.add_argument("--real", type=Path, required=True)
    parser.add_argument("--described", type=Path)
    parser.add_argument("--textures", type=Path, required=True)
    options = parser.parse_args()
    write_pack(options.out, options.real, options.described, options.textures)


def write_pack(path: Path, real: Path, described_objects: Path | None, textures: Path) -> None:
    """Write the file from folders of labelled meshes, of descriptions and of textures."""
    descriptions = described(described_objects) if described_objects else ()
    with zipfile.ZipFile(path, "w") as pack:
        for number, found in enumerate(real_objects(real)):
            note = {"kind": kind_number(found.kind), "opens": found.opens, "front": found.front}
            note |= {"held_out": is_held_out(found.name), "real": True}
            _add(pack, f"real_{number:04d}_{found.name}", note, found.sides)
        for number, (name, articulation) in enumerate(descriptions):
            sides = labelled_sides(closed(articulation))
            counts = np.bincount(
                sides.instances.view[~sides.instances.ignored], minlength=len(SIDES)
            )
            note = {"kind": kind_number(name.rpartition("_")[0]), "opens": True}
            note |= {"front": int(counts[:4].argmax()), "held_out": False, "real": False}
            _add(pack, f"made_{number:04d}_{name}", note, sides)
        for each in sorted(textures.glob("*.jpg")):
            picture = Image.open(each).convert("RGB").resize((TEXTURE, TEXTURE))
            pack.writestr(f"texture/{each.stem}.jpg", _jpeg(picture, 85))
    say(f"{path}: written")


def _add(
    pack: zipfile.ZipFile, name: str, note: Mapping[str, object], sides: LabelledSides
) -> None:
    canvases = sides.canvases
    picture = Image.fromarray(canvases.color.reshape(-1, CANVAS, 3))
    depth = np.where(canvases.depth == NOTHING, NOTHING, canvases.depth // COARSE)
    pack.writestr(f"{name}/color.jpg", _jpeg(picture, 88))
    pack.writestr(
        f"{name}/depth", lzma.compress(np.diff(depth, prepend=0).astype(np.int16).tobytes())
    )
    pack.writestr(f"{name}/part", lzma.compress(sides.part.tobytes()))
    pack.writestr(f"{name}/table", sides.instances.table().tobytes())
    pack.writestr(f"{name}/note.json", json.dumps(note))


def _jpeg(picture: Image.Image, quality: int) -> bytes:
    kept = io.BytesIO()
    picture.save(kept, "JPEG", quality=quality)
    return kept.getvalue()


def read_pack(path: Path) -> Iterator[Packed]:
    """Yield the objects of a file."""
    shape = (len(SIDES), CANVAS, CANVAS)
    with zipfile.ZipFile(path) as pack:
        for name in pack.namelist():
            if not name.endswith("/note.json"):
                continue
            folder = name.rpartition("/")[0]
            note = json.loads(pack.read(name))
            color = np.asarray(Image.open(io.BytesIO(pack.read(f"{folder}/color.jpg"))))
            steps = np.frombuffer(lzma.decompress(pack.read(f"{folder}/depth")), np.int16)
            depth = np.cumsum(steps.reshape(shape), axis=2, dtype=np.int32)
            part = np.frombuffer(lzma.decompress(pack.read(f"{folder}/part")), np.uint8)
            table = np.frombuffer(pack.read(f"{folder}/table"), np.float32).reshape(-1, 10)
            held_out = note.pop("held_out")
            yield Packed(
                WholeTruth(**note),
                held_out,
                color.reshape(*shape, 3),
                np.where(depth < 0, NOTHING, depth * COARSE).astype(np.int16),
                part.reshape(shape),
                table,
            )


def read_textures(path: Path) -> npt.NDArray[np.uint8]:
    """Return the textures of a file, [m, 3, size, size]."""
    with zipfile.ZipFile(path) as pack:
        found = [
            np.asarray(Image.open(io.BytesIO(pack.read(name))))
            for name in pack.namelist()
            if name.startswith("texture/")
        ]
    return np.stack(found).transpose(0, 3, 1, 2)


if __name__ == "__main__":
    main()
