"""The published model's ``pred.npz``: face labels and joints, in the frame of the mesh beside it.

Fields: ``face_part_ids`` [face_count], ``motion_hierarchy`` [joint_count, 2] of (parent, child),
``is_part_revolute`` and ``is_part_prismatic`` [part_count], ``revolute_plucker`` [part_count, 6] as
``(l, l x p)``, the negative of the textbook's moment, ``revolute_range`` [part_count, 2] [rad],
``prismatic_axis`` [part_count, 3] and ``prismatic_range`` [part_count, 2] [mesh units].
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Collection
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ...errors import InputRejected
from ...mesh import FloatArray
from ..annotation import AnnotatedJoint, Annotation

Fields = dict[str, npt.NDArray[np.generic]]
#: Field name -> number of columns; 0 for a plain list.
PER_PART = {
    "is_part_revolute": 0,
    "is_part_prismatic": 0,
    "revolute_plucker": 6,
    "revolute_range": 2,
    "prismatic_axis": 3,
    "prismatic_range": 2,
}
#: What neither turns nor slides, what turns, what slides, and what does both.
KINDS = ("fixed", "revolute", "prismatic", "both")
MAX_BYTES = 256 * 1024 * 1024
#: Largest number of parts a file may speak of; the published model knows 16.
MAX_PARTS = 4096
#: Larger numbers are no direction, angle or length in any unit.
MOST = 1e9


def read_prediction(path: Path, face_count: int, data: bytes | None = None) -> Annotation:
    """Return the annotation in a ``pred.npz``.

    Args:
        path: the file; nothing in it is unpickled.
        face_count: the mesh it speaks of has at least that many faces, in the mesh file's own
            order; further labels are of faces that were dropped.
        data: what the file held when it was read; ``None``: it is read now.

    Raises:
        InputRejected: ``missing_file``, or ``bad_annotation``: which field, what it is, what it
            should be.
    """
    names = ("face_part_ids", "motion_hierarchy", *PER_PART)
    return annotation_in(load_fields(path, MAX_BYTES, names, data), face_count, path.name)


def annotation_in(fields: Fields, face_count: int, file: str) -> Annotation:
    """Return the annotation that fields hold; arguments and errors as of :func:`read_prediction`.

    ``file`` is what messages call the fields.
    """
    labels = fields["face_part_ids"]
    if labels.ndim != 1 or labels.dtype.kind not in "iu" or len(labels) < face_count:
        said = f"face_part_ids has shape {list(labels.shape)} of {labels.dtype}"
        raise _bad(file, f"{said}, want one integer for each of the mesh's {face_count} faces")
    part_count = len(fields["is_part_revolute"]) if fields["is_part_revolute"].ndim else 0
    if not 0 < part_count <= MAX_PARTS:
        raise _bad(file, f"is_part_revolute speaks of {part_count} parts, want 1 to {MAX_PARTS}")
    for name, columns in PER_PART.items():
        shape = (part_count, columns) if columns else (part_count,)
        values = fields[name]
        if values.shape != shape or values.dtype.kind not in "biuf":
            said = f"{name} has shape {list(values.shape)} of {values.dtype}"
            raise _bad(file, f"{said}, want numbers of shape {list(shape)}")
        # NaN compares as false.
        if not (np.abs(values.astype(np.float64)) <= MOST).all():
            raise _bad(file, f"{name} holds a number that is not finite, or beyond {MOST:g}")
    if len(labels) and not -1 <= labels.min() <= labels.max() < part_count:
        said = f"face_part_ids run from {labels.min()} to {labels.max()}"
        raise _bad(file, f"{said}, want -1 to {part_count - 1}")
    return Annotation(
        face_part=labels.astype(np.int64),
        part_names=tuple(f"part_{index}" for index in range(part_count)),
        joints=tuple(_joint(fields, *edge) for edge in _edges(fields, part_count, file)),
        source="pred.npz",
    )


def point_on_line(direction: FloatArray, moment: FloatArray) -> FloatArray:
    """Return the point nearest the origin of a line ``(l, m = l x p)``, shape [3]."""
    squared = float(direction @ direction)
    return np.cross(moment, direction) / squared if squared > 0.0 else np.zeros(3)


def load_fields(
    path: Path, max_bytes: int, names: Collection[str] = (), data: bytes | None = None
) -> Fields:
    """Return the named arrays of an ``.npz``, all of them by default; nothing is unpickled.

    Raises:
        InputRejected: ``missing_file``, or ``bad_annotation``: what the file is instead.
    """
    if data is None and not path.is_file():
        raise InputRejected("missing_file", f"{path.name}: is not there")
    try:
        with zipfile.ZipFile(path if data is None else io.BytesIO(data)) as archive:
            unpacked = sum(entry.file_size for entry in archive.infolist())
        if unpacked > max_bytes:
            raise _bad(path.name, f"unpacks to {unpacked} bytes, want at most {max_bytes}")
        with np.load(path if data is None else io.BytesIO(data), allow_pickle=False) as archive:
            # What is no array is handed out as it lies there: an array of bytes is no number.
            return {name: np.asarray(archive[name]) for name in names or archive.files}
    except InputRejected:
        raise
    except KeyError as error:
        raise _bad(path.name, f"a field is missing: {error.args[0]}") from error
    except MemoryError as error:
        raise _bad(path.name, "does not fit into memory") from error
    except Exception as error:
        # A file from anybody: zip, zlib, tokenizer and array headers all have errors of their own.
        said = " ".join(f"{type(error).__name__}: {error}".split())[:240]
        raise _bad(path.name, f"is no .npz of plain arrays: {said}") from error


def _bad(file: str, what: str) -> InputRejected:
    return InputRejected("bad_annotation", f"{file}: {what}")


def _edges(fields: Fields, part_count: int, file: str) -> list[tuple[int, int]]:
    edges = fields["motion_hierarchy"]
    if edges.size == 0:
        return []
    if edges.ndim != 2 or edges.shape[1] != 2 or edges.dtype.kind not in "iu":
        said = f"motion_hierarchy has shape {list(edges.shape)} of {edges.dtype}"
        raise _bad(file, f"{said}, want integer rows of 2")
    if len(edges) > MAX_PARTS:
        raise _bad(file, f"motion_hierarchy has {len(edges)} rows, want at most {MAX_PARTS}")
    if not 0 <= edges.min() <= edges.max() < part_count:
        said = f"motion_hierarchy speaks of part {edges.max()}"
        raise _bad(file, f"{said}, want 0 to {part_count - 1}")
    return [(int(parent), int(child)) for parent, child in edges]


def _joint(fields: Fields, parent: int, child: int) -> AnnotatedJoint:
    def row(name: str) -> FloatArray:
        return np.asarray(fields[name][child], dtype=np.float64)

    turns = bool(fields["is_part_revolute"][child])
    slides = bool(fields["is_part_prismatic"][child])
    kind = KINDS[turns + 2 * slides]
    line = row("revolute_plucker")
    slide = row("prismatic_range")
    along = row("prismatic_axis")
    sliding = {"slide_axis": along, "slide_lower": slide[0], "slide_upper": slide[1]}
    lower, upper = (slide if kind == "prismatic" else row("revolute_range")).tolist()
    return AnnotatedJoint(
        name=f"joint_{child}",
        kind=kind,
        parent=parent,
        child=child,
        axis=along if kind == "prismatic" else line[:3],
        origin=point_on_line(line[:3], line[3:]) if turns else np.zeros(3),
        lower=None if kind == "fixed" else lower,
        upper=None if kind == "fixed" else upper,
        **(sliding if kind == "both" else {}),
    )
