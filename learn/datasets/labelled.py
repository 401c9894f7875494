"""Real meshes whose openings people labelled by eye on every side, as the detector learns them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from asset_factory.factory.articulate.stated import StatedArticulator
from asset_factory.factory.articulation import Articulation
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.geometry.posing import turned
from asset_factory.factory.intake.load import load
from asset_factory.factory.intake.stated import Hinge, Stated, StatedKind, StatedPart
from asset_factory.factory.models.detector.canvas import Sort
from asset_factory.factory.views.raster import Side

from ..labelled import LabelledPart, files_of, is_held_out, labelled_objects
from .item import SourceItem
from .settings import SourceSettings

#: What a person would state of a part of each sort.
_STATED = {
    Sort.DOOR: StatedKind.DOOR,
    Sort.DRAWER: StatedKind.DRAWER,
    Sort.FLAP: StatedKind.FLAP,
    Sort.LID: StatedKind.LID,
    Sort.CONTROL: StatedKind.KNOB,
}
#: Quarter turns about the vertical that bring each side to the front.
_QUARTERS = {Side.FRONT: 0, Side.RIGHT: -1, Side.BACK: 2, Side.LEFT: 1}


def find_labelled(root: Path) -> tuple[SourceItem, ...]:
    """Return the labelled meshes of a folder with ``INVENTORY.csv`` that training may see.

    Files out of ``root`` do not exist.
    """
    labels = labelled_objects()
    listed = files_of(root) if (root / "INVENTORY.csv").is_file() else {}
    real = root.resolve()
    return tuple(
        SourceItem(name, path, (path,))
        for name, path in sorted(listed.items())
        if name in labels and labels[name].opens and not is_held_out(name)
        if path.resolve().is_relative_to(real)
    )


def read_labelled(item: SourceItem, settings: SourceSettings) -> Articulation:
    """Return a mesh with the parts that its label tells of, its front towards -Y.

    Geometry finds outlines, hinges and limits, as for what a user states.

    Raises:
        InputRejected: as intake and the articulator of stated parts; ``no_annotation``: nobody
            can tell how some part opens.
    """
    label = labelled_objects()[item.name]
    sure = [part for part in label.parts if not part.unsure]
    sorts = {part.sort for part in label.parts}
    if Sort.OTHER in sorts or sorts != {part.sort for part in sure}:
        said = "the label is unsure of how a part opens; want labels that are sure of every part"
        raise InputRejected("no_annotation", f"{item.name}: {said}")
    stated = Stated(parts=tuple(map(_stated, _seen_once(sure))))
    mesh = load(item.main, settings.intake).mesh
    found = StatedArticulator(stated).hypotheses(mesh)[0]
    return turned(found, _QUARTERS[label.front] * np.pi / 2.0)


def _seen_once(parts: Sequence[LabelledPart]) -> list[LabelledPart]:
    """Return every part but lids of which a better side tells, too: the front, or another side."""
    lids = [part.side for part in parts if part.sort is Sort.LID]
    best = min(lids, key=lambda side: (side is Side.TOP, side is not Side.FRONT), default=None)
    return [part for part in parts if part.sort is not Sort.LID or part.side is best]


def _stated(part: LabelledPart) -> StatedPart:
    """Return what a person would state of a part."""
    hinge = None if part.sort is Sort.CONTROL or part.hinge is None else Hinge(part.hinge)
    return StatedPart(kind=_STATED[part.sort], side=part.side, box=part.box, hinge=hinge)
