"""A body and what moves on it, put together into one articulation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...articulation import Articulation, Joint, JointKind, Part
from ...mesh import FloatArray, IntArray, Material, Mesh
from .pieces import Block, Form, Piece
from .solids import Span

#: Corners of a block: which end of each span, shape [8, 3]; and its faces, outward, shape [12, 3].
_CORNERS: IntArray = np.array(
    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
)
_FACES: IntArray = np.array([
    (0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), (0, 1, 5), (0, 5, 4),
    (1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6), (3, 0, 4), (3, 4, 7),
])  # fmt: skip


@dataclass(frozen=True)
class Limb:
    """A part and the joint that moves it; closed at joint value 0, open at ``upper``.

    Attributes:
        name: of the part; its joint is called ``<name>_joint``.
        pieces: in the closed pose [m].
        kind: revolute or prismatic.
        axis: unit vector; positive values open.
        origin: a point on the axis [m].
        upper: fully open [rad] or [m].
        parent: name of the part that it hangs on.
    """

    name: str
    pieces: tuple[Piece, ...]
    kind: JointKind
    axis: tuple[float, float, float]
    origin: tuple[float, float, float]
    upper: float
    parent: str = "body"


def built(body: Sequence[Piece], limbs: Sequence[Limb]) -> Articulation:
    """One articulation: the body is its root; centred over the origin and standing on z = 0.

    Args:
        body: pieces of the part ``body`` [m].
        limbs: parents before children.
    """
    names = ["body", *(limb.name for limb in limbs)]
    groups: list[Sequence[Piece]] = [body, *(limb.pieces for limb in limbs)]
    vertices, faces, materials, face_material, owner = _joined(groups)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    shift = np.array([-(low[0] + high[0]) / 2, -(low[1] + high[1]) / 2, -low[2]])
    mesh = Mesh(vertices + shift, faces, None, None, face_material, materials)
    order = np.argsort(owner, kind="stable")
    ends = np.searchsorted(owner[order], np.arange(len(names) + 1))
    parts = [Part(name, order[ends[i] : ends[i + 1]]) for i, name in enumerate(names)]
    joints = [
        Joint(
            f"{limb.name}_joint",
            limb.kind,
            names.index(limb.parent),
            i + 1,
            np.array(limb.axis, dtype=np.float64),
            np.array(limb.origin) + shift,
            0.0,
            limb.upper,
        )
        for i, limb in enumerate(limbs)
    ]
    return Articulation(mesh, tuple(parts), tuple(joints), "procedural")


def _joined(
    groups: Sequence[Sequence[Piece]],
) -> tuple[FloatArray, IntArray, tuple[Material, ...], IntArray, IntArray]:
    """Vertices, faces, materials, and per face its material and its group; all blocks first."""
    place: dict[str, int] = {}
    materials: list[Material] = []
    spans: list[tuple[float, ...]] = []
    look: list[int] = []
    owner: list[int] = []
    forms: list[tuple[Form, int, int]] = []
    for group, pieces in enumerate(groups):
        for piece in pieces:
            name = piece.material.name
            if name not in place:
                place[name] = len(materials)
                materials.append(piece.material)
            if isinstance(piece, Block):
                spans.append((*piece.x, *piece.y, *piece.z))
                look.append(place[name])
                owner.append(group)
            else:
                forms.append((piece, place[name], group))
    count = len(spans)
    ends = np.array(spans, dtype=np.float64).reshape(count, 3, 2)
    vertices = [ends[:, np.arange(3), _CORNERS].reshape(-1, 3)]
    faces = [(np.arange(count)[:, None, None] * 8 + _FACES).reshape(-1, 3)]
    offset = 8 * count
    for form, _, _ in forms:
        vertices.append(form.vertices)
        faces.append(form.faces + offset)
        offset += len(form.vertices)
    sizes = np.array([12] * count + [len(form.faces) for form, _, _ in forms])
    face_material = np.repeat([*look, *(m for _, m, _ in forms)], sizes)
    return (
        np.concatenate(vertices),
        np.concatenate(faces),
        tuple(materials),
        face_material,
        np.repeat([*owner, *(g for _, _, g in forms)], sizes),
    )


def swinging(
    name: str,
    pieces: Sequence[Piece],
    x: Span,
    z: Span,
    depth: float,
    side: str,
    upper: float,
    parent: str = "body",
) -> Limb:
    """A door or flap that turns about one of its edges and opens towards -Y.

    Args:
        name: of the part.
        pieces: closed pose.
        x: span of the panel [m].
        z: span of the panel [m].
        depth: y of the axis [m].
        side: edge of the hinge, seen from the front: ``left``, ``right``, ``top`` or ``bottom``.
        upper: fully open [rad].
        parent: name of the part that it hangs on.
    """
    middle = ((x[0] + x[1]) / 2, (z[0] + z[1]) / 2)
    axis, origin = {
        "left": ((0.0, 0.0, -1.0), (x[0], depth, middle[1])),
        "right": ((0.0, 0.0, 1.0), (x[1], depth, middle[1])),
        "bottom": ((1.0, 0.0, 0.0), (middle[0], depth, z[0])),
        "top": ((-1.0, 0.0, 0.0), (middle[0], depth, z[1])),
    }[side]
    return Limb(name, tuple(pieces), JointKind.REVOLUTE, axis, origin, upper, parent)


def sliding(
    name: str,
    pieces: Sequence[Piece],
    axis: tuple[float, float, float],
    origin: tuple[float, float, float],
    upper: float,
    parent: str = "body",
) -> Limb:
    """A part that slides along ``axis`` by up to ``upper`` [m]."""
    return Limb(name, tuple(pieces), JointKind.PRISMATIC, axis, origin, upper, parent)


def turning(
    name: str,
    pieces: Sequence[Piece],
    axis: tuple[float, float, float],
    origin: tuple[float, float, float],
    upper: float,
    parent: str = "body",
) -> Limb:
    """A part that turns about ``axis`` by up to ``upper`` [rad]."""
    return Limb(name, tuple(pieces), JointKind.REVOLUTE, axis, origin, upper, parent)
