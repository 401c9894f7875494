"""The weight that a joint feels, in closed form."""

import numpy as np
import pytest
from box_world import body, built, sliding, turning, with_joint, with_link
from hypothesis import given
from hypothesis import strategies as st

from asset_factory.sim_checks.geometry.kinematics import build_tree
from asset_factory.sim_checks.geometry.statics import gravity_load

WEIGHT = 2.0 * 9.81
SIZE = (0.1, 0.1, 0.1)
#: A slide along x, on it a hinge about y, 2 kg 0.5 m out along x from it, and 2 kg at 0.
ARM = built(
    sliding("cart", [((0.0, 0.0, 0.0), SIZE)], (1, 0, 0), 1.0),
    turning("arm", [((0.5, 0.0, 0.0), SIZE)], (0, 0, 0), (0, 1, 0), 3.0, "cart"),
    base=body("base", [((0.0, 0.0, 0.0), SIZE)]),
)


def load(description, name, **values):
    line = next(item for item in description.joints if item.name == name)
    return gravity_load(description, build_tree(description), line, values)


@given(angle=st.floats(-3.0, 3.0), along=st.floats(0.0, 1.0))
def test_a_hinge_feels_the_lever_of_what_it_moves(angle, along):
    # Turned about y by a positive angle, what lies along x goes down.
    felt = load(ARM, "arm", arm=angle, cart=along)
    assert felt == pytest.approx(WEIGHT * 0.5 * np.cos(angle), abs=1e-9)


def test_a_slide_feels_all_that_it_carries_by_its_slope():
    assert load(ARM, "cart") == pytest.approx(0.0)
    tilted = with_joint(ARM, "cart", axis=np.array([0.6, 0.0, -0.8]))
    assert load(tilted, "cart", arm=1.0) == pytest.approx(2.0 * WEIGHT * 0.8)


def test_nobody_can_say_without_the_mass_of_what_moves():
    bare = with_link(ARM, "arm", inertia=None)
    assert load(bare, "arm") is None
    assert load(with_link(bare, "arm", collisions=(), visuals=()), "arm") == 0.0
