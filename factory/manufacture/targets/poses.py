"""Where a hand might come to a moving part, before asking whether it can."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull, QhullError
from trimesh.triangles import closest_point

from ...articulation import Joint
from ...mesh import FloatArray, IntArray
from .protrusions import LOOKS_OUT, front_of, opening_direction, protrusions
from .shape import BoolArray, PartShape, lever, turns_on_the_spot, velocity

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
#: Share of the way from the axis to the rim within which nobody can move anything.
NEAR_HINGE = 0.15
#: Directions closer than this are one.
SAME = float(np.cos(np.radians(3.0)))


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


def poses_of(joint: Joint, shape: PartShape) -> list[Pose]:
    """Places on what sticks out of the part, and on its six sides.

    Args:
        joint: moves the shape.
        shape: at rest.
    """
    found: list[Pose] = []
    for outward in _fronts(joint, shape):
        front = front_of(shape, outward)
        for group in protrusions(joint, shape, front)[:MOST_GROUPS]:
            found += _on_protrusion(joint, shape.only(group), outward)
    for outward in _sides(joint, shape):
        found += _on_side(joint, shape, outward)
    return found


def _fronts(joint: Joint, shape: PartShape) -> list[FloatArray]:
    """Return the directions in which a handle may stand out."""
    if turns_on_the_spot(joint, shape):
        return [joint.axis, -joint.axis]
    outward = opening_direction(joint, shape)
    if joint.turns:
        far = shape.center - joint.origin
        radial = _across(_across(far, joint.axis), outward)
        return [outward, *([radial] if radial.any() else [])]
    # What slides in its own plane, like a window, is held on its faces.
    axes = rectangle(shape.corners.reshape(-1, 3), outward)
    widths = [float(np.ptp(shape.corners @ axis)) for axis in axes]
    thin = axes[int(np.argmin(widths))]
    sideways = min(widths) < 0.5 * float(np.ptp(shape.corners @ outward))
    return [outward, *([thin, -thin] if sideways else [])]


def _sides(joint: Joint, shape: PartShape) -> list[FloatArray]:
    """Six directions that fit the part and its joint."""
    first = joint.axis if turns_on_the_spot(joint, shape) else opening_direction(joint, shape)
    second = _across(joint.axis, first)
    if not second.any():
        second = rectangle(shape.corners.reshape(-1, 3), first)[0]
    third = np.cross(first, second)
    return [first, -first, second, -second, third, -third]


def _on_protrusion(joint: Joint, thing: PartShape, outward: FloatArray) -> list[Pose]:
    corners = thing.corners.reshape(-1, 3)
    axes = rectangle(corners, outward)
    ends = [(float((corners @ axis).min()), float((corners @ axis).max())) for axis in axes]
    top = float((corners @ outward).max())
    middle = outward * top + sum(
        axis * (low + high) / 2.0 for axis, (low, high) in zip(axes, ends, strict=True)
    )
    fingers = _fingers(joint, outward, axes)
    lengths = [high - low for low, high in ends]
    along = axes[int(np.argmax(lengths))]
    length = max(lengths)
    shifts = (0.0, 0.25, -0.25) if length > LONG_M else (0.0,)
    facing = thing.normals @ outward > LOOKS_OUT
    surface = thing.corners[facing] if facing.any() else thing.corners
    points = [nearest(surface, middle + shift * length * along) for shift in shifts]
    return [Pose(point, outward, fingers, True) for point in points]


def _on_side(joint: Joint, shape: PartShape, outward: FloatArray) -> list[Pose]:
    facing = shape.normals @ outward > LOOKS_OUT
    if not facing.any():
        return []
    side = shape.only(facing)
    height = side.corners @ outward
    outermost = side.only(height.max(axis=1) >= height.max() - SIDE_M)
    fingers = _fingers(joint, outward, rectangle(outermost.corners.reshape(-1, 3), outward))
    points = [nearest(outermost.corners, outermost.center)]
    if joint.turns:
        reach = lever(joint, side.corners)
        far = side.corners[reach >= FAR_SHARE * reach.max()]
        target = (far.min(axis=0) + far.max(axis=0)) / 2.0
        inward = _across(joint.origin - target, joint.axis)
        points.append(nearest(side.corners, target + INSET_M * inward))
    return [Pose(point, outward, fingers, False) for point in points]


def _fingers(
    joint: Joint, normal: FloatArray, axes: tuple[FloatArray, FloatArray]
) -> tuple[FloatArray, ...]:
    """Return the thing's own two directions first, then the joint's, then the diagonals."""
    turned = _across(joint.axis, normal)
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
    """Directions of the sides of the least rectangle around points along ``normal``; narrow first.

    Args:
        points: [m], shape [point_count, 3].
        normal: unit, shape [3].
    """
    start = np.eye(3)[int(np.abs(normal).argmin())]
    across = _across(start, normal)
    basis = np.stack([across, np.cross(normal, across)])
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
    return (
        (one, other)
        if round(float(first[best]), 6) <= round(float(second[best]), 6)
        else (other, one)
    )


def nearest(surface: FloatArray, point: FloatArray) -> FloatArray:
    """Return the point of some triangles nearest to ``point`` [m], shape [3]."""
    on_surface = closest_point(surface, np.tile(point, (len(surface), 1)))
    return np.asarray(
        on_surface[int(np.round(np.linalg.norm(on_surface - point, axis=1), 9).argmin())]
    )


def pull_at(joint: Joint, point: FloatArray) -> FloatArray:
    """Unit direction in which opening first moves a point, shape [3]; zero on the axis."""
    speed = velocity(joint, point)
    length = float(np.linalg.norm(speed))
    return np.asarray(speed / length) if length > 1e-6 else np.zeros(3)


def _across(vector: FloatArray, normal: FloatArray) -> FloatArray:
    """The part of a vector across a unit ``normal``, made unit; zero if hardly any, shape [3]."""
    rest = vector - (vector @ normal) * normal
    length = float(np.linalg.norm(rest))
    return (
        np.asarray(rest / length) if length > 0.1 * float(np.linalg.norm(vector)) else np.zeros(3)
    )


def sampled(
    joint: Joint, shape: PartShape, against: float, most: int
) -> tuple[FloatArray, FloatArray]:
    """Points of surface that faces against the opening, where a fingertip would push it open.

    Args:
        joint: moves the shape.
        shape: at rest.
        against: largest cosine between a face's normal and the direction in which it opens.
        most: points.

    Returns:
        Points [m] and their normals, shapes [point_count, 3].
    """
    speed = velocity(joint, shape.centers)
    length = np.maximum(np.linalg.norm(speed, axis=1), 1e-12)
    rows = np.flatnonzero(np.einsum("ij,ij->i", shape.normals, speed) / length < against)
    if not len(rows):
        return np.zeros((0, 3)), np.zeros((0, 3))
    return _spread(joint, shape, *_inset(joint, shape, rows), most)


def far_enough(joint: Joint, shape: PartShape, points: FloatArray) -> BoolArray:
    """Which points are so far from a hinge that anything can be moved there; per point, [...]."""
    if not joint.turns:
        return np.ones(points.shape[:-1], dtype=bool)
    return np.asarray(lever(joint, points) >= NEAR_HINGE * lever(joint, shape.corners).max())


def _inset(joint: Joint, shape: PartShape, rows: IntArray) -> tuple[FloatArray, FloatArray]:
    """Centres of faces, and points just within their corners and edges; with their normals."""
    corners = shape.corners[rows]
    centers = shape.centers[rows]
    edges = (corners + np.roll(corners, -1, axis=1)) / 2.0
    marks = np.concatenate([corners, edges], axis=1)
    inward = centers[:, None] - marks
    away = np.linalg.norm(inward, axis=2, keepdims=True)
    inset = marks + inward * np.minimum(1.0, INSET_M / np.maximum(away, 1e-12))
    # Small faces are one point each.
    wide = away.min(axis=(1, 2)) > INSET_M
    points = np.concatenate([centers, inset[wide].reshape(-1, 3)])
    normals = np.concatenate(
        [shape.normals[rows], np.repeat(shape.normals[rows[wide]], marks.shape[1], axis=0)]
    )
    useful = far_enough(joint, shape, points)
    return points[useful], normals[useful]


def _spread(
    joint: Joint, shape: PartShape, points: FloatArray, normals: FloatArray, most: int
) -> tuple[FloatArray, FloatArray]:
    """At most so many of the points, each as far as can be from those before (farthest first)."""
    reach = lever(joint, points) if joint.turns else -np.linalg.norm(points - shape.middle, axis=1)
    if not len(points):
        return points, normals
    first = int(np.round(reach, 6).argmax())
    chosen = [first]
    distance = np.linalg.norm(points - points[first], axis=1)
    while len(chosen) < min(most, len(points)):
        following = int(np.round(distance, 6).argmax())
        if distance[following] < INSET_M / 2.0:
            break
        chosen.append(following)
        distance = np.minimum(distance, np.linalg.norm(points - points[following], axis=1))
    return points[chosen], normals[chosen]
