"""A skin cut along planes, so that parts end in straight seams and not along triangles' edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry.crossings import BoolArray
from ...geometry.triangles import ends_of
from ...mesh import FloatArray, IntArray, Mesh
from .box import Box

#: Corners this near to a plane lie on it [m].
ON_PLANE_M = 1e-6


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

    def touching(self, box: Box) -> BoolArray:
        """Return the triangles whose bounds meet a box, shape [n]."""
        low, high = ends_of(self.corners)
        return np.asarray(((low <= box.high) & (high >= box.low)).all(axis=1))

    def chosen(self, which: BoolArray | IntArray) -> CutSkin:
        """Return some of the triangles."""
        return CutSkin(self.corners[which], self.face[which], self.weights[which], self.part[which])

    def joined(self, other: CutSkin) -> CutSkin:
        """These triangles and those."""
        return CutSkin(
            np.concatenate([self.corners, other.corners]),
            np.concatenate([self.face, other.face]),
            np.concatenate([self.weights, other.weights]),
            np.concatenate([self.part, other.part]),
        )

    def labelled(self, part: IntArray) -> CutSkin:
        """Return the same triangles as other parts'."""
        return CutSkin(self.corners, self.face, self.weights, part)


def cut(skin: CutSkin, normal: FloatArray, offset: float, which: BoolArray) -> CutSkin:
    """Return the skin with some triangles cut where ``normal . x = offset`` [m].

    Args:
        skin: to be cut.
        normal: unit, shape [3].
        offset: of the plane [m].
        which: triangles that may be cut, shape [n].
    """
    height = skin.corners @ normal - offset
    height[np.abs(height) < ON_PLANE_M] = 0.0
    low, high = ends_of(height)
    crossing = which & (low < 0.0) & (high > 0.0)
    if not crossing.any():
        return skin
    return skin.chosen(~crossing).joined(_halved(skin.chosen(crossing), height[crossing]))


def _halved(skin: CutSkin, height: FloatArray) -> CutSkin:
    """Triangles that a plane crosses, as one triangle on one side and one or two on the other."""
    sign = np.sign(height)
    # The lone corner: the only one on its side; the others follow in the triangle's own order.
    alone = np.where((sign > 0).sum(axis=1) == 1, (sign > 0).argmax(axis=1), (sign < 0).argmax(1))
    turn = (alone[:, None] + np.arange(3)) % 3
    rows = np.arange(len(turn))[:, None]
    corners = skin.corners[rows, turn]
    weights = skin.weights[rows, turn]
    height = height[rows, turn]
    pieces = [
        _Edges(corners, weights, height).between(0, 1),
        _Edges(corners, weights, height).between(0, 2),
    ]
    at = np.stack([corners[:, 0], corners[:, 1], corners[:, 2], pieces[0][0], pieces[1][0]], 1)
    mixed = np.stack([weights[:, 0], weights[:, 1], weights[:, 2], pieces[0][1], pieces[1][1]], 1)
    made = []
    for triangle in ([0, 3, 4], [3, 1, 2], [3, 2, 4]):
        made.append(CutSkin(at[:, triangle], skin.face, mixed[:, triangle], skin.part))
    whole = made[0].joined(made[1]).joined(made[2])
    edges = whole.corners[:, 1:] - whole.corners[:, :1]
    area = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
    return whole.chosen(area > 1e-14)


@dataclass(frozen=True)
class _Edges:
    corners: FloatArray
    weights: FloatArray
    height: FloatArray

    def between(self, first: int, second: int) -> tuple[FloatArray, FloatArray]:
        """Return where the edge between two corners crosses the plane."""
        a = self.height[:, first]
        b = self.height[:, second]
        share = np.clip(a / np.where(a == b, 1.0, a - b), 0.0, 1.0)[:, None]
        at = self.corners[:, first] + share * (self.corners[:, second] - self.corners[:, first])
        mixed = self.weights[:, first] + share * (self.weights[:, second] - self.weights[:, first])
        return at, mixed
