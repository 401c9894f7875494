"""Single sides with their truth, as the picture network learns from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from asset_factory.factory.articulate.seams.sight import CUES, GRID, SQUARE, cues_of
from asset_factory.factory.articulation import Articulation
from asset_factory.factory.mesh import BoolArray, FloatArray, IntArray
from asset_factory.factory.part import OpensBy
from asset_factory.factory.views.raster import Side

from .pictures import Picture, pictures_of
from .truths import TruePanel, lids_of, truth_of

#: Labels of pixels: nothing, what stays, panels from ``FIRST_PANEL`` on, what belongs to a lid.
FIXED = 1
FIRST_PANEL = 2
LID = 255
#: How a panel opens that does so in no way the articulator knows.
UNKNOWN = len(OpensBy)
#: A mirrored panel is hinged on the other side.
MIRRORED = np.array([1, 0, 2, 3, 4, UNKNOWN])
#: Of objects so many are looked at from one more side than the front.
ANOTHER = 0.5
_AROUND = (Side.RIGHT, Side.BACK, Side.LEFT)
_SLOPE = CUES.index("slope_right")


@dataclass(frozen=True, eq=False)
class SideView:
    """One side of one object.

    Attributes:
        cues: what the network is given, shape [cue_count, rows, columns].
        wanted: by square of pixels whether it belongs to a panel, to a lid, and whether something
            that opens ends there, below or above, left or right; shape
            [4, rows / 2, columns / 2].
        way: how the panel of a square opens, by number, ``UNKNOWN`` elsewhere;
            shape [rows / 2, columns / 2].
    """

    cues: FloatArray
    wanted: BoolArray
    way: IntArray

    def mirrored(self) -> SideView:
        """Return the view with right and left exchanged."""
        cues = self.cues[:, :, ::-1].copy()
        cues[_SLOPE] *= -1.0
        return SideView(cues, self.wanted[:, :, ::-1], MIRRORED[self.way[:, ::-1]])


def views_of(articulation: Articulation, rng: np.random.Generator) -> tuple[SideView, ...]:
    """Return the front of an object, and sometimes another side, as a generated mesh shows them.

    Args:
        articulation: its front towards -Y.
        rng: of its looks.
    """
    sides = [Side.FRONT]
    if rng.random() < ANOTHER:
        sides.append(_AROUND[int(rng.integers(len(_AROUND)))])
    pictures = pictures_of(articulation, rng, (*sides, Side.TOP))
    truth = truth_of(articulation, pictures)
    lids = lids_of(articulation, pictures[Side.TOP])
    return tuple(
        _view(pictures[side], [each for each in truth if each.side is side], lids) for side in sides
    )


def write_views(path: Path, views: Sequence[SideView]) -> None:
    """Keep the views of one object."""
    kept: dict[str, Any] = {}
    for number, view in enumerate(views):
        kept[f"{number}.cues"] = view.cues.astype(np.float16)
        kept[f"{number}.wanted"] = view.wanted
        kept[f"{number}.way"] = view.way.astype(np.uint8)
    np.savez_compressed(path, **kept)


def read_views(path: Path) -> tuple[SideView, ...]:
    """Return the kept views of one object."""
    with np.load(path, allow_pickle=False) as kept:
        return tuple(
            SideView(
                kept[f"{number}.cues"].astype(np.float32),
                kept[f"{number}.wanted"],
                kept[f"{number}.way"].astype(np.int64),
            )
            for number in range(len(kept.files) // 3)
        )


def _view(picture: Picture, panels: Sequence[TruePanel], lids: Sequence[int]) -> SideView:
    label = np.where(picture.part >= 0, FIXED, 0)
    way = np.full(LID + 1, UNKNOWN)
    for number, panel in enumerate(panels, start=FIRST_PANEL):
        bottom, left = panel.rectangle.low
        top, right = panel.rectangle.high
        label[bottom:top, left:right] = number
        if panel.way is not None:
            way[number] = list(OpensBy).index(panel.way)
    label[np.isin(picture.part, lids)] = LID
    label = np.pad(label, [(0, -length % GRID) for length in label.shape])
    return SideView(cues_of(picture.relief), _wanted(label), way[label][::SQUARE, ::SQUARE])


def _wanted(label: IntArray) -> BoolArray:
    moves = label >= FIRST_PANEL
    level = np.zeros(label.shape, np.bool_)
    upright = np.zeros(label.shape, np.bool_)
    ends = (label[1:] != label[:-1]) & (moves[1:] | moves[:-1])
    level[1:] |= ends
    level[:-1] |= ends
    ends = (label[:, 1:] != label[:, :-1]) & (moves[:, 1:] | moves[:, :-1])
    upright[:, 1:] |= ends
    upright[:, :-1] |= ends
    return np.stack(
        [_squares(each) for each in (moves & (label != LID), label == LID, level, upright)]
    )


def _squares(values: BoolArray) -> BoolArray:
    """Return whether any pixel of each square is meant."""
    rows, columns = (length // SQUARE for length in values.shape)
    return np.asarray(values.reshape(rows, SQUARE, columns, SQUARE).any(axis=(1, 3)))
