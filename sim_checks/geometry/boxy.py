"""Surfaces that are boxes in the main: doors, drawers, lids."""

from __future__ import annotations

import numpy as np

from ..description import FloatArray, IntArray
from .kinematics import rotation_about

#: Faces look alike within this, or opposite [cosine of 3 deg], and across to this [sine of 5 deg].
NEAR = float(np.cos(np.radians(3.0)))
ACROSS = float(np.sin(np.radians(5.0)))
#: So many of the largest faces may say where most of a surface looks.
ASKED = 64
#: A surface is a box if this share of its area looks in three directions at right angles.
BOXY = 0.7


def edge_meant(vertices: FloatArray, faces: IntArray, axis: FloatArray) -> FloatArray | None:
    """Return the edge of a box that a unit axis misses by least, pointing the same way, shape [3].

    Args:
        vertices: of a surface [m], shape [vertex_count, 3].
        faces: its triangles, shape [face_count, 3].
        axis: shape [3].

    Returns:
        A unit vector; ``None`` if the surface is no box in the main, or if a box along the axis is
        not larger: a window's lattice may be askew while its frame is not.
    """
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    normals = normals[areas > 0.0] / areas[areas > 0.0, None]
    areas = areas[areas > 0.0]
    first = _looked_at(normals, areas)
    across = np.abs(normals @ first) < ACROSS
    if not across.any():
        return None
    third = np.cross(first, _looked_at(normals[across], areas[across]))
    third /= np.linalg.norm(third)
    edges = np.array([first, np.cross(third, first), third])
    looks = (np.abs(normals @ edges.T) > NEAR).any(axis=1)
    if areas[looks].sum() < BOXY * areas.sum():
        return None
    cosines = edges @ axis
    nearest = int(np.argmax(np.abs(cosines)))
    edge: FloatArray = edges[nearest] * np.sign(cosines[nearest])
    about = np.cross(edge, axis)
    sine = float(np.linalg.norm(about))
    angle = float(np.arctan2(sine, edge @ axis))
    points = vertices[np.unique(faces)]
    askew = points @ rotation_about(about / max(sine, 1e-300), angle) @ edges.T
    # A square that is turned within its plane by an angle needs a square larger by twice that.
    least = (1.0 + angle) * np.prod(np.ptp(points @ edges.T, axis=0))
    return edge if np.prod(np.ptp(askew, axis=0)) >= least else None


def _looked_at(normals: FloatArray, areas: FloatArray) -> FloatArray:
    """Return the direction in which most of a surface looks, either way; 0 where there is none."""
    if not len(areas):
        return np.zeros(3)
    largest = np.argsort(-areas, kind="stable")[:ASKED]
    most = largest[int(np.argmax((np.abs(normals[largest] @ normals.T) > NEAR) @ areas))]
    cosines = normals @ normals[most]
    near = np.abs(cosines) > NEAR
    mean = (areas[near] * np.sign(cosines[near])) @ normals[near]
    return np.asarray(mean / np.linalg.norm(mean))
