"""Panels that may be there: what the detector sees, and what seams close around it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy.special import expit, softmax

from ...mesh import FloatArray
from ...models.detector.canvas import LONGEST, OPENING, SIDES, SORTS, on_canvas, shares_of
from ...models.detector.decode import Dense, Found, found_parts
from ...views.raster import Side
from ..seams.fronts import Front
from ..seams.rectangles import Rectangle
from ..stated.seen import SeenMesh
from ..stated.snapping import StatedFrame, snap
from .merging import PANELS
from .rating import box_cells, support_of_box

#: Boxes of the detector with a lower score are not looked at.
LEAST_SCORE = 0.1
#: Rectangles closed by seams that are looked at on one side, those that are closed best, and how
#: much cells must speak for one.
MOST_CLOSED = 120
LEAST_SUPPORT = 0.02


def panels_of(dense: Dense, seen: SeenMesh, *, closed: bool) -> Iterator[tuple[Found, FloatArray]]:
    """Yield doors, drawers and flaps that may be there, with what speaks for each.

    Args:
        dense: what the detector says.
        seen: the mesh that it looked at.
        closed: look at every rectangle that seams close, not only at the detector's own boxes.

    Yields:
        A panel, and its signs as ``PANEL_SIGNS`` names them.
    """
    own = found_parts(dense, LEAST_SCORE)
    for side, front in seen.around.items():
        frame = StatedFrame.of(seen.mesh, side)
        extents = frame.size / seen.mesh.extents.max() * LONGEST
        # Of two that are as probable the first counts: seams are exact.
        for rectangle in front.rectangles()[:MOST_CLOSED] if closed else ():
            corners = rectangle.corners(front.relief.raster)
            shares = ((corners - frame.low) / frame.size).ravel()
            panel = _panel_in(on_canvas(shares, extents), side, dense)
            if panel is not None:
                yield panel, _signs(panel.score, front, rectangle)
        for found in own:
            if found.side is side and found.sort in PANELS:
                left, low, right, high = shares_of(found.box, extents).tolist()
                meant = snap(front, frame, (left, low, right, high))
                yield found, _signs(support_of_box(found, dense), front, meant)


def _panel_in(box: FloatArray, side: Side, dense: Dense) -> Found | None:
    """Return the panel that cells see in a box, its support for score; ``None``: none, or a lid."""
    view = SIDES.index(side)
    cells = box_cells(box)
    if not cells.any():
        return None
    sorts = expit(dense.sort[view][:, cells]).mean(axis=1)
    ways = softmax(dense.way[view][:, cells], axis=0).mean(axis=1)
    sort = SORTS[int(sorts[:OPENING].argmax())]
    found = Found(side, box, sort, 0.0, ways)
    if sort not in PANELS or (support := support_of_box(found, dense)) < LEAST_SUPPORT:
        return None
    return replace(found, score=support)


def _signs(support: float, front: Front, rectangle: Rectangle) -> FloatArray:
    handle = bool(front.handles_in(rectangle))
    return np.array([support, np.sqrt(support), rectangle.relief.mean(), handle])
