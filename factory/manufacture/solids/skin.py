"""Which parts are patches of one surface rather than bodies of their own."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...geometry.crossings import BoolArray
from ...geometry.edges import shared_edges
from ...geometry.posing import face_parts
from ...mesh import FloatArray, IntArray, Mesh
from .plates import bare_fronts, plates

#: A part is a patch of a skin where it shares so much of its border with other parts, of the
#: diagonal of its own box. Bodies of their own share none: every edge of theirs has two own faces.
SHARED_BORDER = 0.25


def skin_parts(articulation: Articulation) -> tuple[int, ...]:
    """Return the moved parts that are open patches of the surface they share with others.

    The figure: length of the edges that a part shares with another one and with no second face of
    its own, over the diagonal of the part's box. Half a door's outline is more than a diagonal;
    parts that are closed, however closely they touch, and sheets that merely lie on others, have 0.
    """
    part = face_parts(articulation)
    shared = _shared_border(articulation.mesh, part, len(articulation.parts))
    return tuple(
        joint.child
        for joint in articulation.joints
        if len(articulation.parts[joint.child].faces)
        and shared[joint.child] > SHARED_BORDER * articulation.part_mesh(joint.child).diagonal
    )


def parts_to_build(articulation: Articulation, fronts: bool = False) -> tuple[int, ...]:
    """Return the moved parts that get a body by construction: patches of a skin, and bare fronts.

    Args:
        articulation: parts and joints.
        fronts: build every thin front, bare or not.
    """
    found = plates(articulation) if fronts else bare_fronts(articulation)
    return tuple(sorted({*skin_parts(articulation), *found}))


def border(mesh: Mesh, part: IntArray) -> tuple[IntArray, IntArray]:
    """Return the edges between exactly two faces of different parts.

    Returns:
        Vertices, shape [n, 2], and the two parts, shape [n, 2].
    """
    shared = shared_edges(mesh.faces)
    both = part[shared.faces]
    apart: BoolArray = both[:, 0] != both[:, 1]
    return shared.vertices[apart], both[apart]


def _shared_border(mesh: Mesh, part: IntArray, count: int) -> FloatArray:
    edges, both = border(mesh, part)
    length = np.linalg.norm(mesh.vertices[edges[:, 0]] - mesh.vertices[edges[:, 1]], axis=1)
    shared = np.zeros(count)
    for column in range(2):
        np.add.at(shared, both[:, column], length)
    return shared
