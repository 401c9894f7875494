"""Where a hand might come to a moving part, before asking whether it can."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from ...mesh import FloatArray, IntArray
from .protrusions import LOOKS_OUT, front_of, opening_direction, protrusions
from .shape import Moving, PartShape, across, middle_of, nearest_point

#: Most protrusions of one front that are looked at.
MOST_GROUPS = 4
#: A protrusion longer than this is also held at the quarters of its length [m].
LONG_M = 0.08
#: Surface within this distance of the outermost is one side of a part [m].
SIDE_M = 0.005
#: Of the way from the axis to the rim, where the far part of a side begins; and how far within it a
#: hand aims [m].
FAR_SHARE = 0.8
INSET_M = 0.01
#: Directions closer than this are one.
SAME = float(np.cos(np.radians(3.0)))
#: A surface faces against the opening if the cosine between its normal and the motion is below
#: this.
AGAINST = -0.6


@dataclass(frozen=True)
class Pose:
    """A place to come to.

    Attributes:
        point: on the surface [m], shape [3].
        normal: the hand comes against it; unit, shape [3].
        fingers: unit directions to close along, across the normal; each shape [3].
        protrudes: whether it is on something that sticks out.
    """

    point: FloatArray
    normal: FloatArray
    fingers: tuple[FloatArray, ...]
    protrudes: bool


def find_poses(moving: Moving) -> list[Pose]:
    """Find places on what sticks out of a part, and on its six sides."""
    found: list[Pose] = []
    for outward in _fronts(moving):
        front = front_of(moving.shape, outward)
        for group in protrusions(moving, front)[:MOST_GROUPS]:
            found += _on_protrusion(moving, moving.shape.only(group), outward)
    for outward in _sides(moving):
        found += _on_side(moving, outward)
    return found


def _fronts(moving: Moving) -> list[FloatArray]:
    """Return the directions in which a handle may stand out."""
    axis = moving.joint.axis
    if moving.spins:
        return [axis, -axis]
    shape = moving.shape
    outward = opening_direction(moving)
    if moving.joint.turns:
        radial = across(across(shape.center - moving.joint.origin, axis), outward)
        return [outward, *([radial] if radial.any() else [])]
    # What slides in its own plane, like a window, is held on its faces.
    sides = rectangle(shape.corners.reshape(-1, 3), outward)
    widths = [float(np.ptp(shape.corners @ side)) for side in sides]
    thin = sides[int(np.argmin(widths))]
    sideways = min(widths) < 0.5 * float(np.ptp(shape.corners @ outward))
    return [outward, *([thin, -thin] if sideways else [])]


def _sides(moving: Moving) -> list[FloatArray]:
    """Return six directions that fit the part and its joint."""
    first = moving.joint.axis if moving.spins else opening_direction(moving)
    second = across(moving.joint.axis, first)
    if not second.any():
        second = rectangle(moving.shape.corners.reshape(-1, 3), first)[0]
    third = np.cross(first, second)
    return [first, -first, second, -second, third, -third]


def _on_protrusion(moving: Moving, thing: PartShape, outward: FloatArray) -> list[Pose]:
    corners = thing.corners.reshape(-1, 3)
    axes = rectangle(corners, outward)
    ends = [(float((corners @ axis).min()), float((corners @ axis).max())) for axis in axes]
    top = float((corners @ outward).max())
    middle = outward * top + sum(
        axis * (low + high) / 2.0 for axis, (low, high) in zip(axes, ends, strict=True)
    )
    lengths = [high - low for low, high in ends]
    along = axes[int(np.argmax(lengths))]
    length = max(lengths)
    shifts = (0.0, 0.25, -0.25) if length > LONG_M else (0.0,)
    facing = thing.normals @ outward > LOOKS_OUT
    surface = thing.corners[facing] if facing.any() else thing.corners
    fingers = _fingers(moving, outward, axes)
    return [
        Pose(nearest_point(surface, middle + shift * length * along)[0], outward, fingers, True)
        for shift in shifts
    ]


def _on_side(moving: Moving, outward: FloatArray) -> list[Pose]:
    facing = moving.shape.normals @ outward > LOOKS_OUT
    if not facing.any():
        return []
    side = moving.shape.only(facing)
    height = side.corners @ outward
    outermost = side.only(height.max(axis=1) >= height.max() - SIDE_M)
    fingers = _fingers(moving, outward, rectangle(outermost.corners.reshape(-1, 3), outward))
    points = [nearest_point(outermost.corners, outermost.center)[0]]
    if moving.joint.turns:
        reach = moving.lever(side.corners)
        target = middle_of(side.corners[reach >= FAR_SHARE * reach.max()])
        inward = across(moving.joint.origin - target, moving.joint.axis)
        points.append(nearest_point(side.corners, target + INSET_M * inward)[0])
    return [Pose(point, outward, fingers, False) for point in points]


def _fingers(
    moving: Moving, normal: FloatArray, axes: tuple[FloatArray, FloatArray]
) -> tuple[FloatArray, ...]:
    """Return the thing's own two directions first, then the joint's, then the diagonals."""
    turned = across(moving.joint.axis, normal)
    wanted = [*axes]
    if turned.any():
        wanted += [turned, np.cross(normal, turned)]
    wanted += [(axes[0] + axes[1]) / np.sqrt(2.0), (axes[0] - axes[1]) / np.sqrt(2.0)]
    kept: list[FloatArray] = []
    for direction in wanted:
        if all(abs(float(direction @ other)) < SAME for other in kept):
            kept.append(direction)
    return tuple(kept)


def rectangle(points: FloatArray, normal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the directions of the sides of the least rectangle around points, the narrow first.

    The points [m], shape [n, 3], are seen along a unit ``normal``.
    """
    first_across = across(np.eye(3)[int(np.abs(normal).argmin())], normal)
    basis = np.stack([first_across, np.cross(normal, first_across)])
    flat = points @ basis.T
    try:
        outline = flat[ConvexHull(flat).vertices]
    except QhullError:
        outline = flat
    edges = np.roll(outline, -1, axis=0) - outline
    angles = np.unique(
        np.round(np.arctan2(edges[:, 1], edges[:, 0]) % (np.pi / 2.0), 6) % round(np.pi / 2.0, 6)
    )
    turns = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    first = np.ptp(outline @ turns.T, axis=0)
    second = np.ptp(outline @ np.stack([-turns[:, 1], turns[:, 0]]), axis=0)
    # Rounded, so that a circle's many equal rectangles leave the first.
    best = int(np.round(first * second / max(float((first * second).max()), 1e-12), 6).argmin())
    one = turns[best] @ basis
    other = np.cross(normal, one)
    narrow = round(float(first[best]), 6) <= round(float(second[best]), 6)
    return (one, other) if narrow else (other, one)


def spread_against(moving: Moving, most: int) -> tuple[FloatArray, FloatArray]:
    """Spread points over surface that faces against the opening: a push there opens.

    Returns at most so many points [m] and their normals, shape [n, 3] each; the best place to pull
    first, each as far as can be from those before.
    """
    shape = moving.shape
    speed = moving.velocity(shape.centers)
    length = np.maximum(np.linalg.norm(speed, axis=1), 1e-12)
    rows = np.flatnonzero(np.einsum("ij,ij->i", shape.normals, speed) / length < AGAINST)
    points, normals = _inset(moving, rows)
    if not len(points):
        return points, normals
    aside = np.linalg.norm(points - shape.middle, axis=1)
    reach = moving.lever(points) if moving.joint.turns else -aside
    chosen = [int(np.round(reach, 6).argmax())]
    distance = np.linalg.norm(points - points[chosen[0]], axis=1)
    while len(chosen) < min(most, len(points)):
        following = int(np.round(distance, 6).argmax())
        if distance[following] < INSET_M / 2.0:
            break
        chosen.append(following)
        distance = np.minimum(distance, np.linalg.norm(points - points[following], axis=1))
    return points[chosen], normals[chosen]


def _inset(moving: Moving, rows: IntArray) -> tuple[FloatArray, FloatArray]:
    """Return centres of faces, and points just within their corners and edges; with normals."""
    shape = moving.shape.only(rows)
    edges = (shape.corners + np.roll(shape.corners, -1, axis=1)) / 2.0
    marks = np.concatenate([shape.corners, edges], axis=1)
    inward = shape.centers[:, None] - marks
    away = np.linalg.norm(inward, axis=2, keepdims=True)
    inset = marks + inward * np.minimum(1.0, INSET_M / np.maximum(away, 1e-12))
    # Small faces are one point each.
    wide = away.min(axis=(1, 2), initial=np.inf) > INSET_M
    points = np.concatenate([shape.centers, inset[wide].reshape(-1, 3)])
    normals = np.concatenate(
        [shape.normals, np.repeat(shape.normals[wide], marks.shape[1], axis=0)]
    )
    useful = moving.far_enough(points)
    return points[useful], normals[useful]
