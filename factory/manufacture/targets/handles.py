"""Where a robot takes hold of a moving part: found in its shape, never in a name."""

from __future__ import annotations

import numpy as np
from trimesh.triangles import closest_point

from ...articulation import Articulation, Joint
from ...mesh import FloatArray, IntArray
from ...part import Handle
from .protrusions import (
    LOOKS_OUT,
    ProtrudingFront,
    component_labels,
    front_of,
    looking,
    opening_direction,
    protrusions,
)
from .shape import BoolArray, PartShape, lever, shape_of, turns_on_the_spot, velocity

#: Faces within this angle of the one that is held, and level with it, are part of the same patch.
SAME_SIDE = float(np.cos(np.radians(5.0)))
LEVEL_M = 1e-4


def find_handle(articulation: Articulation, part: int) -> Handle | None:
    """Return the geometry of a part that is called its handle.

    A protrusion from the part's front, if it has one: the component or cluster of faces that sticks
    out furthest from the hinge (revolute) or from the front nearest its middle (prismatic). Else
    the edge far from the hinge, the rim of what turns on the spot, or the middle of the front; the
    handle then is the flat patch around that place, so that everybody who looks for a handle's
    geometry finds some on every moving part.

    Args:
        articulation: with the part at rest.
        part: its index; pieces on fixed joints below it count as its own.

    Returns:
        ``None`` where no joint moves the part, or it has no geometry. ``source`` says how it was
        found: ``protrusion``, ``far_edge``, ``rim`` or ``front``.
    """
    joint = articulation.parent_joint(part)
    if joint is None or not joint.movable:
        return None
    shape = shape_of(articulation, part)
    if not len(shape.faces):
        return None
    handle = _found(joint, shape)
    own = np.isin(shape.faces, articulation.parts[part].faces)
    if not own.any() or np.isin(handle.faces, articulation.parts[part].faces).any():
        return handle
    # Whoever looks for a handle looks on the link that moves, not on those fixed to it.
    faces = np.union1d(handle.faces, _patch(shape.only(own), handle.point, handle.normal))
    return Handle(handle.point, handle.normal, handle.pull, faces, handle.source)


def _found(joint: Joint, shape: PartShape) -> Handle:
    if turns_on_the_spot(joint, shape):
        return _far_handle(joint, shape, "rim")
    front = front_of(shape, opening_direction(joint, shape))
    for chosen in protrusions(joint, shape, front):
        return _protruding_handle(joint, shape, front, chosen)
    if joint.turns:
        return _far_handle(joint, shape, "far_edge")
    on_panel = looking(shape, front.outward) & (
        np.abs(front.height.max(axis=1) - front.level) <= front.tolerance
    )
    return _handle_near(joint, shape, on_panel, _mean(shape, on_panel), front.outward, "front")


def _protruding_handle(
    joint: Joint, shape: PartShape, front: ProtrudingFront, chosen: IntArray
) -> Handle:
    outward = front.outward
    height = front.height
    top = np.zeros(len(shape.faces), dtype=bool)
    top[chosen] = True
    ahead = top & (shape.normals @ outward > LOOKS_OUT)
    # The front of the grip, not its feet: what looks out within the outer half of its reach.
    outer = height.mean(axis=1) > (height[chosen].min() + height[chosen].max()) / 2.0
    target = ahead & outer if (ahead & outer).any() else top
    middle = shape.corners[chosen].reshape(-1, 3)
    point = (middle.min(axis=0) + middle.max(axis=0)) / 2.0
    point = point + outward * (float(height[chosen].max()) - point @ outward)
    handle = _handle_near(joint, shape, target, point, outward, "protrusion")
    return Handle(
        handle.point, handle.normal, handle.pull, np.sort(shape.faces[chosen]), handle.source
    )


def _far_handle(joint: Joint, shape: PartShape, source: str) -> Handle:
    """Return the middle of what is furthest from the axis."""
    reach = float(lever(joint, shape.corners).max())
    edge = lever(joint, shape.corners).max(axis=1) >= (1.0 - 0.02) * reach
    points = shape.corners[edge].reshape(-1, 3)
    points = points[lever(joint, points) >= (1.0 - 0.02) * reach]
    if source == "rim":
        # Every point of a rim is as good: the one highest up, or first, keeps the choice stable.
        target = points[np.lexsort((points[:, 1], points[:, 0], -np.round(points[:, 2], 4)))[0]]
    else:
        target = (points.min(axis=0) + points.max(axis=0)) / 2.0
    radial = target - joint.origin - ((target - joint.origin) @ joint.axis) * joint.axis
    radial = radial / np.linalg.norm(radial)
    far = lever(joint, shape.centers) >= 0.5 * reach
    outer = far & (shape.normals @ radial > LOOKS_OUT)
    return _handle_near(joint, shape, outer if outer.any() else edge, target, radial, source)


def _mean(shape: PartShape, chosen: BoolArray) -> FloatArray:
    if not chosen.any():
        return shape.center
    return np.asarray(shape.areas[chosen] @ shape.centers[chosen] / shape.areas[chosen].sum())


def _handle_near(
    joint: Joint,
    shape: PartShape,
    target: BoolArray,
    point: FloatArray,
    outward: FloatArray,
    source: str,
) -> Handle:
    """Return the point of the target faces nearest to ``point``, and what pulling there does."""
    faces = np.flatnonzero(target) if target.any() else np.arange(len(shape.faces))
    on_surface = closest_point(shape.corners[faces], np.tile(point, (len(faces), 1)))
    nearest = int(np.linalg.norm(on_surface - point, axis=1).argmin())
    contact = on_surface[nearest]
    normal = shape.normals[faces[nearest]]
    pull = velocity(joint, contact)
    length = float(np.linalg.norm(pull))
    if not length > 0.0:
        pull = joint.axis
        length = 1.0
    held = _patch(shape, contact, normal)
    return Handle(
        contact, normal if normal @ outward >= 0.0 else -normal, pull / length, held, source
    )


def _patch(shape: PartShape, point: FloatArray, normal: FloatArray) -> IntArray:
    """Mesh faces, sorted, of the flat patch of a shape that holds or is nearest to ``point``."""
    distance = np.linalg.norm(
        closest_point(shape.corners, np.tile(point, (len(shape.corners), 1))) - point, axis=1
    )
    # Of faces that meet in the point, the one that looks the right way.
    near = distance <= distance.min() + LEVEL_M
    seed = int(np.where(near, np.abs(shape.normals @ normal), -1.0).argmax())
    away = np.abs((shape.corners - shape.corners[seed, 0]) @ shape.normals[seed]).max(axis=1)
    level = (np.abs(shape.normals @ shape.normals[seed]) > SAME_SIDE) & (away <= LEVEL_M)
    rows = np.flatnonzero(level)
    label = component_labels(shape.welded[rows])
    patch = rows[label == label[np.searchsorted(rows, seed)]]
    return np.sort(shape.faces[patch])
