"""Which parts can be there together, and what hangs on what."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...mesh import BoolArray, FloatArray, IntArray

#: A part that lies in another to this share of its area, and is at most half as large, hangs on it.
INSIDE = 0.8
SMALLER = 0.5
#: A part that shares more of its area with others already there cannot be there too; less goes to
#: the others.
SHARED = 0.3


@dataclass(frozen=True)
class Sharing:
    """Faces shared out among some of the parts that were asked for.

    Attributes:
        face_part: of every face: 0 for what stays, else 1 + index into ``chosen``, shape
            [face_count].
        chosen: indices of the parts that are there, in the order asked for.
        hosts: for each of them what it hangs on: 0 for what stays, else 1 + index into ``chosen``.
    """

    face_part: IntArray
    chosen: tuple[int, ...]
    hosts: tuple[int, ...]


def share_out(parts: Sequence[BoolArray], areas: FloatArray) -> Sharing:
    """Return the faces shared out, first come first served; what stays keeps at least one face.

    Args:
        parts: faces of each part asked for, best first, shape [face_count] each.
        areas: of the faces, shape [face_count].
    """
    owner = np.zeros(len(areas), dtype=np.int64)
    chosen: list[int] = []
    hosts: list[int] = []
    for index, faces in enumerate(parts):
        own = float(areas[faces].sum())
        inside = np.bincount(owner[faces], weights=areas[faces], minlength=len(chosen) + 1)[1:]
        wanted = faces
        host = 0
        if inside.sum() > 0.0:
            most = int(inside.argmax())
            if inside[most] > INSIDE * own and own < SMALLER * float(
                areas[owner == most + 1].sum()
            ):
                host = most + 1
            elif inside.sum() < SHARED * own:
                wanted = faces & (owner == 0)
            else:
                continue
        if not wanted.any() or not ((owner == 0) & ~wanted).any():
            continue
        chosen.append(index)
        hosts.append(host)
        owner[wanted] = len(chosen)
    return Sharing(owner, tuple(chosen), tuple(hosts))
