"""Hinges that are askew to the box that they turn."""

import numpy as np
import pytest
from box_world import body, built, linted, turning, with_joint, with_link

from asset_factory.sim_checks.description import DescribedShape
from asset_factory.sim_checks.read.primitives import cylinder
from asset_factory.sim_checks.report import Severity

FRAME = body("base", [((-0.1, 0.0, 0.0), (0.1, 0.1, 1.0))])


def door(degrees, kind="revolute", shape=None, knob=False):
    """A door 0.5 m wide, hinged at its edge, about an axis so far off the upright."""
    axis = (np.sin(np.radians(degrees)), 0.0, np.cos(np.radians(degrees)))
    parts = [turning("door", [((0.25, 0.0, 0.0), (0.5, 0.02, 1.0))], (0.0, 0.0, 0.0), axis, 1.5)]
    if knob:
        grip = [((0.65, -0.33, 0.0), (0.9, 0.5, 1.5))]
        parts.append(turning("knob", grip, (0.4, -0.03, 0.0), (0, 1, 0), 1.0, "door"))
    hung = with_joint(built(*parts, base=FRAME), "door", kind=kind)
    return hung if shape is None else with_link(hung, "door", visuals=(shape,), collisions=(shape,))


#: Flat ends look along y.
ROUND = DescribedShape("lid", "mesh", cylinder(0.3, 0.02)[0][:, [1, 2, 0]], cylinder(0.3, 0.02)[1])


@pytest.mark.parametrize(
    ("thing", "angle"),
    [
        (door(0.0), None),
        (door(2.9), None),
        (door(3.1), 3.1),
        (door(-10.0), 10.0),
        (door(10.0, kind="continuous"), 10.0),
        # Buttons and levers slide as they please.
        (door(10.0, kind="prismatic"), None),
        # What is round has no edges.
        (door(10.0, shape=ROUND), None),
        # The door is a box, whatever hangs on it.
        (door(10.0, knob=True), 10.0),
    ],
)
def test_a_hinge_askew_to_its_door_is_told(thing, angle):
    found = linted(thing, "axis_oblique")
    told = [(item.joint, item.severity, item.limit) for item in found]
    assert told == ([("door", Severity.ERROR, 3.0)] if angle else [])
    assert [item.value for item in found] == pytest.approx([angle] if angle else [])
