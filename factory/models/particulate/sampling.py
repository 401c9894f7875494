"""Points on a surface as the network wants them: half at folds, every face at least once."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

from ...errors import InputRejected
from ...geometry.triangles import points_within
from ...mesh import BoolArray, FloatArray, IntArray
from .frames import UnitBox
from .surface import Surface

SHARP_SHARE = 0.5


@dataclass(frozen=True)
class Cloud:
    """Points on a surface.

    Attributes:
        points: in the surface's frame, shape [point_count, 3].
        normals: of the face; at a sharp edge the mean of two, not normalised, shape [point_count,
            3].
        faces: on which each point lies; at a sharp edge one of its faces, at random, shape
            [point_count].
        sharp: whether it lies on a sharp edge, shape [point_count]; those come first.
        components: connected component of that face, shape [point_count].
    """

    points: FloatArray
    normals: FloatArray
    faces: IntArray
    sharp: BoolArray
    components: IntArray

    def inside(self, box: UnitBox) -> Cloud:
        """Return the same cloud in the unit frame of a box."""
        return replace(self, points=box.inside(self.points))


@dataclass(frozen=True)
class CloudSample:
    """What the network is shown of one mesh.

    Attributes:
        cloud: points to label, object frame [m].
        context: a second cloud, from which features of the whole shape are computed, object frame
            [m].
        box: object frame to the network's: the box of the mesh, then that of all points, in one.
    """

    cloud: Cloud
    context: Cloud
    box: UnitBox


def sample(
    surface: Surface, points: int, context_points: int, most_covered: int, rng: np.random.Generator
) -> CloudSample:
    """Return both clouds of a surface, and the frame in which the network sees them.

    Args:
        surface: object frame [m].
        points: to label; more where that does not suffice for one on every face.
        context_points: for features.
        most_covered: faces that are sure of a point; of more faces only the largest are.
        rng: the same state gives the same sample.

    Raises:
        InputRejected: ``zero_size``: no face has an area.
    """
    cloud = draw(surface, points, rng, most_covered)
    context = draw(surface, context_points, rng, most_covered=0)
    mesh_box = UnitBox.around(surface.vertices[np.unique(surface.faces)])
    both = np.concatenate([context.points, cloud.points])
    return CloudSample(cloud, context, mesh_box.then(UnitBox.around(mesh_box.inside(both))))


def draw(surface: Surface, count: int, rng: np.random.Generator, most_covered: int) -> Cloud:
    """Draw ``count`` points: half on sharp edges, by length, and half on faces, by area.

    Args:
        surface: any frame; if it has no sharp edge, all points lie on faces.
        count: how many; the half on faces grows to one for each that is sure of one, where it must.
        rng: source of chance.
        most_covered: so many of the largest faces get a point before the others are drawn; faces
            without area get none.

    Raises:
        InputRejected: ``zero_size``: no face has an area.
    """
    solid = np.flatnonzero(surface.areas > 0.0)
    if not len(solid):
        why = f"none of {len(surface.faces)} faces has an area, so there is nothing to see"
        raise InputRejected("zero_size", why, value=0.0)
    sharp_count = int(SHARP_SHARE * count) if len(surface.sharp.edges) else 0
    on_edges = _on_edges(surface, sharp_count, rng)
    if len(solid) > most_covered:
        solid = solid[np.argsort(-surface.areas[solid], kind="stable")[:most_covered]]
    covered = rng.permutation(solid)
    weighted = _weighted(surface.areas, max(0, count - sharp_count - len(covered)), rng)
    return _joined(on_edges, _on_faces(surface, np.concatenate([covered, weighted]), rng))


def _on_edges(surface: Surface, count: int, rng: np.random.Generator) -> Cloud:
    chosen = _weighted(surface.sharp.lengths, count, rng)
    edges = surface.sharp.edges[chosen]
    ends = surface.vertices[surface.edges.ends[edges]]
    along = rng.random(len(edges))[:, None]
    # Any of the faces there, also in the half that decides where labels go.
    any_of = rng.random(len(edges)) * surface.edges.counts[edges]
    face = surface.edges.first[edges] + any_of.astype(np.int64)
    return Cloud(
        points=ends[:, 0] * (1.0 - along) + ends[:, 1] * along,
        normals=surface.sharp.normals[chosen],
        faces=surface.edges.faces[face],
        sharp=np.ones(len(edges), dtype=np.bool_),
        components=surface.components[surface.edges.faces[face]],
    )


def _on_faces(surface: Surface, faces: IntArray, rng: np.random.Generator) -> Cloud:
    shares = rng.random((2, len(faces)))
    return Cloud(
        points=points_within(surface.vertices[surface.faces[faces]], *shares),
        normals=surface.normals[faces],
        faces=faces,
        sharp=np.zeros(len(faces), dtype=np.bool_),
        components=surface.components[faces],
    )


def _weighted(weights: FloatArray, count: int, rng: np.random.Generator) -> IntArray:
    """Return the indices drawn in proportion to ``weights``, shape [count]."""
    if not count:
        return np.zeros(0, dtype=np.int64)
    total = np.cumsum(weights)
    drawn = np.searchsorted(total, rng.random(count) * total[-1], side="right")
    return np.asarray(np.minimum(drawn, len(weights) - 1), dtype=np.int64)


def _joined(one: Cloud, other: Cloud) -> Cloud:
    names = [each.name for each in fields(Cloud)]
    return Cloud(*(np.concatenate([getattr(c, name) for c in (one, other)]) for name in names))
