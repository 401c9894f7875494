"""Hinges whose parts stand open in the mesh: their lower limit is the closed pose."""

from dataclasses import replace

import numpy as np
import pytest
from modelled_furniture import METAL, board
from plain_solids import carcass, cylinder, parted
from target_worlds import world

from asset_factory.factory.articulate.closing import with_closed_hinges
from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.geometry.posing import posed
from asset_factory.factory.part import PartKind

HINGE = Joint("hinge", JointKind.REVOLUTE, 0, 1, [0, 0, -1], [0.0, 0.0, 0.4], 0.0, np.pi)


def cupboard(handle=0.05, kind=PartKind.DOOR):
    """A case that is open in front, with a closed door hinged at its left."""
    door = [
        board((0.0, -0.02, 0.0), (0.6, -0.001, 0.8)),
        board((0.54, -0.02 - handle, 0.3), (0.56, -0.02, 0.5), METAL),
    ]
    whole = parted({"body": carcass(0.6, 0.4, 0.8), "door": door}, HINGE)
    return replace(whole, parts=(whole.parts[0], replace(whole.parts[1], kind=kind)))


def guessed(opened, whole):
    """The object standing open, and a joint that a proposer sees from there on."""
    standing = posed(whole, {"hinge": opened})
    return replace(standing, joints=(replace(standing.joints[0], lower=0.0, upper=np.pi / 2),))


@pytest.mark.parametrize("degrees", [40, 90, 120, 175])
def test_a_door_that_stands_open_closes(degrees):
    opened = np.radians(degrees)
    found = with_closed_hinges(guessed(opened, cupboard()))
    (joint,) = found.joints
    assert found.notes[-1].startswith(f"'door' stands open by {degrees} degrees")
    assert joint.lower == pytest.approx(-opened, abs=1e-6)
    assert joint.range == pytest.approx(max(np.pi / 2, opened))


def test_a_hinge_seen_the_wrong_way_round_is_turned():
    seen = guessed(2.0, cupboard())
    backward = replace(seen, joints=(replace(seen.joints[0], axis=[0, 0, 1]),))
    (joint,) = with_closed_hinges(backward).joints
    np.testing.assert_allclose(joint.axis, [0, 0, -1])
    assert joint.lower == pytest.approx(-2.0, abs=1e-6)


COLUMN = cylinder(2, (0.0, 0.0), 0.04, (0.0, 0.3), METAL)
ARM = board((0.0, -0.02, 0.301), (0.4, 0.02, 0.32))
TURN = Joint("turn", JointKind.REVOLUTE, 0, 1, [0, -1, 0], [0.0, 0.0, 0.31], 0.0, 1.5)


@pytest.mark.parametrize(
    "whole",
    [
        cupboard(),
        cupboard(handle=0.3),
        guessed(1.0, cupboard(kind=PartKind.KNOB)),
        world([ARM], TURN, [COLUMN]),
    ],
    ids=["closed", "closed, with a long handle", "closing nothing", "smaller if it stood upright"],
)
def test_what_does_not_stand_open_stays_as_it_is_drawn(whole):
    assert with_closed_hinges(whole).joints == whole.joints
