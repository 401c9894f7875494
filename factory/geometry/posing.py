"""The same object in another pose: joints opened or closed, or all turned about the vertical."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ..articulation import Articulation, Joint, JointKind, rotation_about
from ..mesh import FloatArray, IntArray, Mesh

UP = np.array([0.0, 0.0, 1.0])


def posed(articulation: Articulation, values: Mapping[str, float]) -> Articulation:
    """Return the object with its joints at other values, which become its new 0.

    Args:
        articulation: any.
        values: joint values [rad] or [m] by joint name; a joint not named stays at 0.

    Returns:
        Faces in the same order with the same parts; limits shifted, so that the same poses stay in
        reach.

    Raises:
        KeyError: a name is not a joint's.
        ValueError: a value outside its joint's limits.
    """
    for joint in articulation.joints:
        value = values.get(joint.name, 0.0)
        if not joint.lower <= value <= joint.upper:
            raise ValueError(
                f"joint {joint.name!r}: {value:g} is outside [{joint.lower:g}, {joint.upper:g}]"
            )
    values = articulation.completed(values)
    poses = articulation.poses(values)
    joints = tuple(_joint(each, poses, values.get(each.name, 0.0)) for each in articulation.joints)
    mesh = moved(articulation.mesh, face_parts(articulation), poses)
    return replace(articulation, mesh=mesh, joints=joints)


def closed(articulation: Articulation) -> Articulation:
    """Return the object with every joint closed; joints without ends stay where they are."""
    return posed(articulation, closed_values(articulation))


def closed_values(articulation: Articulation) -> dict[str, float]:
    """Return the value at which each joint is closed [rad] or [m]; of those that have ends."""
    ended = (joint for joint in articulation.joints if joint.kind is not JointKind.CONTINUOUS)
    return {joint.name: joint.lower for joint in ended}


def turned(articulation: Articulation, yaw: float) -> Articulation:
    """Return the whole object turned about the vertical through the origin by ``yaw`` [rad]."""
    return rotated(articulation, rotation_about(UP, yaw))


def rotated(articulation: Articulation, rotation: FloatArray) -> Articulation:
    """Return the whole object turned about the origin by ``rotation``, shape [3, 3]."""
    joints = tuple(
        replace(joint, axis=rotation @ joint.axis, origin=rotation @ joint.origin)
        for joint in articulation.joints
    )
    return replace(
        articulation,
        mesh=articulation.mesh.turned(rotation),
        parts=tuple(part.turned(rotation) for part in articulation.parts),
        joints=joints,
    )


def face_parts(articulation: Articulation) -> IntArray:
    """Return which part each face belongs to, shape [face_count]."""
    owner = np.zeros(len(articulation.mesh.faces), dtype=np.int64)
    for index, part in enumerate(articulation.parts):
        owner[part.faces] = index
    return owner


def _joint(joint: Joint, poses: FloatArray, value: float) -> Joint:
    carried = poses[joint.child]
    axis = carried[:3, :3] @ joint.axis
    shift = 0.0 if joint.kind is JointKind.CONTINUOUS else value
    return replace(
        joint,
        axis=axis / np.linalg.norm(axis),
        origin=carried[:3, :3] @ joint.origin + carried[:3, 3],
        lower=joint.lower - shift,
        upper=joint.upper - shift,
    )


def moved(mesh: Mesh, owner: IntArray, poses: FloatArray) -> Mesh:
    """Return every face moved with its part; vertices that several parts share are told apart.

    Args:
        mesh: object frame [m].
        owner: the part of every face, shape [face_count].
        poses: each part's motion, shape [part_count, 4, 4].
    """
    key = owner[:, None] * len(mesh.vertices) + mesh.faces
    used, faces = np.unique(key, return_inverse=True)
    part, vertex = np.divmod(used, len(mesh.vertices))
    turns = poses[:, :3, :3]
    vertices = np.einsum("nij,nj->ni", turns[part], mesh.vertices[vertex]) + poses[part, :3, 3]
    normals = mesh.corner_normals
    if normals is not None:
        normals = np.einsum("nij,nkj->nki", turns[owner], normals)
    return replace(mesh, vertices=vertices, faces=faces.reshape(-1, 3), corner_normals=normals)
