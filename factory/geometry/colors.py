"""Linear light and the numbers that screens and image files have for it (sRGB, IEC 61966-2-1)."""

import numpy as np
import numpy.typing as npt

from ..mesh import FloatArray


def srgb_of(linear: npt.ArrayLike) -> FloatArray:
    """Return the linear values in [0, 1] as they are shown."""
    light = np.asarray(linear, dtype=np.float64)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1.0 / 2.4) - 0.055)


def linear_of(srgb: npt.ArrayLike) -> FloatArray:
    """Return shown values in [0, 1] as linear light."""
    shown = np.asarray(srgb, dtype=np.float64)
    return np.where(shown <= 0.04045, shown / 12.92, ((shown + 0.055) / 1.055) ** 2.4)
