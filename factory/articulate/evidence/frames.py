"""Right-angled frames along a part's straight edges: the object's, levelled, and its own."""

from __future__ import annotations

import numpy as np

from ...mesh import FloatArray
from .surfels import Surfels

#: Frames whose axes agree to this are one.
SAME = np.cos(np.radians(2.0))
#: Share of the surface that must look one way before that way means anything.
DOMINANT = 0.4


def own_frame(surfels: Surfels) -> FloatArray | None:
    """Return the direction most of the surface faces, and the straightest two across, [3, 3].

    On a round bar the first is its length, which none of the surface looks at. ``None`` if no
    direction stands out.
    """
    normals = surfels.normals
    if not len(normals):
        return None
    shares, directions = np.linalg.eigh(normals.T @ normals / len(normals))
    if shares[1] - shares[0] > 2.0 * (shares[2] - shares[1]) and shares[0] < 0.5 * shares[1]:
        return _completed(surfels, directions[:, 0])
    first = directions[:, 2]
    if shares[2] < DOMINANT:
        return None
    facing = surfels.facing(first)
    if facing.mean() >= 0.5 * DOMINANT:
        signs = np.sign(normals[facing] @ first)
        first = (normals[facing] * signs[:, None]).mean(axis=0)
        first /= np.linalg.norm(first)
    return _completed(surfels, first)


def _completed(surfels: Surfels, first: FloatArray) -> FloatArray:
    second = _across(surfels, first)
    return np.stack([first, second, np.cross(first, second)])


def _across(surfels: Surfels, first: FloatArray) -> FloatArray:
    """Return the heading of faces beside ``first``, modulo right angles; else the widest extent."""
    helper = np.eye(3)[int(np.argmin(np.abs(first)))]
    u = np.cross(first, helper)
    u /= np.linalg.norm(u)
    v = np.cross(first, u)
    beside = surfels.normals[np.abs(surfels.normals @ first) < 0.3]
    if len(beside) >= 8:
        mean = np.exp(4j * np.arctan2(beside @ v, beside @ u)).mean()
        if abs(mean) > 0.4:
            heading = np.angle(mean) / 4.0
            return np.asarray(np.cos(heading) * u + np.sin(heading) * v)
    offsets = surfels.points - surfels.points.mean(axis=0)
    plane = np.stack([offsets @ u, offsets @ v], axis=1)
    _, directions = np.linalg.eigh(plane.T @ plane)
    return np.asarray(directions[0, 1] * u + directions[1, 1] * v)


def distinct(frames: list[FloatArray]) -> list[FloatArray]:
    """Drop frames whose axes an earlier one has, whatever their order and signs."""
    kept: list[FloatArray] = []
    for frame in frames:
        if all((np.abs(frame @ other.T).max(axis=1) < SAME).any() for other in kept):
            kept.append(frame)
    return kept
