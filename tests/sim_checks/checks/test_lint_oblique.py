"""Hinges that are askew to the box that they turn."""

from dataclasses import replace

import numpy as np
import pytest
from box_world import body, described, joint, linted

from asset_factory.sim_checks.description import DescribedShape
from asset_factory.sim_checks.read.primitives import cylinder
from asset_factory.sim_checks.report import Severity


def door(degrees, kind="revolute", shape=None, knob=False):
    """A door 0.5 m wide, hinged at its edge, about an axis so far off the upright."""
    panel = body("door", [((0.25, 0.0, 0.0), (0.5, 0.02, 1.0))])
    if shape is not None:
        panel = replace(panel, visuals=(shape,), collisions=(shape,))
    links = [body("frame", [((-0.1, 0.0, 0.0), (0.1, 0.1, 1.0))]), panel]
    axis = (np.sin(np.radians(degrees)), 0.0, np.cos(np.radians(degrees)))
    joints = [joint("hinge", kind, "frame", "door", (0.0, 0.0, 0.0), axis, (0.0, 1.5))]
    if knob:
        links.append(body("knob", [((0.25, -0.3, 0.0), (0.9, 0.5, 1.5))]))
        turn = joint("turn", "revolute", "door", "knob", (0.4, -0.03, 0.0), (0, 1, 0), (0.0, 1.0))
        joints.append(turn)
    return described(links, joints)


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
    assert told == ([("hinge", Severity.ERROR, 3.0)] if angle else [])
    assert [item.value for item in found] == pytest.approx([angle] if angle else [])
