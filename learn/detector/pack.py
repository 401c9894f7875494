"""Objects as their sides show them and textures in one small file, carried to where training runs.

``python -m asset_factory.learn.detector.pack OUT --real train_static sweethome3d --described
train_infinigen --textures train_textures --one-piece 2``.
"""

from __future__ import annotations

import io
import json
import lzma
import zipfile
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from functools import partial
from itertools import chain
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import numpy.typing as npt
import tyro
from PIL import Image

from asset_factory.factory.geometry.posing import closed
from asset_factory.factory.models.detector.canvas import CANVAS, NOTHING, SIDES, look_at
from asset_factory.factory.runtime.terminal import say

from ..datasets.objects import described as described_objects
from ..labelled import is_held_out
from ..surfaces import coloured_skin
from .kinds import kind_number
from .real import RealObject, real_objects
from .sides import COLUMNS, IGNORED, VIEW, LabelledSides, WholeTruth, labelled_sides

#: Pixels along a texture.
TEXTURE = 128
#: Depths are kept in this many steps of the canvas's.
COARSE = 4


@dataclass(frozen=True, eq=False)
class Packed:
    """One object as learning takes it.

    Attributes:
        truth: about it as a whole.
        held_out: not trained on.
        one_piece: a mesh of pieces that was made one piece.
        sides: how it looks, and what opens.
    """

    truth: WholeTruth
    held_out: bool
    one_piece: bool
    sides: LabelledSides


def write_pack(
    out: Path,
    /,
    real: tuple[Path, ...],
    textures: Path,
    described: Path | None = None,
    one_piece: int = 0,
    workers: int = 2,
) -> None:
    """Write the file from folders of labelled meshes, of textures and of descriptions.

    Real objects that open are added so often as made ``one_piece``, others once at most.
    """
    descriptions = () if described is None else described_objects(described)
    with zipfile.ZipFile(out, "w") as pack, get_context("spawn").Pool(workers) as pool:
        forming = partial(_with_forms, count=one_piece)
        found_in = chain.from_iterable(map(real_objects, real))
        shown = pool.imap(forming, enumerate(found_in))
        for number, (found, forms) in enumerate(shown):
            label = found.label
            front = SIDES.index(label.front)
            truth = WholeTruth(kind_number(label.kind), label.opens, front, real=True)
            note = asdict(truth) | {"held_out": is_held_out(found.name)}
            _add(pack, f"real_{number:04d}_{found.name}", note, found.sides)
            for form, sides in enumerate(forms):
                name = f"one_piece{form}_{number:04d}_{found.name}"
                _add(pack, name, note | {"one_piece": True}, sides)
        for number, (name, articulation) in enumerate(descriptions):
            sides = labelled_sides(closed(articulation))
            known = sides.table[sides.table[:, IGNORED] == 0.0, VIEW].astype(np.int64)
            front = int(np.bincount(known, minlength=len(SIDES))[:4].argmax())
            truth = WholeTruth(kind_number(name.rpartition("_")[0]), True, front, real=False)
            note = asdict(truth) | {"held_out": False}
            _add(pack, f"made_{number:04d}_{name}", note, sides)
        for each in sorted(textures.glob("*.jpg")):
            picture = Image.open(each).convert("RGB").resize((TEXTURE, TEXTURE))
            pack.writestr(f"texture/{each.stem}.webp", _small(picture))
    say(f"{out}: written")


def _with_forms(
    numbered: tuple[int, RealObject], count: int
) -> tuple[RealObject, list[LabelledSides]]:
    """Return an object, and its sides as made one piece so many times.

    It is made so once if it is held out, or does not open.
    """
    number, found = numbered
    forms = count if found.label.opens and not is_held_out(found.name) else min(count, 1)
    skins = [coloured_skin(found.mesh, 1000 * number + form) for form in range(forms)]
    seen = map(look_at, skins)
    return found, [replace(found.sides, color=each.color, depth=each.depth) for each in seen]


def _add(pack: zipfile.ZipFile, name: str, note: dict[str, object], sides: LabelledSides) -> None:
    picture = Image.fromarray(sides.color.reshape(-1, CANVAS, 3))
    depth = np.where(sides.depth == NOTHING, NOTHING, sides.depth // COARSE)
    pack.writestr(f"{name}/color.webp", _small(picture))
    steps = np.diff(depth, prepend=0).astype(np.int16)
    pack.writestr(f"{name}/depth", lzma.compress(steps.tobytes()))
    pack.writestr(f"{name}/part", lzma.compress(sides.part.tobytes()))
    pack.writestr(f"{name}/table", sides.table.astype(np.float32).tobytes())
    pack.writestr(f"{name}/note.json", json.dumps(note))


def _small(picture: Image.Image) -> bytes:
    kept = io.BytesIO()
    picture.save(kept, "WEBP", quality=85)
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
            color = np.asarray(Image.open(io.BytesIO(pack.read(f"{folder}/color.webp"))))
            steps = np.frombuffer(lzma.decompress(pack.read(f"{folder}/depth")), np.int16)
            depth = np.cumsum(steps.reshape(shape), axis=2, dtype=np.int32)
            part = np.frombuffer(lzma.decompress(pack.read(f"{folder}/part")), np.uint8)
            table = np.frombuffer(pack.read(f"{folder}/table"), np.float32).astype(np.float64)
            depths = np.where(depth < 0, NOTHING, depth * COARSE).astype(np.int16)
            flags = note.pop("held_out"), note.pop("one_piece", False)
            pictures = color.reshape(*shape, 3), depths, part.reshape(shape)
            sides = LabelledSides(*pictures, table.reshape(-1, COLUMNS))
            yield Packed(WholeTruth(**note), *flags, sides)


def read_textures(path: Path) -> npt.NDArray[np.uint8]:
    """Return the textures of a file, [m, 3, size, size]."""
    with zipfile.ZipFile(path) as pack:
        names = [name for name in pack.namelist() if name.startswith("texture/")]
        found = [np.asarray(Image.open(io.BytesIO(pack.read(name)))) for name in names]
    return np.stack(found).transpose(0, 3, 1, 2)


if __name__ == "__main__":
    tyro.cli(write_pack)
