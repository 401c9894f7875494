"""An object's known parts, as boxes on its sides: a first statement to correct."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from msgspec import structs

from ..articulate.stated.snapping import StatedFrame
from ..display.scene import SceneGraph, SceneJoint
from ..intake.stated import NAME, Box, Hinge, Stated, StatedKind, StatedPart
from ..mesh import FloatArray, Mesh
from ..part import PartKind
from ..views.raster import Side, side_facing

#: What a part is whose kind nobody said, by its joint.
_USUAL = {
    "prismatic": PartKind.DRAWER,
    "revolute": PartKind.DOOR,
    "continuous": PartKind.KNOB,
}
#: A lid over so much of the object, along x and y, is all above its seam.
_WHOLE = 0.7
#: Turn about an axis, hinged at an edge.
_HINGED = (PartKind.DOOR, PartKind.FLAP, PartKind.LID)
_ABOVE = {Hinge.TOP: Hinge.BACK, Hinge.BOTTOM: Hinge.FRONT}


def found_parts(mesh: Mesh, scene: SceneGraph, kinds: Mapping[str, PartKind]) -> Stated:
    """Return the moving parts of an object as somebody would state them.

    Args:
        mesh: that they are stated of, front -Y.
        scene: with its links, in the same frame.
        kinds: of links, where they are known.
    """
    boxes = _link_boxes(scene)
    carried = {joint.child: joint.parent for joint in scene.movable if joint.child in boxes}
    names = {link: name for link, name in enumerate(scene.links) if NAME.fullmatch(name)}
    parts = []
    for joint in scene.movable:
        if joint.child in boxes:
            kind = kinds.get(scene.links[joint.child], PartKind.PART)
            usual = _USUAL.get(joint.kind, PartKind.DOOR)
            part = _part(mesh, scene, joint, usual if kind is PartKind.PART else kind, boxes)
            name = names.get(joint.child) if joint.child in carried.values() else None
            parent = names.get(joint.parent) if joint.parent in carried else None
            parts.append(structs.replace(part, name=name, parent=parent))
    return Stated(parts=tuple(parts))


def _link_boxes(scene: SceneGraph) -> dict[int, FloatArray]:
    """Return the lowest and highest corner of each link that is seen, as drawn; shape [2, 3]."""
    poses = scene.poses({})
    corners: dict[int, list[FloatArray]] = {}
    for surface in scene.visuals:
        pose = poses[surface.link]
        points = surface.vertices @ pose[:3, :3].T + pose[:3, 3]
        if len(points):
            corners.setdefault(surface.link, []).extend((points.min(axis=0), points.max(axis=0)))
    return {
        link: np.stack([np.min(points, axis=0), np.max(points, axis=0)])
        for link, points in corners.items()
    }


def _part(
    mesh: Mesh,
    scene: SceneGraph,
    joint: SceneJoint,
    kind: PartKind,
    boxes: Mapping[int, FloatArray],
) -> StatedPart:
    """Return a part with its side, box and hinge."""
    pose = scene.poses({})[joint.child]
    axis = pose[:3, :3] @ joint.axis
    origin = pose[:3, 3]
    box = boxes[joint.child]
    covers = (box[1] - box[0])[:2] / np.maximum(mesh.extents[:2], 1e-9)
    if kind is PartKind.LID and covers.min() > _WHOLE:
        shares = _shares(mesh, Side.FRONT, box)
        away = (origin - box.mean(axis=0)) * np.array([1.0, 1.0, 0.0])
        behind = Hinge(str(side_facing(away)))
        return StatedPart(StatedKind(kind), Side.FRONT, (0.0, shares[1], 1.0, 1.0), behind)
    side = _side(mesh, box, joint, axis, kind)
    hinge = _hinge(side, box, axis, origin) if kind in _HINGED else None
    return StatedPart(StatedKind(kind), side, _shares(mesh, side, box), hinge)


def _side(mesh: Mesh, box: FloatArray, joint: SceneJoint, axis: FloatArray, kind: PartKind) -> Side:
    """Return the side on which a part is seen best: where it slides, looks, or is turned."""
    off = box.mean(axis=0) - mesh.bounds.mean(axis=0)
    direction = axis
    if not joint.slides:
        if kind in _HINGED:
            direction = np.eye(3)[int((box[1] - box[0]).argmin())]
        direction = -direction if direction @ off < 0.0 else direction
    side = side_facing(direction)
    return Side.FRONT if side is Side.BOTTOM else side


def _hinge(side: Side, box: FloatArray, axis: FloatArray, origin: FloatArray) -> Hinge | None:
    """Return the edge of a box that a joint's axis runs along; ``None`` if it pierces it."""
    right, up, away = np.abs(side.frame @ axis)
    if away > max(right, up):
        return None
    across, above, _ = side.frame @ (origin - box.mean(axis=0))
    if up > right:
        return Hinge.LEFT if across < 0.0 else Hinge.RIGHT
    edge = Hinge.BOTTOM if above < 0.0 else Hinge.TOP
    return _ABOVE[edge] if side is Side.TOP else edge


def _shares(mesh: Mesh, side: Side, box: FloatArray) -> Box:
    """Return a box in shares of a side's picture."""
    frame = StatedFrame.of(mesh, side)
    ends = box @ side.frame.T[:, :2]
    shares = (np.stack([ends.min(axis=0), ends.max(axis=0)]) - frame.low) / frame.size
    left, lower, right, upper = (round(float(x), 3) for x in np.clip(shares, 0.0, 1.0).ravel())
    # What is too thin to be seen is a line there still.
    return left, lower, max(right, min(left + 0.001, 1.0)), max(upper, min(lower + 0.001, 1.0))
