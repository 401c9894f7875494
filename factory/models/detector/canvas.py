"""What the detector looks at: five sides of an object, on square canvases of one scale."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import numpy.typing as npt

from ...mesh import FloatArray, IntArray, Mesh
from ...views.raster import Side
from ...views.view import elevation

#: The sides in the order in which a turn to the left by a quarter brings the next to the front.
AROUND = (Side.FRONT, Side.RIGHT, Side.BACK, Side.LEFT)
SIDES = (*AROUND, Side.TOP)
#: Pixels along a canvas, and along the longest extent of the object on it.
CANVAS = 256
LONGEST = 240
#: Pixels along a cell, of which the network says what it shows.
STRIDE = 4
#: Depths are kept in this share of a pixel; ``NOTHING`` where nothing is seen.
DEPTH_STEPS = 32
NOTHING = -1
KINDS = (
    "cabinet", "drawer_unit", "wardrobe", "fridge", "oven", "microwave", "dishwasher", "washer",
    "chest", "case", "bin", "door", "window", "desk", "table", "shelf", "bed", "chair", "sofa",
    "toilet", "mailbox", "safe", "lockers", "printer", "laptop", "screen", "lamp", "plant",
    "kitchen", "box", "crate", "barrel", "still", "gadget",
)  # fmt: skip


class Sort(StrEnum):
    """What the detector calls a part."""

    DOOR = "door"
    DRAWER = "drawer"
    FLAP = "flap"
    LID = "lid"
    CONTROL = "control"
    OTHER = "other"


class PanelWay(StrEnum):
    """How a part opens, as seen on its side; of a lid, ``top`` is away from the viewer."""

    LEFT = "left"
    RIGHT = "right"
    BOTTOM = "bottom"
    TOP = "top"
    OUT = "out"
    OTHER = "other"


SORTS = tuple(Sort)
#: So many of them, the first ones, open something: doors, drawers, flaps, lids.
OPENING = 4
WAYS = tuple(PanelWay)


@dataclass(frozen=True, eq=False)
class Canvases:
    """Five sides of one object; row 0 is the lowest.

    Attributes:
        color: as shown (sRGB), uint8, shape [5, 256, 256, 3].
        depth: behind the nearest point of the side, in 1/32 of a pixel, int16, shape
            [5, 256, 256]; -1 where nothing is seen.
        face: the nearest triangle, -1 for none, shape [5, 256, 256].
    """

    color: npt.NDArray[np.uint8]
    depth: npt.NDArray[np.int16]
    face: IntArray

    @property
    def cells(self) -> IntArray:
        """Return the nearest triangle at the middle of every cell of 4 pixels, [5, 64, 64]."""
        return self.face[:, STRIDE // 2 :: STRIDE, STRIDE // 2 :: STRIDE]


def look_at(mesh: Mesh) -> Canvases:
    """Return the five sides of a mesh, z up, centred on their canvases."""
    color = np.zeros((len(SIDES), CANVAS, CANVAS, 3), np.uint8)
    depth = np.full((len(SIDES), CANVAS, CANVAS), NOTHING, np.int16)
    face = np.full((len(SIDES), CANVAS, CANVAS), -1, np.int64)
    for number, side in enumerate(SIDES):
        picture = elevation(mesh, side, LONGEST)
        first = [(CANVAS - length) // 2 for length in picture.face.shape]
        middle = tuple(np.s_[a : a + n] for a, n in zip(first, picture.face.shape, strict=True))
        steps = np.where(picture.seen, picture.depth, 0.0) / picture.raster.pixel * DEPTH_STEPS
        whole = np.clip(np.rint(steps), 0, np.iinfo(np.int16).max)
        color[number][middle] = np.rint(255.0 * picture.color)
        depth[number][middle] = np.where(picture.seen, whole, NOTHING)
        face[number][middle] = picture.face
    return Canvases(color, depth, face)


def shares_of(box: FloatArray, extents: FloatArray) -> FloatArray:
    """Return a canvas's box in shares of the side's picture.

    Args:
        box: left, lower, right, upper edge [pixels of the canvas], shape [4].
        extents: width and height of the side [pixels], shape [2].
    """
    low = (CANVAS - extents) / 2.0
    return np.asarray((box.reshape(2, 2) - low) / extents).ravel()


def on_canvas(shares: FloatArray, extents: FloatArray) -> FloatArray:
    """Return the canvas's box [pixels] that shares of a side's picture mean.

    Args:
        shares: left, lower, right, upper edge, shape [4].
        extents: width and height of the side [pixels], shape [2].
    """
    return np.asarray((shares.reshape(2, 2) * extents + (CANVAS - extents) / 2.0).ravel())
