"""Where a robot takes hold of a moving part: found in its shape, never in a name."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from trimesh.triangles import closest_point

from .articulation import Articulation, Joint, JointKind
from .asset import Handle
from .mesh.mesh import FloatArray, IntArray

BoolArray = npt.NDArray[np.bool_]

#: Faces within this angle of the panel's normal look outwards.
LOOKS_OUT = float(np.cos(np.radians(30.0)))
#: The panel is the frontmost level on which this share of the part's outline lies.
PANEL_SHARE = 0.25
#: Levels this share of the part's size apart are one, within these bounds [m].
LEVEL_SHARE, LEVEL_BOUNDS_M = 0.02, (0.003, 0.012)
#: What covers more than this share of the outline is a frame or another panel, no handle.
HANDLE_SHARE = 0.3
#: Pieces closer than this belong to one handle [m].
TOUCH_M = 0.004
#: A part whose centre is this much nearer to its axis than its rim turns on the spot, like a knob.
KNOB_SHARE = 0.25


@dataclass(frozen=True)
class _Shape:
    """A part and all that is fixed to it: mesh face indices, corners [m], outward normals, areas [m2]."""

    faces: IntArray
    welded: IntArray
    corners: FloatArray
    normals: FloatArray
    areas: FloatArray

    @property
    def centers(self) -> FloatArray:
        return np.asarray(self.corners.mean(axis=1))

    @property
    def center(self) -> FloatArray:
        """Centre of the surface [m]."""
        return np.asarray(self.areas @ self.centers / self.areas.sum())


def find_handle(articulation: Articulation, part: int) -> Handle | None:
    """The interaction target of a part.

    A protrusion from the part's front, if it has one: the component or cluster of faces that sticks out
    furthest from the hinge (revolute) or from the front nearest its middle (prismatic). Else the edge
    far from the hinge, the rim of what turns on the spot, or the middle of the front.

    Args:
        articulation: with the part at rest.
        part: its index; pieces on fixed joints below it count as its own.

    Returns:
        ``None`` where no joint moves the part, or it has no geometry. ``source`` says how it was found:
        ``protrusion``, ``far_edge``, ``rim`` or ``front``.
    """
    joint = articulation.parent_joint(part)
    if joint is None or not joint.movable:
        return None
    shape = _shape(articulation, part)
    if not len(shape.faces):
        return None
    if joint.turns and _turns_on_the_spot(joint, shape):
        return _far_handle(joint, shape, "rim")
    outward = _outward(joint, shape)
    height = shape.corners @ outward
    level, tolerance = _panel(shape, outward, height)
    chosen = _protrusion(joint, shape, outward, height, level, tolerance)
    if chosen is not None:
        return _protruding_handle(joint, shape, outward, height, chosen)
    if joint.turns:
        return _far_handle(joint, shape, "far_edge")
    on_panel = _looking(shape, outward) & (np.abs(height.max(axis=1) - level) <= tolerance)
    return _handle_near(joint, shape, on_panel, _mean(shape, on_panel), outward, "front")


def _shape(articulation: Articulation, part: int) -> _Shape:
    carried = {part}
    for joint in articulation.joints:
        if joint.parent in carried and joint.kind is JointKind.FIXED:
            carried.add(joint.child)
    mesh = articulation.mesh
    faces = np.concatenate([articulation.parts[i].faces for i in sorted(carried)])
    corners = mesh.vertices[mesh.faces[faces]]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    double = np.linalg.norm(cross, axis=1)
    real = double > 0.0
    normals = cross[real] / double[real, None]
    return _Shape(faces[real], mesh.faces[faces[real]], corners[real], normals, double[real] / 2.0)


def _velocity(joint: Joint, points: FloatArray) -> FloatArray:
    """Velocity of points of the part per unit of joint speed, opening, at rest; shape of ``points``."""
    if joint.turns:
        return np.asarray(np.cross(joint.axis, points - joint.origin))
    return np.broadcast_to(joint.axis, points.shape)


def _lever(joint: Joint, points: FloatArray) -> FloatArray:
    """Distance from the joint's axis [m]."""
    return np.asarray(np.linalg.norm(np.cross(joint.axis, points - joint.origin), axis=-1))


def _turns_on_the_spot(joint: Joint, shape: _Shape) -> bool:
    rim = float(_lever(joint, shape.corners).max())
    middle = (shape.corners.min(axis=(0, 1)) + shape.corners.max(axis=(0, 1))) / 2.0
    return float(_lever(joint, middle)) < KNOB_SHARE * rim


def _outward(joint: Joint, shape: _Shape) -> FloatArray:
    """Normal of the part's front: the commonest face direction that opening moves ahead, shape [3]."""
    velocity = _velocity(joint, shape.center)
    forward = velocity / np.linalg.norm(velocity)
    if not joint.turns:
        return np.asarray(forward)
    # Sheets may face either way.
    normals = shape.normals * np.where(shape.normals @ forward < 0.0, -1.0, 1.0)[:, None]
    ahead = normals @ forward > np.cos(np.radians(45.0))
    if not ahead.any():
        return np.asarray(forward)
    keys, inverse = np.unique(np.round(normals[ahead] * 4.0), axis=0, return_inverse=True)
    weight = np.bincount(inverse.reshape(-1), shape.areas[ahead], len(keys))
    commonest = keys[weight.argmax()] / np.linalg.norm(keys[weight.argmax()])
    alike = ahead & (normals @ commonest > LOOKS_OUT)
    if not alike.any():
        return np.asarray(commonest)
    mean = shape.areas[alike] @ normals[alike]
    return np.asarray(mean / np.linalg.norm(mean))


def _looking(shape: _Shape, outward: FloatArray) -> BoolArray:
    return np.asarray(np.abs(shape.normals @ outward) > LOOKS_OUT)


def _outline(shape: _Shape, outward: FloatArray) -> float:
    """Area of the part's box as seen along ``outward`` [m2]."""
    across = np.linalg.svd(outward[None])[2][1:]
    flat = shape.corners.reshape(-1, 3)
    # Seen along a coordinate axis the box is the coordinate one; else the frame across is as good as any.
    if np.abs(outward).max() > LOOKS_OUT:
        across = np.delete(np.eye(3), int(np.abs(outward).argmax()), axis=0)
    return float(np.prod(np.ptp(flat @ across.T, axis=0)))


def _panel(shape: _Shape, outward: FloatArray, height: FloatArray) -> tuple[float, float]:
    """Level of the front along ``outward`` [m], and how far from it still counts as it [m]."""
    size = float(np.ptp(shape.corners.reshape(-1, 3), axis=0).max())
    tolerance = float(np.clip(LEVEL_SHARE * size, *LEVEL_BOUNDS_M))
    looking = _looking(shape, outward)
    if not looking.any():
        return float(height.max()), tolerance
    levels = height[looking].mean(axis=1)
    areas = shape.areas[looking] * np.abs(shape.normals[looking] @ outward)
    order = np.argsort(-levels, kind="stable")
    levels, areas = levels[order], np.concatenate([[0.0], np.cumsum(areas[order])])
    ends = np.searchsorted(-levels, -levels + tolerance, side="right")
    band = areas[ends] - areas[:-1]
    enough = np.flatnonzero(band >= PANEL_SHARE * _outline(shape, outward))
    first = int(enough[0]) if len(enough) else int(band.argmax())
    # The band starts at its frontmost face, which may be a crumb: its mean is where the panel is.
    inside = slice(first, int(ends[first]))
    return float(np.average(levels[inside], weights=np.diff(areas)[inside])), tolerance


def _protrusion(
    joint: Joint, shape: _Shape, outward: FloatArray, height: FloatArray, level: float, tolerance: float
) -> IntArray | None:
    """Faces (indices into the shape) of the best thing that sticks out of the front; ``None`` if nothing does."""
    standing = height.mean(axis=1) > level + tolerance
    label = _component_labels(shape.welded)
    lowest = np.full(label.max() + 1, np.inf)
    highest = np.full(label.max() + 1, -np.inf)
    np.minimum.at(lowest, label, height.min(axis=1))
    np.maximum.at(highest, label, height.max(axis=1))
    # A component of its own that starts at the panel is a handle down to its foot.
    on_top = (lowest > level - tolerance) & (highest > level + 2.0 * tolerance)
    candidates = np.flatnonzero(standing | on_top[label])
    if not len(candidates):
        return None
    best, best_score = None, 0.0
    for group in _groups(shape, candidates):
        corners = shape.corners[group].reshape(-1, 3)
        reach = float(height[group].max()) - level
        covered = _outline(_subset(shape, group), outward) / _outline(shape, outward)
        if reach < tolerance or covered > HANDLE_SHARE:
            continue
        score = reach * _place(joint, shape, corners.mean(axis=0))
        if score > best_score:
            best, best_score = group, score
    return best


def _place(joint: Joint, shape: _Shape, point: FloatArray) -> float:
    """How good a place to pull is, 0 to 1: far from a hinge, near the middle of a drawer."""
    if joint.turns:
        return float(_lever(joint, point) / _lever(joint, shape.corners).max())
    offset = point - (shape.corners.min(axis=(0, 1)) + shape.corners.max(axis=(0, 1))) / 2.0
    across = offset - (offset @ joint.axis) * joint.axis
    return float(1.0 / (1.0 + np.linalg.norm(across) / np.ptp(shape.corners, axis=(0, 1)).max()))


def _subset(shape: _Shape, chosen: IntArray) -> _Shape:
    return _Shape(
        shape.faces[chosen], shape.welded[chosen], shape.corners[chosen], shape.normals[chosen], shape.areas[chosen]
    )


def _component_labels(faces: IntArray) -> IntArray:
    """Component of each face, connected by shared vertices."""
    used, compact = np.unique(faces, return_inverse=True)
    corners = compact.reshape(-1, 3)
    links = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]]])
    graph = coo_matrix((np.ones(len(links)), links.T), shape=(len(used), len(used)))
    return np.asarray(connected_components(graph, directed=False)[1][corners[:, 0]], dtype=np.int64)


def _groups(shape: _Shape, candidates: IntArray) -> list[IntArray]:
    """Candidates by component, components whose boxes touch taken together."""
    label = _component_labels(shape.welded[candidates])
    count = int(label.max()) + 1
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(low, label, shape.corners[candidates].min(axis=1) - TOUCH_M / 2.0)
    np.maximum.at(high, label, shape.corners[candidates].max(axis=1) + TOUCH_M / 2.0)
    touching = np.asarray(
        (low[:, None] <= high[None]).all(axis=2) & (high[:, None] >= low[None]).all(axis=2), dtype=np.int64
    )
    merged = connected_components(coo_matrix(touching), directed=False)[1][label]
    return [candidates[merged == value] for value in np.unique(merged)]


def _protruding_handle(
    joint: Joint, shape: _Shape, outward: FloatArray, height: FloatArray, chosen: IntArray
) -> Handle:
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
    return Handle(handle.point, handle.normal, handle.pull, np.sort(shape.faces[chosen]), handle.source)


def _far_handle(joint: Joint, shape: _Shape, source: str) -> Handle:
    """The middle of what is furthest from the axis."""
    lever = _lever(joint, shape.centers)
    reach = float(_lever(joint, shape.corners).max())
    edge = _lever(joint, shape.corners).max(axis=1) >= (1.0 - 0.02) * reach
    points = shape.corners[edge].reshape(-1, 3)
    points = points[_lever(joint, points) >= (1.0 - 0.02) * reach]
    if source == "rim":
        # Every point of a rim is as good: the one highest up, or first, keeps the choice stable.
        target = points[np.lexsort((points[:, 1], points[:, 0], -np.round(points[:, 2], 4)))[0]]
    else:
        target = (points.min(axis=0) + points.max(axis=0)) / 2.0
    radial = target - joint.origin - ((target - joint.origin) @ joint.axis) * joint.axis
    radial = radial / np.linalg.norm(radial)
    far = lever >= 0.5 * reach
    outer = far & (shape.normals @ radial > LOOKS_OUT)
    return _handle_near(joint, shape, outer if outer.any() else edge, target, radial, source)


def _mean(shape: _Shape, chosen: BoolArray) -> FloatArray:
    if not chosen.any():
        return shape.center
    return np.asarray(shape.areas[chosen] @ shape.centers[chosen] / shape.areas[chosen].sum())


def _handle_near(
    joint: Joint, shape: _Shape, target: BoolArray, point: FloatArray, outward: FloatArray, source: str
) -> Handle:
    """The point of the target faces nearest to ``point``, and what pulling there does."""
    faces = np.flatnonzero(target) if target.any() else np.arange(len(shape.faces))
    on_surface = closest_point(shape.corners[faces], np.tile(point, (len(faces), 1)))
    nearest = int(np.linalg.norm(on_surface - point, axis=1).argmin())
    contact, normal = on_surface[nearest], shape.normals[faces[nearest]]
    pull = _velocity(joint, contact)
    length = float(np.linalg.norm(pull))
    if not length > 0.0:
        pull, length = joint.axis, 1.0
    return Handle(contact, normal if normal @ outward >= 0.0 else -normal, pull / length, source=source)
