"""Objects whose parts hang on other parts, and parts that turn and slide."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...articulation import Articulation, Joint, JointKind, Part
from ...mesh import Mesh, concatenate

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Limb:
    """A part and how it moves relative to another; value 0 is the pose of its solids.

    Attributes:
        name: of the part; its joint is called ``<name>_joint``.
        solids: in the pose of value 0, object frame [m].
        kind: revolute, continuous or prismatic.
        axis: unit vector; positive values open. Turned parts slide along it too, see ``slide``.
        origin: a point on the axis [m].
        upper: largest value [rad] or [m]; not used for a continuous joint.
        lower: smallest value, 0 where value 0 is closed.
        parent: name of the part it hangs on; that one comes first.
        slide: how far the part also slides along its axis [m]; above 0, it hangs on a carrier
            without faces that turns, and slides in it.
    """

    name: str
    solids: tuple[Mesh, ...]
    kind: JointKind
    axis: Vector
    origin: Vector
    upper: float = 0.0
    lower: float = 0.0
    parent: str = "body"
    slide: float = 0.0


def hinge(
    name: str,
    solids: Sequence[Mesh],
    axis: Vector,
    origin: Vector,
    upper: float,
    lower: float = 0.0,
    parent: str = "body",
    slide: float = 0.0,
) -> Limb:
    """A part that turns between ``lower`` and ``upper`` [rad]; see :class:`Limb`."""
    return Limb(name, tuple(solids), JointKind.REVOLUTE, axis, origin, upper, lower, parent, slide)


def wheel(
    name: str,
    solids: Sequence[Mesh],
    axis: Vector,
    origin: Vector,
    parent: str = "body",
    slide: float = 0.0,
) -> Limb:
    """A part that turns without end; see :class:`Limb`."""
    return Limb(name, tuple(solids), JointKind.CONTINUOUS, axis, origin, parent=parent, slide=slide)


def slider(
    name: str, solids: Sequence[Mesh], axis: Vector, origin: Vector, upper: float, lower: float = 0.0,
    parent: str = "body",
) -> Limb:  # fmt: skip
    """A part that slides between ``lower`` and ``upper`` [m]; see :class:`Limb`."""
    return Limb(name, tuple(solids), JointKind.PRISMATIC, axis, origin, upper, lower, parent)


def tree(body: Sequence[Mesh], limbs: Sequence[Limb]) -> Articulation:
    """One articulation; the body is the root. The object comes to stand on z = 0, centred over the origin.

    Raises:
        KeyError: a limb hangs on a part that does not come before it.
    """
    groups = [body, *(limb.solids for limb in limbs)]
    mesh = concatenate([solid for group in groups for solid in group])
    low, high = mesh.bounds
    offset = -np.array([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]])
    mesh = Mesh(
        mesh.vertices + offset,
        mesh.faces,
        mesh.corner_uv,
        mesh.corner_normals,
        mesh.face_material,
        mesh.materials,
    )
    ends = np.cumsum([sum(len(solid.faces) for solid in group) for group in groups])
    parts, joints, index = [Part("body", np.arange(ends[0]))], [], {"body": 0}
    for number, limb in enumerate(limbs):
        parent, origin, axis = (
            index[limb.parent],
            np.array(limb.origin) + offset,
            np.array(limb.axis),
        )
        turn = (-np.pi, np.pi) if limb.kind is JointKind.CONTINUOUS else (limb.lower, limb.upper)
        joint = f"{limb.name}_joint"
        if limb.slide > 0.0:
            parts.append(Part(f"{limb.name}_carrier", np.zeros(0, dtype=np.int64)))
            joints.append(
                Joint(f"{joint}_turn", limb.kind, parent, len(parts) - 1, axis, origin, *turn)
            )
            joints.append(
                Joint(
                    joint,
                    JointKind.PRISMATIC,
                    len(parts) - 1,
                    len(parts),
                    axis,
                    origin,
                    0.0,
                    limb.slide,
                )
            )
        else:
            joints.append(Joint(joint, limb.kind, parent, len(parts), axis, origin, *turn))
        index[limb.name] = len(parts)
        parts.append(Part(limb.name, np.arange(ends[number], ends[number + 1])))
    return Articulation(mesh, tuple(parts), tuple(joints), "procedural")
