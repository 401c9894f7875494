"""A mesh cut along planes, so that parts end in straight seams, not along triangles' edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry.cutting import cut_at_zero
from ...geometry.triangles import areas_of, ends_of
from ...mesh import BoolArray, FloatArray, IntArray, Mesh
from ..decompose.convex import SAME_M
from .box import Box


@dataclass(frozen=True)
class CutSkin:
    """Triangles of a mesh or of pieces of its triangles.

    Attributes:
        corners: positions [m], shape [n, 3, 3].
        face: of the mesh, that each is a piece of, shape [n].
        weights: of that face's corners at each corner, shape [n, 3, 3].
        part: to which each belongs, shape [n].
    """

    corners: FloatArray
    face: IntArray
    weights: FloatArray
    part: IntArray

    @classmethod
    def of(cls, mesh: Mesh, part: IntArray) -> CutSkin:
        """Return all triangles of a mesh."""
        count = len(mesh.faces)
        return cls(
            mesh.vertices[mesh.faces],
            np.arange(count),
            np.broadcast_to(np.eye(3), (count, 3, 3)),
            part,
        )

    @property
    def middles(self) -> FloatArray:
        """Return the centres of the triangles [m], shape [n, 3]."""
        first, second, third = np.moveaxis(self.corners, 1, 0)
        return np.asarray((first + second + third) / 3.0)

    def of_part(self, part: int) -> FloatArray:
        """Return the corners of a part's triangles [m], shape [n, 3, 3]."""
        return np.asarray(self.corners[self.part == part])

    def touching(self, box: Box) -> BoolArray:
        """Return the triangles whose bounds meet a box, shape [n]."""
        low, high = ends_of(self.corners)
        return np.asarray(((low <= box.high) & (high >= box.low)).all(axis=1))

    def chosen(self, which: BoolArray | IntArray) -> CutSkin:
        """Return some of the triangles."""
        return CutSkin(self.corners[which], self.face[which], self.weights[which], self.part[which])

    def joined(self, other: CutSkin) -> CutSkin:
        """Return these triangles and those."""
        both = zip(vars(self).values(), vars(other).values(), strict=True)
        return CutSkin(*(np.concatenate(each) for each in both))


def cut(skin: CutSkin, normal: FloatArray, offset: float, which: BoolArray) -> CutSkin:
    """Return the mesh with some triangles, ``which``, cut where ``normal . x = offset`` [m]."""
    height = skin.corners @ normal - offset
    height[np.abs(height) < SAME_M] = 0.0
    low, high = ends_of(height)
    crossing = which & (low < 0.0) & (high > 0.0)
    if not crossing.any():
        return skin
    halved = skin.chosen(crossing)
    pieces = cut_at_zero(height[crossing])
    made = CutSkin(
        pieces.spread(halved.corners),
        halved.face[pieces.whole],
        pieces.spread(halved.weights),
        halved.part[pieces.whole],
    )
    return skin.chosen(~crossing).joined(made.chosen(areas_of(made.corners) > 5e-15))
