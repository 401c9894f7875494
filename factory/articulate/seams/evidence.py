"""What speaks for a seam at every pixel: grooves, steps, creases, dark lines, other colours."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ...mesh import BoolArray, FloatArray
from .handles import Face
from .relief import Relief

#: A groove is at most so wide [pixels]; 3 mm on a metre is one.
GROOVE_WIDTH = 9
#: What each cue must show to say anything, and to be certain: pixels of height, share of facing,
#: CIE L*, CIE L*a*b* distance; and how much it can say alone, 0 to 1.
CUES = {
    "groove": (0.2, 1.0, 1.0),
    "step": (0.7, 2.0, 0.9),
    "crease": (0.1, 0.4, 0.7),
    "dark": (6.0, 16.0, 0.7),
    "color": (8.0, 20.0, 0.5),
}
#: And it must be so many times what this percentage of all pixels shows.
USUAL = 60.0
STANDS_OUT = 2.5


@dataclass(frozen=True)
class Seams:
    """Evidence for seams in one direction, 0 to 1, shape [rows, columns] each.

    Attributes:
        groove: a narrow dip of the height.
        relief: what the shape alone says: grooves, jumps of the height, and creases, where the
            surface faces the viewer less.
        all: what shape, narrow dark lines and other colours on either side say together.
        known: where a handle does not hide it.
    """

    groove: FloatArray
    relief: FloatArray
    all: FloatArray
    known: FloatArray


def seams_of(relief: Relief, face: Face, *, upright: bool) -> Seams:
    """Return the evidence for horizontal seams; for upright ones, with rows and columns exchanged.

    Args:
        relief: one side.
        face: it without handles.
        upright: which of the two.
    """
    axes = (1, 0) if upright else (0, 1)
    height = face.height.transpose(axes)
    facing = relief.facing.transpose(axes)
    seen = relief.seen.transpose(axes)
    lab = relief.lab.transpose(*axes, 2)
    values = {
        "groove": _dip(height),
        "step": _step(height),
        "crease": _dip(facing),
        "dark": _dip(lab[..., 0]),
        "color": _other_side(lab),
    }
    told = {name: _ramp(value, seen, *CUES[name]) for name, value in values.items()}
    shape = 1.0 - (1.0 - told["groove"]) * (1.0 - told["step"]) * (1.0 - told["crease"])
    everything = 1.0 - (1.0 - shape) * (1.0 - told["dark"]) * (1.0 - told["color"])
    known = np.where(face.covered.transpose(axes), 0.0, 1.0)
    return Seams(told["groove"], shape, everything, known)


def _dip(values: FloatArray) -> FloatArray:
    """Return how far a value lies below both sides of a narrow line."""
    return np.asarray(ndimage.grey_closing(values, size=(GROOVE_WIDTH, 1)) - values)


def _ramp(
    value: FloatArray, seen: BoolArray, nothing: float, certain: float, share: float
) -> FloatArray:
    """Return 0 for no evidence, ``share`` for certainty; a seam stands out of the rest.

    Seams are few, so that what most pixels show is the texture or the noise of the surface.
    """
    usual = float(np.percentile(value[seen], USUAL)) if seen.any() else 0.0
    louder = max(STANDS_OUT * usual / nothing, 1.0)
    told = np.clip((value - louder * nothing) / (louder * (certain - nothing)), 0.0, 1.0)
    return np.asarray(share * told)


def _shifted(values: FloatArray, by: int) -> FloatArray:
    """Return the values ``by`` rows further up; the border repeated."""
    rows = np.clip(np.arange(len(values)) + by, 0, len(values) - 1)
    return np.asarray(values[rows])


def _step(height: FloatArray) -> FloatArray:
    """Return how far the height jumps across each row, beyond the slopes on both sides [pixels]."""
    above = _shifted(height, 2)
    below = _shifted(height, -2)
    slopes = np.abs(_shifted(height, 5) - above) + np.abs(below - _shifted(height, -5))
    return np.abs(above - below) - 4.0 / 3.0 * slopes


def _other_side(lab: FloatArray) -> FloatArray:
    """Return the difference of the colours above and below each row, beyond their own changes."""
    mean = ndimage.uniform_filter1d(lab, 3, axis=0)
    above = _shifted(mean, 3)
    below = _shifted(mean, -3)
    jump = np.linalg.norm(above - below, axis=-1)
    own = np.linalg.norm(_shifted(mean, 6) - above, axis=-1)
    own += np.linalg.norm(_shifted(mean, -6) - below, axis=-1)
    return np.asarray(jump - own)
