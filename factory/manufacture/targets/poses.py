"""Where a hand might come to a moving part, before asking whether it can."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...mesh import FloatArray, IntArray
from .protrusions import LOOKS_OUT, opening_direction, protrusions
from .shape import Moving, PartShape, across, middle_of, nearest_point, rectangle

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
        faces: of the mesh, of the thing that it is on: what sticks out, or the outermost of a side,
            shape [face_count].
        protrudes: whether that sticks out.
    """

    point: FloatArray
    normal: FloatArray
    fingers: tuple[FloatArray, ...]
    faces: IntArray
    protrudes: bool


def find_poses(moving: Moving) -> Iterator[Pose]:
    """Yield places on what sticks out of a part, and on its six sides."""
    for outward in fronts(moving):
        yield from on_protrusions(moving, outward)
    for outward in _sides(moving):
        yield from on_side(moving, outward)


def on_protrusions(moving: Moving, outward: FloatArray) -> Iterator[Pose]:
    """Yield places on what sticks out of the side that looks in a direction, the best first."""
    for group in protrusions(moving, outward)[:MOST_GROUPS]:
        yield from _on_protrusion(moving, moving.shape.only(group), outward)


def far_side(moving: Moving) -> FloatArray:
    """Return the direction of the side where a part without a handle is held, shape [3].

    The one far from its hinge, the highest of what turns on the spot, or the front.
    """
    if moving.spins:
        sides = [across(candidate, moving.joint.axis) for candidate in np.eye(3)[[2, 0]]]
        return next(side for side in sides if side.any())
    return fronts(moving)[-1 if moving.joint.turns else 0]


def fronts(moving: Moving) -> list[FloatArray]:
    """Return the directions in which a handle may stand out, its opening first."""
    axis = moving.joint.axis
    if moving.spins:
        return [axis, -axis]
    shape = moving.shape
    outward = opening_direction(moving)
    if moving.joint.turns:
        radial = across(across(shape.center - moving.joint.origin, axis), outward)
        return [outward, *([radial] if radial.any() else [])]
    # What slides in its own plane, like a window, is held on its faces.
    thin, _ = rectangle(shape.corners, outward)
    sideways = np.ptp(shape.corners @ thin) < 0.5 * np.ptp(shape.corners @ outward)
    return [outward, *([thin, -thin] if sideways else [])]


def _sides(moving: Moving) -> list[FloatArray]:
    """Return six directions that fit the part and its joint."""
    first = fronts(moving)[0]
    second = across(moving.joint.axis, first)
    if not second.any():
        second, _ = rectangle(moving.shape.corners, first)
    third = np.cross(first, second)
    return [first, -first, second, -second, third, -third]


def _on_protrusion(moving: Moving, thing: PartShape, outward: FloatArray) -> Iterator[Pose]:
    axes = rectangle(thing.corners, outward)
    frame = np.stack([*axes, outward])
    local = thing.corners @ frame.T
    low = local.min(axis=(0, 1))
    high = local.max(axis=(0, 1))
    top = np.append((low + high)[:2] / 2.0, high[2]) @ frame
    length = float(high[1] - low[1])
    surface = _surface_towards(thing, outward).corners
    fingers = _fingers(moving, outward, axes)
    for shift in (0.0, 0.25, -0.25) if length > LONG_M else (0.0,):
        point = nearest_point(surface, top + shift * length * axes[1])
        yield Pose(point, outward, fingers, thing.faces, True)


def on_side(moving: Moving, outward: FloatArray) -> Iterator[Pose]:
    """Yield places on the side of a part that looks in a direction: its middle, and its far end."""
    side = _surface_towards(moving.shape, outward)
    height = side.corners @ outward
    outermost = side.only(height.max(axis=1) >= height.max() - SIDE_M)
    fingers = _fingers(moving, outward, rectangle(outermost.corners, outward))
    points = [nearest_point(outermost.corners, outermost.center)]
    if moving.joint.turns:
        reach = moving.lever(side.corners)
        target = middle_of(side.corners[reach >= FAR_SHARE * reach.max()])
        inward = across(moving.joint.origin - target, moving.joint.axis)
        points.append(nearest_point(side.corners, target + INSET_M * inward))
    for point in points:
        yield Pose(point, outward, fingers, outermost.faces, False)


def _surface_towards(shape: PartShape, outward: FloatArray) -> PartShape:
    """Return the faces that look in a direction; all of them where none does."""
    facing = shape.normals @ outward > LOOKS_OUT
    return shape.only(facing) if facing.any() else shape


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


def spread_against(moving: Moving, most: int) -> tuple[FloatArray, FloatArray]:
    """Spread points over surface that faces against the opening: a push there opens.

    Returns at most so many points [m] and their normals, shape [n, 3] each; the best place to pull
    first, each as far as can be from those before.
    """
    shape = moving.shape
    speed = moving.joint.velocity(shape.centers)
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
