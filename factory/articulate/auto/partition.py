"""Which parts can be there together, and what hangs on what."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...mesh import FloatArray, IntArray
from ...models.particulate.surface import BoolArray

#: A part that lies in another to this share of its area, and is at most half as large, hangs on it.
INSIDE = 0.8
SMALLER = 0.5
#: A part that shares more of its area with others already there cannot be there too; less goes to
#: the others.
SHARED = 0.3
#: A body has this share of a mesh's area; what it surrounds, give or take, has this share of its.
BODY = 0.25
AROUND_SHARE = 0.02
AROUND_MARGIN = 0.05


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

    @property
    def parents(self) -> IntArray:
        """Return the part that each part hangs on, what stays first with -1, shape [part_count]."""
        return np.array([-1, *self.hosts], dtype=np.int64)


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


def shells(
    sharing: Sharing, boxes: Sequence[FloatArray], doubted: Sequence[bool], areas: FloatArray
) -> set[int]:
    """Return parts that surround a large other one which does not hang on them: bodies.

    Args:
        sharing: of the parts.
        boxes: of each part asked for, low and high [m], shape [2, 3] each.
        doubted: of each part asked for, whether it may turn out to be one.
        areas: of the faces, shape [face_count].

    Returns:
        Indices of parts asked for.
    """
    size = np.bincount(sharing.face_part, weights=areas, minlength=len(sharing.chosen) + 1)
    found = set()
    for number, index in enumerate(sharing.chosen, start=1):
        for inner, other in enumerate(sharing.chosen[: number - 1], start=1):
            hangs = sharing.hosts[inner - 1] == number or sharing.hosts[number - 1] == inner
            large = size[number] >= BODY * size.sum()
            large = large and size[inner] >= AROUND_SHARE * size[number]
            if doubted[index] and large and not hangs and _within(boxes[other], boxes[index]):
                found.add(index)
    return found


def _within(inner: FloatArray, outer: FloatArray) -> bool:
    """Return whether a box lies in another, or in front of it as a door does.

    Give or take a margin in proportion to the other's size, it ends where that ends, but for one
    level direction in which they at least touch.
    """
    margin = AROUND_MARGIN * (outer[1] - outer[0])
    held = (inner[0] >= outer[0] - margin) & (inner[1] <= outer[1] + margin)
    touching = (inner[0] <= outer[1] + margin) & (inner[1] >= outer[0] - margin)
    return bool(touching.all() and held[2] and held[:2].any())
