"""Parts that came without a word about them are told by their shape and how they move."""

import numpy as np
import pytest
from plain_solids import box_between as box
from plain_solids import parted

from asset_factory.factory.articulate.locate import located, sourced
from asset_factory.factory.articulate.proposal import Motion, Proposal
from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.part import OpensBy, PartKind, Proposer

X, Y, Z = np.eye(3)


def cupboard(part, joint):
    """A metre of body with one part that moves."""
    return parted({"base": [box((0, 0, 0), (1, 1, 1))], "x": [part]}, joint)


def hinge(axis, origin):
    return Joint("j", JointKind.REVOLUTE, 0, 1, axis, origin, 0.0, 1.5)


FRONT = box((0.1, -0.02, 0.2), (0.9, 0.0, 0.8))
KNOB = box((0.5, -0.02, 0.5), (0.52, 0.0, 0.52))
SLIDE = Joint("j", JointKind.PRISMATIC, 0, 1, -Y, (0, 0, 0), 0.0, 0.3)
TURN = Joint("j", JointKind.CONTINUOUS, 0, 1, -Y, (0.51, 0, 0.51), -np.pi, np.pi)


@pytest.mark.parametrize(
    ("part", "joint", "kind", "opens"),
    [
        (FRONT, hinge(-Z, (0.1, 0, 0.5)), PartKind.DOOR, OpensBy.LEFT),
        (FRONT, hinge(Z, (0.9, 0, 0.5)), PartKind.DOOR, OpensBy.RIGHT),
        (FRONT, hinge(X, (0.5, 0, 0.2)), PartKind.FLAP, OpensBy.BOTTOM),
        (FRONT, SLIDE, PartKind.DRAWER, OpensBy.OUT),
        (box((0, 0, 1), (1, 1, 1.02)), hinge(-X, (0.5, 1, 1)), PartKind.LID, OpensBy.TOP),
        (KNOB, TURN, PartKind.KNOB, None),
        (KNOB, SLIDE, PartKind.BUTTON, None),
        (KNOB, hinge(-Z, (0.5, 0, 0.5)), PartKind.LEVER, None),
        (box((0.4, -0.3, 0.4), (0.5, 0, 0.5)), hinge(-Z, (0.1, 0, 0.5)), PartKind.LEVER, None),
    ],
)
def test_a_part_is_told_by_its_shape_and_motion(part, joint, kind, opens):
    body, found = located(cupboard(part, joint)).parts
    assert body.kind is PartKind.BODY
    assert found.kind is kind
    assert (found.panel and found.panel.opens) == opens


def test_a_panel_ends_where_its_part_does():
    panel = located(cupboard(FRONT, SLIDE)).parts[1].panel
    np.testing.assert_allclose(panel.low, [0.1, 0.2])
    np.testing.assert_allclose(panel.high, [0.9, 0.8])
    assert panel.front == pytest.approx(-0.02)
    np.testing.assert_allclose(panel.outward, -Y)


def test_an_id_is_of_the_part_and_its_motion_alone():
    (_, part) = sourced(cupboard(FRONT, SLIDE), Proposer.ANNOTATION).parts
    (_, same) = sourced(cupboard(FRONT, SLIDE), Proposer.ANNOTATION).parts
    (_, other) = sourced(cupboard(FRONT, TURN), Proposer.ANNOTATION).parts
    assert part.source == same.source
    assert part.source.id != other.source.id
    faces = np.arange(24) >= 12
    motion = Motion(SLIDE.kind, SLIDE.axis, SLIDE.origin, 0.0, 0.3)
    said = Proposal("drawer", faces, motion, {"shown": 1.0}, proposer=Proposer.SIDES)
    assert said.source.id.startswith("sides-")
    assert said.source.signs == {"shown": 1.0}
