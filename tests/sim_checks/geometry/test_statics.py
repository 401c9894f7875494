"""The weight that a joint feels, in closed form."""

from dataclasses import replace

import numpy as np
import pytest
from box_world import body, described, joint, with_link
from hypothesis import given
from hypothesis import strategies as st

from asset_factory.sim_checks.geometry.kinematics import build_tree
from asset_factory.sim_checks.geometry.statics import gravity_load

WEIGHT = 2.0 * 9.81


def arm():
    """A slide along x, on it a hinge about y, 2 kg 0.5 m out along x from it, and 2 kg at 0."""
    links = [
        body("post", [((0.0, 0.0, 0.0), (0.1,) * 3)]),
        body("cart", [((0.0, 0.0, 0.0), (0.1,) * 3)]),
        body("arm", [((0.5, 0.0, 0.0), (0.1,) * 3)]),
    ]
    joints = [
        joint("slide", "prismatic", "post", "cart", (0, 0, 0), (1, 0, 0), (0.0, 1.0)),
        joint("swing", "revolute", "cart", "arm", (0, 0, 0), (0, 1, 0), (-3.0, 3.0)),
    ]
    return described(links, joints)


def load(description, name, **values):
    line = next(item for item in description.joints if item.name == name)
    return gravity_load(description, build_tree(description), line, values)


@given(angle=st.floats(-3.0, 3.0), along=st.floats(0.0, 1.0))
def test_a_hinge_feels_the_lever_of_what_it_moves(angle, along):
    # Turned about y by a positive angle, what lies along x goes down.
    felt = load(arm(), "swing", swing=angle, slide=along)
    assert felt == pytest.approx(WEIGHT * 0.5 * np.cos(angle), abs=1e-9)


def test_a_slide_feels_all_that_it_carries_by_its_slope():
    slope = np.array([0.6, 0.0, -0.8])

    def steeper(line):
        return replace(line, axis=slope) if line.name == "slide" else line

    tilted = replace(arm(), joints=tuple(steeper(line) for line in arm().joints))
    assert load(arm(), "slide") == pytest.approx(0.0)
    assert load(tilted, "slide", swing=1.0) == pytest.approx(2.0 * WEIGHT * 0.8)


def test_nobody_can_say_without_the_mass_of_what_moves():
    bare = with_link(arm(), "arm", inertia=None)
    assert load(bare, "swing") is None
    assert load(with_link(bare, "arm", collisions=(), visuals=()), "swing") == 0.0
