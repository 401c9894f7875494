"""Labels of real meshes as their sides show them: ``labels/*.json``, by the mesh's name."""

from __future__ import annotations

import csv
import zlib
from functools import cache
from pathlib import Path

import msgspec
import numpy as np

from asset_factory.factory.mesh import FloatArray
from asset_factory.factory.models.detector.canvas import WAYS, PanelWay, Sort
from asset_factory.factory.views.raster import Side

from .bounds import Share

LABELS = Path(__file__).with_name("labels")
#: The way of a part that may be hinged at either edge.
EITHER = -1
#: Of the meshes of a folder every so many is kept for measuring.
HELD_OUT = 5


class LabelledPart(msgspec.Struct, forbid_unknown_fields=True):
    """A part on one side; a part that several sides show has an entry for each.

    Attributes:
        side: that shows it.
        sort: what it is.
        box: left, lower, right, upper edge in shares of the side's picture.
        hinge: edge of a door or flap as its side shows it, side of the object of a lid; ``None``:
            it has none, or nobody can tell.
        unsure: that it opens so; nothing is learned there.
    """

    side: Side
    sort: Sort
    box: tuple[Share, Share, Share, Share]
    hinge: str | None = None
    unsure: bool = False

    @property
    def way(self) -> int:
        """Return the number of the way in which its side shows it open; ``EITHER``: two may be."""
        if self.sort is Sort.DRAWER:
            return WAYS.index(PanelWay.OUT)
        if self.sort is Sort.CONTROL:
            return WAYS.index(PanelWay.OTHER)
        if self.hinge is None:
            return EITHER
        if self.sort is Sort.LID:
            return WAYS.index(way_toward(-Side(self.hinge).frame[2], self.side))
        return WAYS.index(PanelWay(self.hinge))


class LabelledObject(msgspec.Struct, forbid_unknown_fields=True):
    """What a person sees of one mesh: its kind, whether anything opens, its front, its parts."""

    kind: str
    opens: bool
    front: Side = Side.FRONT
    parts: tuple[LabelledPart, ...] = ()


@cache
def labelled_objects() -> dict[str, LabelledObject]:
    """Return what people saw of the meshes that were labelled so, by name."""
    read = msgspec.json.Decoder(dict[str, LabelledObject]).decode
    files = sorted(LABELS.glob("*.json"))
    return {name: each for file in files for name, each in read(file.read_bytes()).items()}


def way_toward(direction: FloatArray, side: Side) -> PanelWay:
    """Return the edge, as a side shows it, at which a lid is hinged.

    ``direction`` is from the middle of the lid to its hinge, shape [3]; its height does not count.
    """
    right, up, away = side.frame
    level = direction * np.array([1.0, 1.0, 0.0])
    sideways = float(level @ right)
    depth = float(level @ (up if side is Side.TOP else away))
    if abs(sideways) > abs(depth):
        return PanelWay.RIGHT if sideways > 0.0 else PanelWay.LEFT
    return PanelWay.TOP if depth > 0.0 else PanelWay.BOTTOM


def is_held_out(name: str) -> bool:
    """Tell whether the mesh of a name is kept for measuring."""
    return zlib.crc32(name.encode()) % HELD_OUT == 0


def files_of(folder: Path) -> dict[str, Path]:
    """Return the meshes that the ``INVENTORY.csv`` of a folder lists, by name."""
    with (folder / "INVENTORY.csv").open(newline="") as rows:
        files = [folder / row["file"] for row in csv.DictReader(rows)]
    return {file.stem: file for file in files}
