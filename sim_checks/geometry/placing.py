"""Poses, points that they move, directions, boxes: lowest and highest corner [m], shape [2, 3]."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..description import BoolArray, DescribedShape, FloatArray, IntArray

#: Which end of a box each of its corners has along each axis, shape [8, 3].
ENDS = np.indices((2, 2, 2)).reshape(3, 8).T


def rigid(rotation: FloatArray, position: FloatArray) -> FloatArray:
    """Return the pose of a rotation, shape [3, 3], and a position [m], shape [3]; shape [4, 4]."""
    pose = np.eye(4)
    pose[:3, :3] = rotation
    pose[:3, 3] = position
    return pose


def placed(points: FloatArray, pose: FloatArray) -> FloatArray:
    """Return points [m], shape [point_count, 3], moved by a pose, shape [4, 4]."""
    return points @ pose[:3, :3].T + pose[:3, 3]


def box_around(groups: Iterable[FloatArray]) -> FloatArray:
    """Return the box around groups of points or of boxes [m], shape [..., 3] each -> [2, 3]."""
    points = np.vstack([np.reshape(group, (-1, 3)) for group in groups])
    return np.array([points.min(axis=0), points.max(axis=0)])


def box_corners(boxes: FloatArray) -> FloatArray:
    """Return the corners of boxes, shape [..., 2, 3] -> [..., 8, 3]."""
    return boxes[..., ENDS, np.arange(3)]


def grow_box(box: FloatArray, margin: float) -> FloatArray:
    """Return a box that reaches so far [m] beyond another, shape [2, 3]."""
    return np.array([box[0] - margin, box[1] + margin])


def box_gap(first: FloatArray, second: FloatArray) -> float:
    """Return the distance between the boxes around two sets of points [m]; 0 if they meet."""
    below = first.min(axis=0) - second.max(axis=0)
    apart = np.maximum(below, second.min(axis=0) - first.max(axis=0))
    return float(np.linalg.norm(np.maximum(0.0, apart)))


def boxes_near(boxes: FloatArray, others: FloatArray, margin: float = 0.0) -> BoolArray:
    """Tell which boxes come within ``margin`` [m] of others, shape [box_count, other_count].

    Boxes are given by lowest and highest corner, shape [box_count, 2, 3] and likewise.
    """
    near = np.ones((len(boxes), len(others)), dtype=bool)
    for axis in range(3):
        near &= boxes[:, None, 0, axis] - others[None, :, 1, axis] < margin
        near &= others[None, :, 0, axis] - boxes[:, None, 1, axis] < margin
    return near


def spread_directions(count: int) -> FloatArray:
    """Return unit vectors evenly over the sphere, shape [count, 3]."""
    index = np.arange(count) + 0.5
    height = 1.0 - 2.0 * index / count
    turn = np.pi * (1.0 + np.sqrt(5.0)) * index
    radius = np.sqrt(1.0 - height**2)
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), height])


def diagonal(groups: Iterable[FloatArray]) -> float:
    """Return the diagonal of the box around groups of points [m]; 0 where there is none."""
    every = list(groups)
    return float(np.linalg.norm(np.ptp(box_around(every), axis=0))) if every else 0.0


def shape_corners(shapes: Iterable[DescribedShape]) -> FloatArray:
    """Return the corners of the boxes around shapes [m], shape [8 * shape_count, 3]."""
    boxes = [box_around([shape.vertices]) for shape in shapes if len(shape.vertices)]
    return box_corners(np.reshape(boxes, (-1, 2, 3))).reshape(-1, 3)


def joined(
    shapes: Iterable[tuple[DescribedShape, FloatArray]],
) -> tuple[FloatArray, IntArray] | None:
    """Return corners [m] and faces of shapes as one mesh; ``None`` where none has a face.

    Each is given with the pose that it is put at, shape [4, 4].
    """
    vertices = []
    faces = []
    count = 0
    for shape, pose in shapes:
        vertices.append(placed(shape.vertices, pose))
        faces.append(shape.faces + count)
        count += len(shape.vertices)
    return (np.vstack(vertices), np.vstack(faces)) if any(map(len, faces)) else None
