"""Which way is up: rotations that turn a named axis to +Z."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..errors import ConfigError
from ..mesh import FloatArray

# Rows give the new x, y and z; the same convention as the Particulate release's ``up_dir``.
_ROTATIONS: Mapping[str, tuple[tuple[int, ...], ...]] = {
    "x": ((0, 0, -1), (0, 1, 0), (1, 0, 0)),
    "-x": ((0, 0, 1), (0, 1, 0), (-1, 0, 0)),
    "y": ((1, 0, 0), (0, 0, -1), (0, 1, 0)),
    "-y": ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
    "z": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "-z": ((1, 0, 0), (0, -1, 0), (0, 0, -1)),
}
UP_AXES = tuple(_ROTATIONS)


def parse_up(text: str) -> str:
    """Return an up axis in the form ``y`` or ``-z``; ``+Y`` and ``Y`` are understood too.

    Raises:
        ConfigError: it is none of the six.
    """
    axis = text.strip().lower().removeprefix("+")
    if axis not in _ROTATIONS:
        raise ConfigError(f"up axis {text!r}: want one of {', '.join(UP_AXES)}")
    return axis


def rotation_to_z_up(axis: str) -> FloatArray:
    """Return the rotation that turns ``axis`` (as from :func:`parse_up`) to +Z, shape [3, 3]."""
    return np.array(_ROTATIONS[axis], dtype=np.float64)
