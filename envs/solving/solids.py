"""What collides: convex pieces as half-spaces, a robot as points with a radius."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import trimesh

from ..assets import FloatArray

#: Spacing of a robot's points, of the arm and of the fingers [m]; each stands for a ball of half of
#: that.
ARM_SPACING = 0.03
FINGER_SPACING = 0.01
#: Farther than this from a piece nobody asks how far exactly [m].
NEAR = 0.02


@dataclass(frozen=True)
class Balls:
    """A robot's surface.

    Attributes:
        points: in their link's frame [m], shape [point, 3].
        link: index of each point's link, shape [point].
        radius: [m], shape [point].
    """

    points: FloatArray
    link: np.ndarray[Any, np.dtype[np.int64]]
    radius: FloatArray

    def placed(self, poses: FloatArray) -> FloatArray:
        """Return world points, shape [count, point, 3], by link ``poses``, [count, link, 4, 4]."""
        chosen = poses[:, self.link]
        turned = (chosen[..., :3, :3] @ self.points[:, :, None])[..., 0]
        return np.asarray(turned + chosen[..., :3, 3])

    def of(self, links: Sequence[int], every: int = 1) -> Balls:
        """Return only the points of some links, one of every so many."""
        keep = np.flatnonzero(np.isin(self.link, list(links)))[::every]
        return Balls(self.points[keep], self.link[keep], self.radius[keep])


@dataclass(frozen=True)
class Piece:
    """A convex piece of an object, in its link's frame: half-spaces ``normals x <= offsets``.

    Attributes:
        link: index of its link.
        normals, offsets: shapes [plane, 3] and [plane] [m].
        box: around it, shape [2, 3].
        mesh: the piece itself.
    """

    link: int
    normals: FloatArray
    offsets: FloatArray
    box: FloatArray
    mesh: trimesh.Trimesh


@dataclass(frozen=True)
class LinkHulls:
    """The convex pieces of an object."""

    pieces: tuple[Piece, ...]

    def distance(
        self, points: FloatArray, poses: FloatArray, leave_out: Sequence[int] = ()
    ) -> FloatArray:
        """Return the lower bound of the distance to the nearest piece [m], shape [count, point].

        Negative inside.

        Args:
            points: in the world [m], shape [count, point, 3]; beyond ``NEAR`` infinitely far is an
                answer.
            poses: of the object's links, shape [count, link, 4, 4], or [1, link, 4, 4] if they keep
                still.
            leave_out: links whose pieces do not count.
        """
        nearest = np.full(points.shape[:2], np.inf).ravel()
        for link, (pieces, around) in self._by_link.items():
            if link in leave_out:
                continue
            local = ((points - poses[:, None, link, :3, 3]) @ poses[:, link, :3, :3]).reshape(-1, 3)
            near = np.flatnonzero(_inside(local, around))
            local = local[near]
            for piece in pieces:
                close = np.flatnonzero(_inside(local, piece.box))
                if len(close):
                    beyond = (local[close] @ piece.normals.T - piece.offsets).max(axis=1)
                    nearest[near[close]] = np.minimum(nearest[near[close]], beyond)
        return nearest.reshape(points.shape[:2])

    @cached_property
    def _by_link(self) -> dict[int, tuple[tuple[Piece, ...], FloatArray]]:
        """Return the pieces of every link that has some, and the box around them."""
        found = {}
        for link in sorted({piece.link for piece in self.pieces}):
            pieces = tuple(piece for piece in self.pieces if piece.link == link)
            boxes = np.array([piece.box for piece in pieces])
            found[link] = (pieces, np.array([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)]))
        return found


def _inside(points: FloatArray, box: FloatArray) -> np.ndarray[Any, np.dtype[np.bool_]]:
    """Return whether points, shape [point, 3], are in a box or nearly, shape [2, 3]."""
    lower = box[0] - NEAR
    upper = box[1] + NEAR
    x, y, z = points.T
    inside = (x > lower[0]) & (x < upper[0])
    inside &= (y > lower[1]) & (y < upper[1])
    inside &= (z > lower[2]) & (z < upper[2])
    return np.asarray(inside)


def robot_balls(articulation: Any, fingers: Sequence[int]) -> Balls:
    """Return a robot's collision shapes as points; ``fingers`` finely, no thicker than they are."""
    points = []
    links = []
    radii = []
    for index, link in enumerate(articulation.links):
        spacing = FINGER_SPACING if index in fingers else ARM_SPACING
        for mesh in _meshes(link):
            finer = trimesh.remesh.subdivide_to_size
            corners, _ = finer(mesh.vertices, mesh.faces, spacing, max_iter=12)
            cells, first = np.unique(np.floor(corners / spacing), axis=0, return_index=True)
            points.append(corners[np.sort(first)])
            links.append(np.full(len(cells), index))
            radii.append(np.full(len(cells), 0.001 if index in fingers else 0.3 * spacing))
    return Balls(np.concatenate(points), np.concatenate(links), np.concatenate(radii))


def object_pieces(articulation: Any) -> LinkHulls:
    """Return the convex pieces of an object."""
    links = enumerate(articulation.links)
    return LinkHulls(tuple(_piece(i, mesh) for i, link in links for mesh in _meshes(link)))


def _piece(link: int, mesh: trimesh.Trimesh) -> Piece:
    normals = np.asarray(mesh.face_normals)
    offsets = np.einsum("fi,fi->f", normals, mesh.triangles[:, 0])
    return Piece(link, normals, offsets, np.array(mesh.bounds), mesh)


def _meshes(link: Any) -> list[trimesh.Trimesh]:
    meshes = []
    for shape in link.collision_shapes:
        mesh = _mesh(shape)
        mesh.apply_transform(shape.local_pose.to_transformation_matrix())
        meshes.append(mesh)
    return meshes


def _mesh(shape: Any) -> trimesh.Trimesh:
    """Return a collision shape as a closed convex mesh; a round one as a box or a coarse ball."""
    if hasattr(shape, "vertices"):
        return trimesh.Trimesh(np.asarray(shape.vertices) * np.asarray(shape.scale)).convex_hull
    if hasattr(shape, "half_size"):
        return trimesh.creation.box(extents=2.0 * np.asarray(shape.half_size))
    if hasattr(shape, "half_length"):
        radius = float(shape.radius)
        length = float(shape.half_length) + radius
        return trimesh.creation.box(extents=[2.0 * length, 2.0 * radius, 2.0 * radius])
    return trimesh.creation.icosphere(subdivisions=1, radius=float(shape.radius))
