"""What one file for training holds: objects as they look from all sides, and textures."""

from __future__ import annotations

import io
import json
import lzma
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image

from asset_factory.factory.models.detector.canvas import CANVAS, NOTHING, SIDES

from .sides import WholeTruth

#: Depths of real objects are kept in this many steps of the canvas's.
COARSE = 4


@dataclass(frozen=True, eq=False)
class Packed:
    """One object as learning takes it.

    Attributes:
        truth: about it as a whole.
        held_out: not trained on.
        one_piece: a mesh of pieces that was made one piece.
        color, depth, part: see :class:`~asset_factory.learn.detector.looks.ObjectBatch`.
        table: of moving parts, [n, 10].
    """

    truth: WholeTruth
    held_out: bool
    one_piece: bool
    color: npt.NDArray[np.uint8]
    depth: npt.NDArray[np.int16]
    part: npt.NDArray[np.uint8]
    table: npt.NDArray[np.float32]


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
            table = np.frombuffer(pack.read(f"{folder}/table"), np.float32).reshape(-1, 10)
            depths = np.where(depth < 0, NOTHING, depth * COARSE).astype(np.int16)
            flags = note.pop("held_out"), note.pop("one_piece", False)
            part = part.reshape(shape)
            color = color.reshape(*shape, 3)
            yield Packed(WholeTruth(**note), *flags, color, depths, part, table)


def read_textures(path: Path) -> npt.NDArray[np.uint8]:
    """Return the textures of a file, [m, 3, size, size]."""
    with zipfile.ZipFile(path) as pack:
        names = [name for name in pack.namelist() if name.startswith("texture/")]
        found = [np.asarray(Image.open(io.BytesIO(pack.read(name)))) for name in names]
    return np.stack(found).transpose(0, 3, 1, 2)
