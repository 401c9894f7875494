"""What a format reader hands to cleaning: triangles as in the file, not welded nor dropped."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ..mesh import FloatArray, IntArray, Material, distinct_names

#: Of a name, so many letters are looked at.
_LETTERS = 1000


@dataclass(frozen=True)
class Soup:
    """Triangles in input units, frame and face order; corners may be NaN or infinite.

    Attributes:
        corners: positions, shape [face_count, 3, 3].
        uv: texture coordinates per corner, origin bottom left, shape [face_count, 3, 2], or
            ``None``.
        normals: per corner, any length, shape [face_count, 3, 3], or ``None``.
        face_material: index into ``materials``, shape [face_count].
        materials: at least one.
        license: as stated in the file.
        notes: what the reader had to leave out, one sentence each.
    """

    corners: FloatArray
    uv: FloatArray | None
    normals: FloatArray | None
    face_material: IntArray
    materials: tuple[Material, ...]
    license: str | None = None
    notes: tuple[str, ...] = ()


def plain_soup(corners: FloatArray) -> Soup:
    """Return a soup of one plain material; ``corners`` as in :class:`Soup`."""
    none = np.zeros(len(corners), dtype=np.int64)
    return Soup(corners, None, None, none, (Material("default"),))


def _safe(text: str) -> str:
    """Replace all but letters, digits, ``_``, ``-`` and ``.``; 80 characters at most."""
    kept = "".join(
        c if c.isascii() and (c.isalnum() or c in "_-.") else "_" for c in text[:_LETTERS]
    )
    return kept.strip("._")[:80] or "material"


def unique_names(names: Iterable[str]) -> list[str]:
    """Return safe names, later ones told apart by a number."""
    return distinct_names(_safe(name) for name in names)
