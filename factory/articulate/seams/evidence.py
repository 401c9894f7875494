"""What speaks for a seam at every pixel: grooves, steps, creases, dark lines, other colours."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ...mesh import BoolArray, FloatArray, IntArray
from .handles import Face
from .relief import Relief

#: A groove is at most so wide [pixels]; 3 mm on a metre is one.
GROOVE_WIDTH = 9
#: What each cue must show to say anything, and to be certain: pixels of height, share of facing,
#: CIE L*, CIE L*a*b* distance.
RANGES = {
    "groove": (0.2, 1.0),
    "step": (0.7, 2.0),
    "crease": (0.1, 0.4),
    "dark": (6.0, 16.0),
    "color": (8.0, 20.0),
}
#: And it must be so many times what this percentage of all pixels shows.
USUAL = 60.0
STANDS_OUT = 2.5
#: How much each cue can say alone, 0 to 1.
SHARES = {"groove": 1.0, "step": 0.9, "crease": 0.7, "dark": 0.7, "color": 0.5, "border": 0.9}


@dataclass(frozen=True)
class Seams:
    """Evidence for seams in one direction, 0 to 1, shape [rows, columns] each.

    Attributes:
        groove: a narrow dip of the height.
        step: a jump of the height.
        crease: a narrow dip of how much the surface faces the viewer.
        dark: a narrow dark line.
        color: other colours on either side.
        border: other pieces of the mesh on either side.
        known: where a handle does not hide it.
    """

    groove: FloatArray
    step: FloatArray
    crease: FloatArray
    dark: FloatArray
    color: FloatArray
    border: FloatArray
    known: FloatArray

    @property
    def relief(self) -> FloatArray:
        """Return what the shape alone says."""
        return 1.0 - (1.0 - self.groove) * (1.0 - SHARES["step"] * self.step) * (
            1.0 - SHARES["crease"] * self.crease
        ) * (1.0 - SHARES["border"] * self.border)

    @property
    def all(self) -> FloatArray:
        """Return all of it together."""
        return 1.0 - (1.0 - self.relief) * (1.0 - SHARES["dark"] * self.dark) * (
            1.0 - SHARES["color"] * self.color
        )


def level_seams(relief: Relief, face: Face) -> Seams:
    """Return the evidence for horizontal seams."""
    return _seams(face.height, relief.facing, relief.lab, relief.piece, face.covered, relief.seen)


def upright_seams(relief: Relief, face: Face) -> Seams:
    """Return the evidence for vertical seams, rows and columns exchanged."""
    return _seams(
        face.height.T,
        relief.facing.T,
        relief.lab.transpose(1, 0, 2),
        relief.piece.T,
        face.covered.T,
        relief.seen.T,
    )


def _seams(
    height: FloatArray,
    facing: FloatArray,
    lab: FloatArray,
    piece: IntArray,
    covered: BoolArray,
    seen: BoolArray,
) -> Seams:
    light = lab[..., 0]
    values = {
        "groove": _dip(height),
        "step": _step(height),
        "crease": _dip(facing),
        "dark": _dip(light),
        "color": _other_side(lab),
    }
    rated = {name: _ramp(value, seen, *RANGES[name]) for name, value in values.items()}
    numbers = piece.astype(np.float64)
    border = (_shifted(numbers, 1) != _shifted(numbers, -1)).astype(np.float64)
    return Seams(**rated, border=border, known=np.where(covered, 0.0, 1.0))


def _dip(values: FloatArray) -> FloatArray:
    """Return how far a value lies below both sides of a narrow line."""
    return np.asarray(ndimage.grey_closing(values, size=(GROOVE_WIDTH, 1)) - values)


def _ramp(value: FloatArray, seen: BoolArray, nothing: float, certain: float) -> FloatArray:
    """Return 0 for no evidence, 1 for certainty; a seam stands out of the rest.

    Seams are few, so that what most pixels show is the texture or the noise of the surface.
    """
    usual = float(np.percentile(value[seen], USUAL)) if seen.any() else 0.0
    louder = max(STANDS_OUT * usual / nothing, 1.0)
    return np.clip((value - louder * nothing) / (louder * (certain - nothing)), 0.0, 1.0)


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
