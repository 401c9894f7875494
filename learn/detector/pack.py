"""Real objects and textures in one small file, to be carried to where training runs.

``python -m asset_factory.learn.detector.pack OUT --real train_static sweethome3d --described
train_infinigen --textures train_textures --one-piece 2``.
"""

from __future__ import annotations

import io
import json
import lzma
import zipfile
from collections.abc import Mapping
from dataclasses import asdict, replace
from functools import partial
from itertools import chain
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import tyro
from PIL import Image

from asset_factory.factory.geometry.posing import closed
from asset_factory.factory.models.detector.canvas import CANVAS, NOTHING, SIDES, look_at
from asset_factory.factory.runtime.terminal import say

from ..datasets.objects import described as described_objects
from ..surfaces import coloured_skin
from .kinds import kind_number
from .packed import COARSE
from .real import RealObject, is_held_out, real_objects
from .sides import LabelledSides, WholeTruth, labelled_sides

#: Pixels along a texture.
TEXTURE = 128


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
    with (
        zipfile.ZipFile(out, "w") as pack,
        get_context("spawn").Pool(workers) as pool,
    ):
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
            known = sides.instances.view[~sides.instances.ignored]
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
    return found, [replace(found.sides, canvases=look_at(skin)) for skin in skins]


def _add(
    pack: zipfile.ZipFile, name: str, note: Mapping[str, object], sides: LabelledSides
) -> None:
    canvases = sides.canvases
    picture = Image.fromarray(canvases.color.reshape(-1, CANVAS, 3))
    depth = np.where(canvases.depth == NOTHING, NOTHING, canvases.depth // COARSE)
    pack.writestr(f"{name}/color.webp", _small(picture))
    steps = np.diff(depth, prepend=0).astype(np.int16)
    pack.writestr(f"{name}/depth", lzma.compress(steps.tobytes()))
    pack.writestr(f"{name}/part", lzma.compress(sides.part.tobytes()))
    pack.writestr(f"{name}/table", sides.instances.table().tobytes())
    pack.writestr(f"{name}/note.json", json.dumps(note))


def _small(picture: Image.Image) -> bytes:
    kept = io.BytesIO()
    picture.save(kept, "WEBP", quality=85)
    return kept.getvalue()


if __name__ == "__main__":
    tyro.cli(write_pack)
