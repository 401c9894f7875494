"""What a format reader hands to cleaning: triangles as in the file, not welded nor dropped."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ..mesh import FloatArray, IntArray, Material

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


def stack_corners(
    pieces: Sequence[FloatArray | None], counts: Sequence[int], width: int
) -> FloatArray | None:
    """Join pieces' corner attributes, NaN for a piece without; ``None`` if all are without."""
    if all(piece is None for piece in pieces):
        return None
    filled = [
        np.full((count, 3, width), np.nan) if piece is None else piece
        for piece, count in zip(pieces, counts, strict=True)
    ]
    return np.concatenate(filled)


def _safe(text: str) -> str:
    """Replace all but letters, digits, ``_``, ``-`` and ``.``; 80 characters at most."""
    kept = "".join(
        c if c.isascii() and (c.isalnum() or c in "_-.") else "_" for c in text[:_LETTERS]
    )
    return kept.strip("._")[:80] or "material"


def unique_names(names: Iterable[str]) -> list[str]:
    """Return safe names, later ones told apart by a number."""
    taken: set[str] = set()
    reached: dict[str, int] = {}
    result: list[str] = []
    for raw in names:
        base = _safe(raw)
        # Thousands of one name would else count from one again and again.
        name = base
        number = reached.get(base, 1)
        while name in taken:
            number += 1
            name = f"{base}_{number}"
        reached[base] = number
        taken.add(name)
        result.append(name)
    return result
