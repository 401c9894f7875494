"""Which proposals are copies of one another."""

from dataclasses import replace

import numpy as np
import pytest

from asset_factory.factory.articulate.auto.proposals import copies_of
from asset_factory.factory.articulate.proposal import Motion, Proposal
from asset_factory.factory.articulation import JointKind
from asset_factory.factory.mesh import Mesh, concatenate
from asset_factory.sim_checks.read.primitives import box

AHEAD = np.array([0.0, -1.0, 0.0])
KNOB = (0.04, 0.02, 0.04)


def proposed(sizes, **changes):
    """Boxes in a row, each a part that turns about the way ahead, the second as changed."""
    boxes = [box(np.array(size)) for size in sizes]
    meshes = [
        Mesh.from_triangles(np.add(points, [0.1 * column, 0.0, 0.0]), faces)
        for column, (points, faces) in enumerate(boxes)
    ]
    owner = np.repeat(np.arange(len(sizes)), [len(mesh.faces) for mesh in meshes])
    turns = [Motion.endless(AHEAD, np.array([0.1 * column, 0.0, 0.0])) for column in range(9)]
    turns[1] = replace(turns[1], **changes)
    found = [Proposal("knob", owner == column, turns[column]) for column in range(len(sizes))]
    return concatenate(meshes), found


@pytest.mark.parametrize(
    ("size", "changes", "copies"),
    [
        (KNOB, {}, True),
        ((0.0405, 0.02, 0.04), {}, True),
        (KNOB, {"axis": -AHEAD}, True),
        ((0.042, 0.02, 0.04), {}, False),
        ((0.02, 0.04, 0.04), {}, False),
        (KNOB, {"axis": np.array([1.0, 0.0, 0.0])}, False),
        (KNOB, {"kind": JointKind.PRISMATIC, "lower": 0.0, "upper": 0.01}, False),
    ],
)
def test_a_copy_is_as_large_and_moves_alike(size, changes, copies):
    found = copies_of(*proposed([KNOB, size], **changes))
    assert found == ([[0, 1], [0, 1]] if copies else [[0], [1]])


def test_a_whole_row_is_copies_and_nothing_has_none():
    mesh, found = proposed([KNOB] * 5)
    assert copies_of(mesh, found) == [[0, 1, 2, 3, 4]] * 5
    assert copies_of(mesh, []) == []
