"""The release's joints: rows ``(l, l x p)`` of a turn and of a slide, and their ranges."""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from asset_factory.factory.errors import InputRejected
from asset_factory.factory.intake.annotation import AnnotatedJoint
from asset_factory.factory.intake.importers.prediction import point_on_line
from asset_factory.factory.intake.limits import require_at_most

Arrays = dict[str, npt.NDArray[Any]]
FULL_TURN = 2.0 * np.pi - 1e-3
"""A range of so much is a turn without an end: the release writes those as -pi to pi [rad]."""


def bad_annotation(message: str) -> InputRejected:
    """Return the refusal of labels that contradict themselves or their mesh."""
    return InputRejected("bad_annotation", message)


def arrays_of(path: Path, max_bytes: int) -> Arrays:
    """Return the arrays of an ``.npz``, unpickled nothing.

    Raises:
        InputRejected: ``missing_file``, ``too_large``, or ``bad_annotation``: damaged, not finite.
    """
    if not path.is_file():
        raise InputRejected("missing_file", f"{path.name}: is not there")
    try:
        with zipfile.ZipFile(path) as archive:
            size = sum(entry.file_size for entry in archive.infolist())
            require_at_most(path.name, size, max_bytes, "bytes")
        with np.load(path, allow_pickle=False) as stored:
            arrays = {name: stored[name] for name in stored.files}
    except (OSError, ValueError, EOFError, KeyError, zipfile.BadZipFile) as error:
        raise bad_annotation(f"{path.name}: is no .npz of plain arrays: {error}") from error
    for name, values in arrays.items():
        if values.dtype.kind not in "biuf" or not np.isfinite(values.astype(np.float64)).all():
            raise bad_annotation(f"{path.name}: {name} holds what is no finite number")
    return arrays


def annotated_joint(
    parent: int, child: int, lines: npt.NDArray[Any], ranges: npt.NDArray[Any]
) -> AnnotatedJoint:
    """Return the joint of one bone.

    ``lines`` are ``(l, l x p)`` of the turn and of the slide, zero where there is none, shape [12];
    ``ranges`` of the turn [rad] and of the slide, from the pose that the object is in, shape [4].
    """
    if lines.shape != (12,) or ranges.shape != (4,):
        shapes = f"axes of shape {list(lines.shape)}, ranges {list(ranges.shape)}"
        raise bad_annotation(f"bone {child}: {shapes}; want 12, 4")
    turn, moment, slide = (np.asarray(lines[i : i + 3], dtype=np.float64) for i in (0, 3, 6))
    low, high, near, far = (float(value) for value in ranges.astype(np.float64))
    kind = ("fixed", "revolute", "prismatic", "both")[turn.any() + 2 * slide.any()]
    endless = high - low >= FULL_TURN
    ends = (near, far) if kind == "prismatic" else (None, None) if endless else (low, high)
    return AnnotatedJoint(
        name=f"joint_{child}",
        kind=kind,
        parent=parent,
        child=child,
        axis=slide if kind == "prismatic" else turn,
        origin=point_on_line(turn, moment) if turn.any() else np.zeros(3),
        lower=ends[0],
        upper=ends[1],
        slide_axis=slide if kind == "both" else None,
        slide_lower=near if kind == "both" else None,
        slide_upper=far if kind == "both" else None,
    )
