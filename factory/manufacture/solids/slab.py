"""A panel's own solid: a slab behind its face, its protrusions apart, a lid hollowed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ...asset import Hull
from ...mesh import BoolArray, FloatArray
from ...views.view import View
from ..decompose.convex import hull_of, limit_vertices
from .panel import FlatPanel, smoothed, spread_out
from .pieces import MOST_CORNERS

#: What stands out of a panel's face further than this is a handle [m].
PROUD_M = 0.008
#: Up to this much of it still belongs to the face [m].
FLUSH_M = 0.004
#: Smaller blobs are noise [pixels].
LEAST_BLOB = 6
MOST_HANDLES = 6


@dataclass(frozen=True)
class FrontRelief:
    """A panel's face: depth of its plain part, and its protrusions.

    Attributes:
        view: that shows it.
        plain: depth without protrusions [m], [rows, columns]; NaN where the panel is not seen.
        blobs: numbers of the protrusions, 0 elsewhere, [rows, columns].
        count: of them.
    """

    view: View
    plain: FloatArray
    blobs: np.ndarray[tuple[int, ...], np.dtype[np.int32]]
    count: int

    def above(self, local: FloatArray) -> FloatArray:
        """Return how far points of the panel's frame, shape [n, 3], stand out of the face [m]."""
        plain = self.plain[self.view.raster.nearest(local)]
        return np.asarray(np.where(np.isfinite(plain), plain - local[:, 2], -np.inf))


def relief(view: View, panel: FlatPanel) -> FrontRelief:
    """Tell a panel's face from its protrusions."""
    seen: BoolArray = view.part == panel.part
    wide = ndimage.binary_dilation(seen, iterations=2)
    plain = np.where(wide, spread_out(smoothed(view, seen), seen), np.nan)
    proud = seen & (plain - view.away > PROUD_M)
    blobs, count = ndimage.label(proud, np.ones((3, 3)))
    sizes = np.bincount(blobs.ravel(), minlength=count + 1)
    sizes[0] = 0
    kept = np.argsort(-sizes, kind="stable")[:MOST_HANDLES]
    kept = kept[sizes[kept] >= LEAST_BLOB]
    number = np.zeros(count + 1, dtype=np.int32)
    number[kept] = np.arange(1, len(kept) + 1)
    grown = ndimage.grey_dilation(number[blobs], size=(3, 3))
    return FrontRelief(view, plain, grown, len(kept))


def handles(face: FrontRelief, local: FloatArray) -> tuple[Hull, ...]:
    """Return one hull for each thing that stands out of a panel's face, in its side's frame.

    Points of the panel's surface, shape [n, 3], are in that frame too [m].
    """
    above = face.above(local)
    blob = face.blobs[face.view.raster.nearest(local)]
    numbers = range(1, face.count + 1)
    found = (hull_of(local[(blob == number) & (above > -0.001)]) for number in numbers)
    return tuple(limit_vertices(hull, MOST_CORNERS) for hull in found if hull is not None)
