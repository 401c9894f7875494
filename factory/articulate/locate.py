"""What parts are that came without a word about it: their kind, and the panel that they close."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..articulation import Articulation, Joint, JointKind, Part
from ..geometry.triangles import doubled_normals
from ..mesh import FloatArray, Mesh
from ..part import OpensBy, Panel, PartKind, PartSource, Proposer
from ..views.raster import Side, side_facing
from .proposal import proposal_id

#: What is narrower than this share of the object's longest side is a button or a lever, no panel.
NARROWEST = 0.03
PANELS = (PartKind.DOOR, PartKind.DRAWER, PartKind.FLAP, PartKind.LID)


def located(articulation: Articulation) -> Articulation:
    """Return an articulation whose every part says what it is.

    Kinds and panels that its proposers knew stay; the others are worked out from the shape of a
    part and how it moves.
    """
    parts = [replace(articulation.parts[0], kind=PartKind.BODY)]
    for joint, part in zip(articulation.joints, articulation.parts[1:], strict=True):
        known = joint.movable and len(part.faces) > 0
        parts.append(_located(articulation.mesh, joint, part) if known else part)
    return replace(articulation, parts=tuple(parts))


def sourced(articulation: Articulation, proposer: Proposer) -> Articulation:
    """Return an articulation whose moving parts all come from one proposer."""
    parts = [articulation.parts[0]]
    for joint, part in zip(articulation.joints, articulation.parts[1:], strict=True):
        name = proposal_id(proposer, part.faces, [joint])
        parts.append(replace(part, source=PartSource(name, proposer, joint.confidence)))
    return replace(articulation, parts=tuple(parts))


def _located(mesh: Mesh, joint: Joint, part: Part) -> Part:
    if part.kind is not PartKind.PART and part.kind not in PANELS:
        return part
    points = mesh.vertices[np.unique(mesh.faces[part.faces])]
    panel = part.panel or _panel(mesh, joint, part, points)
    kind = part.kind
    if kind is PartKind.PART:
        kind = _small(mesh, joint, points) if panel is None else _kind_of(joint, panel)
    return replace(part, kind=kind, panel=panel)


def _panel(mesh: Mesh, joint: Joint, part: Part, points: FloatArray) -> Panel | None:
    """Return what a part closes, seen from the side that it opens to.

    ``None`` for small parts, and for hinged ones deeper than wide, as the levers of taps are.
    """
    if joint.kind is JointKind.CONTINUOUS:
        return None
    middle = (points.min(axis=0) + points.max(axis=0)) / 2.0
    outward = joint.velocity(middle) * (1.0 if joint.upper >= -joint.lower else -1.0)
    # The middle of a high lid swings back more than up.
    side = Side.TOP if part.kind is PartKind.LID else side_facing(outward)
    local = points @ side.frame.T
    low = local.min(axis=0)
    high = local.max(axis=0)
    sides = (high - low)[:2]
    deep = joint.turns and high[2] - low[2] > float(sides.max())
    if deep or float(sides.min()) < NARROWEST * float(mesh.extents.max()):
        return None
    opens = _edge(side, joint, low, high)
    return Panel(side.frame, low[:2], high[:2], _front(mesh, part, side), None, opens)


def _front(mesh: Mesh, part: Part, side: Side) -> float:
    """Return the depth of a part's face [m]: the median over the area that looks at the viewer."""
    corners = mesh.vertices[mesh.faces[part.faces]]
    normals = doubled_normals(corners)
    away = side.frame[2]
    shown = np.maximum(-normals @ away, 0.0)
    depth = corners.mean(axis=1) @ away
    if not shown.any():
        return float(depth.min())
    order = np.argsort(depth, kind="stable")
    half = np.searchsorted(np.cumsum(shown[order]), shown.sum() / 2.0)
    return float(depth[order][half])


def _edge(side: Side, joint: Joint, low: FloatArray, high: FloatArray) -> OpensBy:
    """Return the edge of a panel that its hinge is nearest to, or outwards."""
    if joint.kind is JointKind.PRISMATIC:
        return OpensBy.OUT
    axis = side.frame @ joint.axis
    across, up = (side.frame @ joint.origin)[:2]
    middle = (low + high) / 2.0
    if abs(axis[1]) >= abs(axis[0]):
        return OpensBy.LEFT if across < middle[0] else OpensBy.RIGHT
    return OpensBy.BOTTOM if up < middle[1] else OpensBy.TOP


def _kind_of(joint: Joint, panel: Panel) -> PartKind:
    """Return what a panel is, by the side that it closes and where it is hinged."""
    rises = float(panel.outward[2])
    if rises > 0.5:
        return PartKind.LID
    if rises < -0.5:
        return PartKind.PART
    if joint.kind is JointKind.PRISMATIC:
        return PartKind.DRAWER
    return PartKind.DOOR if panel.opens in (OpensBy.LEFT, OpensBy.RIGHT) else PartKind.FLAP


def _small(mesh: Mesh, joint: Joint, points: FloatArray) -> PartKind:
    """Return the kind of a small part: a button slides, a lever turns, a wheel is on the ground."""
    if joint.kind is JointKind.PRISMATIC:
        return PartKind.BUTTON
    if joint.kind is JointKind.REVOLUTE:
        return PartKind.LEVER
    height = float(np.ptp(points[:, 2]))
    level = abs(float(joint.axis[2])) < 0.5
    on_ground = points[:, 2].min() <= mesh.bounds[0, 2] + 0.1 * height
    return PartKind.WHEEL if level and on_ground else PartKind.KNOB
