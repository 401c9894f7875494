"""The sides of a labelled object, with everything that opens on each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from asset_factory.factory.articulation import Articulation, Joint, JointKind
from asset_factory.factory.geometry.posing import face_parts, posed
from asset_factory.factory.mesh import BoolArray, FloatArray
from asset_factory.factory.models.detector.canvas import (
    CANVAS,
    LONGEST,
    SIDES,
    SORTS,
    WAYS,
    Canvases,
    PanelWay,
    Sort,
    look_at,
)
from asset_factory.factory.models.detector.decode import shared_areas
from asset_factory.factory.views.raster import Raster

from ..labelled import way_toward

#: A part that turns as a panel fills so much of its box; a lid covers so much of the top.
FILLED = 0.35
OVER = 0.35
#: Of a canvas: the least area of a panel, and the fewest pixels of a control.
LEAST_PANEL = 0.002
LEAST_CONTROL = 9
#: Pixels of a part at either end that its box leaves out, as a share: hinges that stick out.
STRAY = 0.01
#: Names of parts that are pressed or turned.
CONTROLS = frozenset(
    {
        "button", "dial", "dimmer", "key", "knob", "latch", "lever", "pedal", "release", "rocker",
        "switch", "tongue", "valve",
    }
)  # fmt: skip
#: A part that stands open by less than this share of its range counts as closed.
AJAR = 0.1
#: Columns of a table of moving parts, which has a row for each side that shows one: the number of
#: the side; left, lower, right, upper edge [pixels of the canvas]; the label on that side's canvas
#: of parts, 0 where the box alone says where; sort and way by number; how far it stands open as a
#: share of its range; whether nothing is learned there, 1 or 0.
VIEW = 0
BOX = slice(1, 5)
PART = 5
SORT = 6
WAY = 7
OPENED = 8
IGNORED = 9
COLUMNS = 10


@dataclass(frozen=True, eq=False)
class LabelledSides:
    """Five sides of one object, and the moving parts on each.

    Attributes:
        color, depth: as on :class:`Canvases`.
        part: number of each pixel's part plus one, 0 where nothing is seen, uint8, [5, 256, 256].
        table: of the moving parts, shape [n, ``COLUMNS``].
    """

    color: npt.NDArray[np.uint8]
    depth: npt.NDArray[np.int16]
    part: npt.NDArray[np.uint8]
    table: FloatArray


def knows_nothing_of(table: FloatArray, view: int, box: FloatArray) -> bool:
    """Tell whether half of a box on a side, shape [4], is where nothing is learned."""
    ignored = (table[:, IGNORED] > 0.0) & (table[:, VIEW] == view)
    shared = shared_areas(box, table[ignored, BOX])
    return bool((shared >= 0.5 * float(np.prod(box[2:] - box[:2]))).any())


@dataclass(frozen=True)
class WholeTruth:
    """The truth about one object: kind and front by number; ``real`` of an artist's surface."""

    kind: int
    opens: bool
    front: int
    real: bool


#: What opens so; whatever else turns about an upright edge is a door.
_PANELS = dict.fromkeys(PanelWay, Sort.DOOR) | {
    PanelWay.OUT: Sort.DRAWER, PanelWay.BOTTOM: Sort.FLAP, PanelWay.TOP: Sort.FLAP,
}  # fmt: skip


@dataclass(frozen=True)
class _Meaning:
    """What a joint's part is, and on which sides it counts."""

    sort: Sort
    ways: Mapping[int, PanelWay]


def labelled_sides(
    articulation: Articulation, opened: Mapping[str, float] | None = None
) -> LabelledSides:
    """Return the sides of a closed object, its front towards -Y.

    Joints are opened by the shares ``opened`` of their ranges before the object is looked at.
    """
    canvases, part = _pictures(articulation)
    meanings = _meanings(articulation, part)
    shares = dict(opened or {})
    if shares:
        opening = (joint for joint in articulation.joints if joint.name in shares)
        values = {joint.name: shares[joint.name] * joint.upper for joint in opening}
        articulation = posed(articulation, values)
        canvases, part = _pictures(articulation)
    rows = []
    for joint in articulation.movable_joints:
        meaning = meanings.get(joint.child, _Meaning(Sort.OTHER, {}))
        share = shares.get(joint.name, 0.0)
        for view in range(len(SIDES)):
            rows += _row(part[view] == joint.child + 1, view, joint.child, meaning, share)
    table = np.array(rows, dtype=np.float64).reshape(-1, COLUMNS)
    return LabelledSides(canvases.color, canvases.depth, part, table)


def _row(
    mask: BoolArray, view: int, part: int, meaning: _Meaning, share: float
) -> list[tuple[float, ...]]:
    """Return the row of one part on one side, if it is seen there."""
    if mask.sum() < LEAST_CONTROL:
        return []
    box = _box(mask)
    wide, high = box[2:] - box[:2]
    known = view in meaning.ways
    sort = meaning.sort
    way = meaning.ways.get(view, PanelWay.OTHER)
    if sort not in (Sort.CONTROL, Sort.OTHER):
        filled = float(mask.sum()) / max(wide * high, 1.0)
        large = float(mask.sum()) >= LEAST_PANEL * CANVAS**2
        if not large or (filled < FILLED and sort is not Sort.LID) or min(wide, high) < 4:
            known = False
    ignored = not known and sort is not Sort.OTHER
    opened = share if share > AJAR else 0.0
    return [(view, *box, part + 1, SORTS.index(sort), WAYS.index(way), opened, ignored)]


def _pictures(articulation: Articulation) -> tuple[Canvases, npt.NDArray[np.uint8]]:
    """Return how the sides look, and the parts of their pixels."""
    canvases = look_at(articulation.mesh)
    owner = np.append(np.minimum(face_parts(articulation) + 1, 255), 0)
    return canvases, owner[canvases.face].astype(np.uint8)


def _meanings(articulation: Articulation, part: npt.NDArray[np.uint8]) -> dict[int, _Meaning]:
    """Return what each moving part of a closed object is."""
    top_seen = int((part[-1] > 0).sum())
    found = {}
    for joint in articulation.movable_joints:
        counts = [int((part[view] == joint.child + 1).sum()) for view in range(len(SIDES))]
        if max(counts) == 0:
            continue
        name = articulation.parts[joint.child].name
        words = set(name.replace("-", "_").split("_"))
        if words & CONTROLS:
            found[joint.child] = _Meaning(Sort.CONTROL, {int(np.argmax(counts)): PanelWay.OTHER})
            continue
        level = joint.kind is JointKind.REVOLUTE and abs(float(joint.axis[2])) < 0.2
        covers = counts[-1] >= OVER * top_seen
        named = bool(words & {"lid", "cover"}) and int(np.argmax(counts)) == len(SIDES) - 1
        if level and (covers or named):
            faces = articulation.mesh.faces[articulation.parts[joint.child].faces]
            center = articulation.mesh.vertices[faces].mean(axis=(0, 1))
            across = joint.origin - center
            across = across - (across @ joint.axis) * joint.axis
            seen = (view for view in range(len(SIDES)) if counts[view])
            ways = {view: way_toward(across, SIDES[view]) for view in seen}
            found[joint.child] = _Meaning(Sort.LID, ways)
            continue
        view = int(np.argmax(counts[:4]))
        raster = Raster.around(articulation.mesh, SIDES[view], LONGEST)
        way = _way(part[view] == joint.child + 1, raster, joint)
        if counts[view] and way is not None:
            found[joint.child] = _Meaning(_PANELS[way], {view: way})
    return found


def _way(mask: BoolArray, raster: Raster, joint: Joint) -> PanelWay | None:
    """Return how a panel opens as seen on its side; ``None``: as none does."""
    right, up, away = raster.side.frame
    if joint.kind is JointKind.PRISMATIC:
        return PanelWay.OUT if float(joint.axis @ away) < -0.9 else None
    if joint.kind is not JointKind.REVOLUTE or not mask.any():
        return None
    left, bottom, end, top = _box(mask)
    row, column, _ = raster.pixels(joint.origin)
    column += (CANVAS - raster.columns) // 2
    row += (CANVAS - raster.rows) // 2
    across = (column - left) / max(end - left, 1.0)
    height = (row - bottom) / max(top - bottom, 1.0)
    if abs(float(joint.axis @ up)) > 0.9 and not 0.3 < across < 0.7:
        return PanelWay.LEFT if across < 0.5 else PanelWay.RIGHT
    if abs(float(joint.axis @ right)) > 0.9 and not 0.3 < height < 0.7:
        return PanelWay.BOTTOM if height < 0.5 else PanelWay.TOP
    return None


def _box(mask: BoolArray) -> FloatArray:
    """Return left, lower, right and upper edge of a mask without stray pixels."""
    ends = []
    for axis in (1, 0):
        share = np.cumsum(mask.sum(axis=1 - axis)) / mask.sum()
        low = int(np.searchsorted(share, STRAY))
        ends.append((low, int(np.searchsorted(share, 1.0 - STRAY)) + 1))
    (left, right), (bottom, top) = ends
    return np.array([left, bottom, right, top], dtype=np.float64)
