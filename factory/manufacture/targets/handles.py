"""Where a robot takes hold of a moving part: found in its shape, never in a name."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...articulation import Articulation
from ...mesh import BoolArray, FloatArray, IntArray
from ...part import Handle
from ..decompose.solids import component_labels
from .protrusions import (
    LOOKS_OUT,
    ProtrudingFront,
    front_of,
    looking,
    opening_direction,
    protrusions,
)
from .shape import Moving, PartShape, across, middle_of, nearest_point, nearest_points, shape_of

#: Faces within this angle of the one that is held, and level with it, are part of the same patch.
SAME_SIDE = float(np.cos(np.radians(5.0)))
LEVEL_M = 1e-4


def find_handle(articulation: Articulation, part: int) -> Handle | None:
    """Return the geometry of a part, at rest, that is called its handle.

    A protrusion from the part's front, if it has one: the component or cluster of faces that sticks
    out furthest from the hinge (revolute) or from the front nearest its middle (prismatic). Else
    the edge far from the hinge, the rim of what turns on the spot, or the middle of the front; the
    handle then is the flat patch around that place, so that everybody who looks for a handle's
    geometry finds some on every moving part. Pieces on fixed joints below the part count as its
    own.

    ``None`` where no joint moves the part, or it has no geometry. ``source`` says how it was found:
    ``protrusion``, ``far_edge``, ``rim`` or ``front``.
    """
    joint = articulation.parent_joint(part)
    if joint is None or not joint.movable:
        return None
    shape = shape_of(articulation, part)
    if not len(shape.faces):
        return None
    handle = _find(Moving(joint, shape))
    own = np.isin(shape.faces, articulation.parts[part].faces)
    if not own.any() or np.isin(handle.faces, articulation.parts[part].faces).any():
        return handle
    # Whoever looks for a handle looks on the link that moves, not on those fixed to it.
    patch = _patch(shape.only(own), handle.point, handle.normal)
    return replace(handle, faces=np.union1d(handle.faces, patch))


def _find(moving: Moving) -> Handle:
    shape = moving.shape
    if moving.spins:
        return _far_handle(moving, "rim")
    front = front_of(shape, opening_direction(moving))
    for chosen in protrusions(moving, front):
        return _protruding_handle(moving, front, chosen)
    if moving.joint.turns:
        return _far_handle(moving, "far_edge")
    on_panel = looking(shape, front.outward) & (
        np.abs(front.height.max(axis=1) - front.level) <= front.tolerance
    )
    middle = shape.only(on_panel).center if on_panel.any() else shape.center
    return _handle_near(moving, on_panel, middle, front.outward, "front")


def _protruding_handle(moving: Moving, front: ProtrudingFront, chosen: IntArray) -> Handle:
    shape = moving.shape
    outward = front.outward
    height = front.height
    top = np.zeros(len(shape.faces), dtype=bool)
    top[chosen] = True
    ahead = top & (shape.normals @ outward > LOOKS_OUT)
    # The front of the grip, not its feet: what looks out within the outer half of its reach.
    outer = ahead & (height.mean(axis=1) > (height[chosen].min() + height[chosen].max()) / 2.0)
    target: BoolArray = outer if outer.any() else top
    point = middle_of(shape.corners[chosen])
    point = point + outward * (float(height[chosen].max()) - point @ outward)
    handle = _handle_near(moving, target, point, outward, "protrusion")
    return replace(handle, faces=np.sort(shape.faces[chosen]))


def _far_handle(moving: Moving, source: str) -> Handle:
    """Return the middle of the faces furthest from the axis."""
    shape = moving.shape
    farthest = 0.98 * moving.rim
    reach = moving.lever(shape.corners)
    points = shape.corners[reach >= farthest]
    if source == "rim":
        # Every point of a rim is as good: the one highest up, or first, keeps the choice stable.
        target = points[np.lexsort((points[:, 1], points[:, 0], -np.round(points[:, 2], 4)))[0]]
    else:
        target = middle_of(points)
    radial = across(target - moving.joint.origin, moving.joint.axis)
    far = moving.lever(shape.centers) >= 0.5 * moving.rim
    outer = far & (shape.normals @ radial > LOOKS_OUT)
    edge = np.asarray((reach >= farthest).any(axis=1))
    return _handle_near(moving, outer if outer.any() else edge, target, radial, source)


def _handle_near(
    moving: Moving, target: BoolArray, point: FloatArray, outward: FloatArray, source: str
) -> Handle:
    """Return the point of the target faces nearest to ``point``, and what pulling there does."""
    shape = moving.shape
    faces = np.flatnonzero(target) if target.any() else np.arange(len(shape.faces))
    contact, number = nearest_point(shape.corners[faces], point)
    normal = shape.normals[faces[number]]
    pull = moving.pull(contact)
    pull = pull if pull.any() else moving.joint.axis
    held = _patch(shape, contact, normal)
    return Handle(contact, normal if normal @ outward >= 0.0 else -normal, pull, held, source)


def _patch(shape: PartShape, point: FloatArray, normal: FloatArray) -> IntArray:
    """Return the mesh faces, sorted, of the flat patch that holds or is nearest to ``point``."""
    _, distance = nearest_points(shape.corners, point)
    # Of faces that meet in the point, the one that looks the right way.
    near = distance <= distance.min() + LEVEL_M
    seed = int(np.where(near, np.abs(shape.normals @ normal), -1.0).argmax())
    away = np.abs((shape.corners - shape.corners[seed, 0]) @ shape.normals[seed]).max(axis=1)
    level = (np.abs(shape.normals @ shape.normals[seed]) > SAME_SIDE) & (away <= LEVEL_M)
    rows = np.flatnonzero(level)
    label = component_labels(shape.welded[rows])
    patch = rows[label == label[np.searchsorted(rows, seed)]]
    return np.sort(shape.faces[patch])
