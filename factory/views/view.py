"""Views of a mesh's sides: depth, faces, parts, normals and colours."""

from __future__ import annotations

import io
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
import numpy.typing as npt

from ..geometry.colors import srgb_of
from ..geometry.triangles import doubled_normals
from ..mesh import BoolArray, FloatArray, IntArray, Material, Mesh, Texture, unit_rows
from .crossings import nearest_crossings
from .raster import PIXELS, Raster, Side


@dataclass(frozen=True, eq=False)
class View:
    """One side of a mesh in a picture; arrays have shape [rows, columns], row 0 lowest.

    Attributes:
        mesh: that is looked at.
        raster: where its pixels lie.
        face: the nearest triangle; -1: none.
        depth: behind the nearest point of the mesh [m]; infinite without a triangle.
        weights: of the triangle's corners, shape [rows, columns, 3].
        owner: the part of every triangle, shape [face_count].
    """

    mesh: Mesh
    raster: Raster
    face: IntArray
    depth: FloatArray
    weights: FloatArray
    owner: IntArray

    @property
    def side(self) -> Side:
        """Return the side that is looked at."""
        return self.raster.side

    @cached_property
    def seen(self) -> BoolArray:
        """Return which pixels show the mesh."""
        return self.face >= 0

    @cached_property
    def away(self) -> FloatArray:
        """Return the depth in the side's own frame [m]; infinite where no mesh is."""
        return self.depth + self.raster.near

    @cached_property
    def part(self) -> IntArray:
        """Return the part that every pixel shows; -1: none."""
        return np.where(self.seen, self.owner[self.face], -1)

    @cached_property
    def normal(self) -> FloatArray:
        """Return unit normals in the side's frame, shape [rows, columns, 3]; 0: nothing."""
        normals = doubled_normals(self.mesh.vertices[self.mesh.faces]) @ self.raster.side.frame.T
        return np.where(self.seen[..., None], unit_rows(normals)[self.face], 0.0)

    @cached_property
    def color(self) -> FloatArray:
        """Return base colours as shown (sRGB) in [0, 1], shape [rows, columns, 3]; 0: nothing."""
        picture = np.zeros((*self.face.shape, 3))
        picture[self.seen] = painted(self.mesh, self.face[self.seen], self.weights[self.seen])
        return picture


def elevation(mesh: Mesh, side: Side, pixels: int = PIXELS, owner: IntArray | None = None) -> View:
    """Look at a mesh from one side.

    Args:
        mesh: with at least one triangle.
        side: from where.
        pixels: along the longest extent of the mesh.
        owner: the part of every triangle, shape [face_count]; one by default.
    """
    raster = Raster.around(mesh, side, pixels)
    met = nearest_crossings(mesh, raster)
    shape = (raster.rows, raster.columns)
    face = np.full(shape, -1, dtype=np.int64)
    depth = np.full(shape, np.inf)
    weights = np.zeros((*shape, 3))
    face.ravel()[met.pixel] = met.face
    depth.ravel()[met.pixel] = met.depth
    weights.reshape(-1, 3)[met.pixel] = met.weights
    whole = np.zeros(len(mesh.faces), dtype=np.int64) if owner is None else owner
    return View(mesh, raster, face, depth, weights, whole)


class Views:
    """The six sides of one mesh; each is looked at once, when it is first asked for.

    Args:
        mesh: with at least one triangle.
        owner: the part of every triangle, shape [face_count]; one by default.
    """

    def __init__(self, mesh: Mesh, owner: IntArray | None = None) -> None:
        self.mesh = mesh
        self.owner = np.zeros(len(mesh.faces), dtype=np.int64) if owner is None else owner
        self._known: dict[Side, View] = {}

    def __getitem__(self, side: Side) -> View:
        """Return the view of a side."""
        if side not in self._known:
            self._known[side] = elevation(self.mesh, side, owner=self.owner)
        return self._known[side]


def painted(mesh: Mesh, face: IntArray, weights: FloatArray) -> FloatArray:
    """Return base colours as shown (sRGB) in [0, 1] at points of triangles, shape [n, 3].

    Points are told by their triangle, shape [n], and the weights of its corners, shape [n, 3].
    """
    colors = np.zeros((len(face), 3))
    material = mesh.face_material[face]
    for index, each in enumerate(mesh.materials):
        here = material == index
        if here.any():
            colors[here] = _painted(mesh, each, face[here], weights[here])
    return colors


def _painted(mesh: Mesh, material: Material, face: IntArray, weights: FloatArray) -> FloatArray:
    plain = srgb_of(material.color[:3])
    uv = mesh.corner_uv
    if material.texture is None or uv is None:
        return np.broadcast_to(plain, (len(face), 3))
    image = _pixels(material.texture)
    at = np.einsum("ij,ijk->ik", weights, uv[face])
    at = np.nan_to_num(at) % 1.0
    rows = ((1.0 - at[:, 1]) * image.shape[0]).astype(np.int64) % image.shape[0]
    columns = (at[:, 0] * image.shape[1]).astype(np.int64) % image.shape[1]
    return np.asarray(image[rows, columns] / 255.0 * plain)


@lru_cache(maxsize=2)
def _pixels(texture: Texture) -> npt.NDArray[np.uint8]:
    """Return a texture as it is shown, [rows, columns, 3]; kept, as every side asks for it."""
    from PIL import Image

    with Image.open(io.BytesIO(texture.data)) as opened:
        return np.asarray(opened.convert("RGB"))
