"""How a front opens, judged by its handle, its shape and its neighbours."""

from __future__ import annotations

from ...mesh import FloatArray
from ...part import OpensBy
from .behind import FrontFace
from .scene import SIDEWAYS, UP, Scene

WIDE = 1.3
"""Width over height from which a front looks like a drawer's."""
OFF_CENTER = 0.15
"""A handle further than this share of the panel from its middle is at one side."""


def hinge_side(
    scene: Scene, front: FrontFace, fronts: list[FrontFace]
) -> tuple[OpensBy, tuple[str, ...]]:
    """Return how a front opens, and the assumptions."""
    panel = front.panel
    if front.has_box:
        return OpensBy.OUT, ()
    if panel.handle is None:
        low = panel.width >= 1.6 * panel.height and panel.height <= 0.35 * scene.size[UP]
        if low:
            return OpensBy.OUT, ("has no handle; assumed to be a drawer, since it is wide and low",)
        return _side_by_neighbours(front, fronts)
    offset = (panel.handle[:, SIDEWAYS].mean() - panel.center[SIDEWAYS]) / panel.width
    if abs(offset) > OFF_CENTER:
        return (OpensBy.LEFT if offset > 0.0 else OpensBy.RIGHT), ()
    return _by_centred_handle(scene, front, fronts, panel.handle)


def _by_centred_handle(
    scene: Scene, front: FrontFace, fronts: list[FrontFace], handle: FloatArray
) -> tuple[OpensBy, tuple[str, ...]]:
    """Return a handle in the middle of the width: an oven's door, a flap, a drawer, or no clue."""
    panel = front.panel
    aspect = panel.width / panel.height
    rise = (handle[:, UP].mean() - panel.center[UP]) / panel.height
    width, _, height = handle[1] - handle[0]
    narrowest = 0.55 if width >= max(3.0 * height, 0.4 * panel.width) else 0.65
    if panel.width >= 0.6 * scene.size[SIDEWAYS] and narrowest <= aspect <= 1.9:
        return OpensBy.BOTTOM, ()
    if aspect >= 1.2 and rise < -0.3:
        return OpensBy.TOP, ()
    if aspect >= WIDE:
        return OpensBy.OUT, (
            "has no box behind its front; assumed to be a drawer, "
            "since it is wide with a centred handle",
        )
    return _side_by_neighbours(front, fronts)


def _side_by_neighbours(
    front: FrontFace, fronts: list[FrontFace]
) -> tuple[OpensBy, tuple[str, ...]]:
    """Open doors of a row in pairs, away from each other; hinge a lone one at the left."""
    panel = front.panel
    row = [
        f
        for f in fronts
        if abs(f.panel.low[UP] - panel.low[UP]) + abs(f.panel.high[UP] - panel.high[UP])
        <= 0.1 * panel.height
        and not f.has_box
    ]
    row.sort(key=lambda f: float(f.panel.low[SIDEWAYS]))
    place = row.index(front)
    what = "has no handle" if panel.handle is None else "has its handle in the middle"
    if len(row) == 1:
        return OpensBy.LEFT, (f"{what}; hinge side assumed left",)
    side = OpensBy.LEFT if place % 2 == 0 else OpensBy.RIGHT
    return side, (f"{what}; hinge side assumed {side}, away from its neighbour",)
