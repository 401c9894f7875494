"""Real objects and textures in one small file, to be carried to where training runs.

``python -m asset_factory.learn.detector.pack OUT --real train_static sweethome3d --described
train_infinigen --textures train_textures --one-piece 2``.
"""

from __future__ import annotations

import argparse
import io
import json
import lzma
import zipfile
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from itertools import chain
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from PIL import Image

from asset_factory.factory.geometry.posing import closed
from asset_factory.factory.models.detector.canvas import CANVAS, NOTHING, SIDES, look_at
from asset_factory.factory.runtime.terminal import say

from ..datasets.objects import described
from ..surfaces import coloured_skin
from .kinds import kind_number
from .packed import COARSE
from .real import RealObject, is_held_out, real_objects
from .sides import LabelledSides, labelled_sides

#: Pixels along a texture.
TEXTURE = 128


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path)
    parser.add_argument("--real", type=Path, nargs="+", required=True)
    parser.add_argument("--described", type=Path)
    parser.add_argument("--textures", type=Path, required=True)
    parser.add_argument("--one-piece", type=int, default=0, help="so many of each that opens")
    parser.add_argument("--workers", type=int, default=2)
    write_pack(parser.parse_args())


def write_pack(options: argparse.Namespace) -> None:
    """Write the file from folders of labelled meshes, of descriptions and of textures."""
    descriptions = described(options.described) if options.described else ()
    textures: Path = options.textures
    with (
        zipfile.ZipFile(options.out, "w") as pack,
        get_context("spawn").Pool(options.workers) as workers,
    ):
        forming = partial(_with_forms, count=options.one_piece)
        found_in = chain.from_iterable(map(real_objects, options.real))
        shown = workers.imap(forming, enumerate(found_in))
        for number, (found, forms) in enumerate(shown):
            note = {"kind": kind_number(found.kind), "opens": found.opens, "front": found.front}
            note |= {"held_out": is_held_out(found.name), "real": True}
            _add(pack, f"real_{number:04d}_{found.name}", note, found.sides)
            note |= {"one_piece": True}
            for form, sides in enumerate(forms):
                _add(pack, f"one_piece{form}_{number:04d}_{found.name}", note, sides)
        for number, (name, articulation) in enumerate(descriptions):
            sides = labelled_sides(closed(articulation))
            known = sides.instances.view[~sides.instances.ignored]
            counts = np.bincount(known, minlength=len(SIDES))
            note = {"kind": kind_number(name.rpartition("_")[0]), "opens": True}
            note |= {"front": int(counts[:4].argmax()), "held_out": False, "real": False}
            _add(pack, f"made_{number:04d}_{name}", note, sides)
        for each in sorted(textures.glob("*.jpg")):
            picture = Image.open(each).convert("RGB").resize((TEXTURE, TEXTURE))
            pack.writestr(f"texture/{each.stem}.jpg", _small(picture, "JPEG", 85))
    say(f"{options.out}: written")


def _with_forms(
    numbered: tuple[int, RealObject], count: int
) -> tuple[RealObject, list[LabelledSides]]:
    """Return an object, and its sides as made one piece so many times.

    It is made so once if it is held out, or does not open.
    """
    number, found = numbered
    often = found.opens and not is_held_out(found.name)
    forms = count if often else min(count, 1)
    skins = [coloured_skin(found.mesh, 1000 * number + form) for form in range(forms)]
    return found, [replace(found.sides, canvases=look_at(skin)) for skin in skins]


def _add(
    pack: zipfile.ZipFile, name: str, note: Mapping[str, object], sides: LabelledSides
) -> None:
    canvases = sides.canvases
    picture = Image.fromarray(canvases.color.reshape(-1, CANVAS, 3))
    depth = np.where(canvases.depth == NOTHING, NOTHING, canvases.depth // COARSE)
    pack.writestr(f"{name}/color.webp", _small(picture, "WEBP", 85))
    steps = np.diff(depth, prepend=0).astype(np.int16)
    pack.writestr(f"{name}/depth", lzma.compress(steps.tobytes()))
    pack.writestr(f"{name}/part", lzma.compress(sides.part.tobytes()))
    pack.writestr(f"{name}/table", sides.instances.table().tobytes())
    pack.writestr(f"{name}/note.json", json.dumps(note))


def _small(picture: Image.Image, encoding: str, quality: int) -> bytes:
    kept = io.BytesIO()
    picture.save(kept, encoding, quality=quality)
    return kept.getvalue()


if __name__ == "__main__":
    main()
