"""Default friction and damping: not at the slightest touch, and not beyond a robot."""

from dataclasses import replace

import numpy as np
import pytest
from export_samples import box, boxes_asset, cabinet

from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.asset import Inertial
from asset_factory.factory.export.links import safe_tensor
from asset_factory.factory.export.resistance import GRAVITY, joint_resistances, resistance_notes


def one_joint(joint, child_center=(0.0, 0.0, 2.0)):
    return boxes_asset([box([0, 0, 0], [1, 1, 1]), box(child_center, [0.4, 0.02, 0.6])], (joint,))


def hinge(**stated):
    return Joint("j", JointKind.REVOLUTE, 0, 1, [0, 0, 1], [0, 0, 2], 0, 1, **stated)


def slide(upper=0.3, **stated):
    return Joint("j", JointKind.PRISMATIC, 0, 1, [0, 1, 0], [0, 0, 2], 0, upper, **stated)


def resisted(asset):
    """What resists the asset's only joint, and what is told of it."""
    (resistance,) = resistances = joint_resistances(asset)
    return resistance, "".join(resistance_notes(asset, resistances))


def test_what_the_articulation_states_wins_and_a_fixed_joint_resists_nothing():
    resistance, note = resisted(one_joint(hinge(damping=0.25, friction=0.0)))
    assert (resistance.damping, resistance.friction, note) == (0.25, 0.0, "")
    fixed = Joint("j", JointKind.FIXED, 0, 1, [0, 0, 1], [0, 0, 2])
    assert resisted(one_joint(fixed))[0].friction == 0.0


def test_damping_that_explicit_engines_cannot_bear_is_lowered_and_told():
    resistance, note = resisted(one_joint(hinge(damping=500.0)))
    # Explicit integration keeps 1 - c dt / I of the speed each step: it must neither overshoot nor
    # explode.
    assert resistance.damping / 240.0 / resistance.inertia == pytest.approx(0.5)
    assert "'j': damping 500" in note


def test_friction_that_stops_all_that_bullet_can_turn_is_lowered_and_told():
    asset = one_joint(hinge(friction=0.01))
    flap = Inertial(0.005, np.array([0.0, 0.0, 2.0]), np.eye(3) * 2e-7)
    light = replace(asset, bodies=(asset.bodies[0], replace(asset.bodies[1], inertial=flap)))
    resistance, note = resisted(light)
    # In one step it takes half of the 100 rad/s that Bullet allows.
    assert resistance.friction / resistance.inertia / 240.0 == pytest.approx(50.0)
    assert "friction 0.01" in note


def test_friction_beyond_reason_counts_as_not_stated_and_is_told():
    resistance, note = resisted(one_joint(slide(friction=1e4)))
    assert 1.0 <= resistance.friction <= 5.0
    assert "friction 1e+04" in note


def test_damping_never_takes_more_than_an_arm_to_open_in_three_seconds():
    resistance, _ = resisted(one_joint(slide(6.0, damping=200.0)))
    assert resistance.damping * 6.0 / 3.0 == pytest.approx(30.0)


def test_a_door_needs_a_newton_or_so_at_its_rim():
    door, drawer = resistances = joint_resistances(cabinet())
    assert 0.5 <= door.friction / 0.56 <= 3.0
    assert 1.0 <= drawer.friction <= 5.0
    assert resistance_notes(cabinet(), resistances) == ()


def test_damping_is_inertia_over_half_a_second_by_the_parallel_axis_theorem():
    joint = Joint("j", JointKind.REVOLUTE, 0, 1, [0, 0, 1], [-0.2, 0.0, 2.0], 0, 1)
    resistance, _ = resisted(one_joint(joint))
    inertia = 2.0 / 12.0 * (0.4**2 + 0.02**2) + 2.0 * 0.2**2
    assert resistance.damping == pytest.approx(inertia / 0.5)
    assert resistance.armature == pytest.approx(0.01 * inertia)


def test_a_door_that_gravity_would_open_is_held_closed_and_one_that_it_closes_is_not():
    hinge = Joint("j", JointKind.REVOLUTE, 0, 1, [1, 0, 0], [0.0, 0.0, 2.0], 0, 1.5)
    (resistance,) = joint_resistances(one_joint(hinge, child_center=(0.0, -0.5, 2.0)))
    assert resistance.friction == pytest.approx(1.2 * 2.0 * GRAVITY * 0.5)
    lift = Joint("j", JointKind.PRISMATIC, 0, 1, [0, 0, 1], [0.0, 0.0, 2.0], 0.0, 0.5)
    assert joint_resistances(one_joint(lift))[0].friction == 1.0


def weighing(asset, mass):
    """The asset with its last part so heavy [kg]."""
    body = asset.bodies[-1]
    ratio = mass / body.inertial.mass
    heavy = replace(body.inertial, mass=mass, tensor=ratio * body.inertial.tensor)
    return replace(asset, bodies=(*asset.bodies[:-1], replace(body, inertial=heavy)))


@pytest.mark.parametrize("mass", [0.1, 2.0, 9.6, 80.0])
@pytest.mark.parametrize("kind", [JointKind.PRISMATIC, JointKind.REVOLUTE])
def test_what_is_chosen_here_is_never_more_than_a_light_hand_pulls(mass, kind):
    """9.6 kg that slide down would be held by 113 N, which the validator refuses."""
    axis = [0, 0, -1] if kind is JointKind.PRISMATIC else [1, 0, 0]
    joint = Joint("j", kind, 0, 1, axis, [0.0, 0.0, 2.0], 0.0, 1.5)
    asset = weighing(one_joint(joint, child_center=(0.0, -1.0, 2.0)), mass)
    (resistance,) = joint_resistances(asset)
    lever = 1.0 if kind is JointKind.PRISMATIC else np.hypot(1.01, 0.3)
    assert resistance.friction / lever <= 20.0 + 1e-9
    assert resistance.damping * 1.5 / 3.0 / lever <= 20.0 + 1e-9
    load = mass * GRAVITY
    assert resistance.friction > load or load > 20.0 * lever


@pytest.mark.parametrize(("stated", "written"), [(0.0, 0.0), (25.0, 25.0), (100.0, 30.0)])
def test_what_is_stated_is_not_held_against_a_light_hand(stated, written):
    slide = Joint("j", JointKind.PRISMATIC, 0, 1, [0, 0, -1], [0, 0, 2], 0, 0.3, friction=stated)
    (resistance,) = joint_resistances(weighing(one_joint(slide), 9.6))
    assert resistance.friction == written


def test_carried_parts_are_the_whole_subtree():
    chain = tuple(
        Joint(f"j{i}", JointKind.REVOLUTE, parent, i, [0, 0, 1], [0, 0, i], 0, 1)
        for i, parent in ((1, 0), (2, 1), (3, 0), (4, 2))
    )
    asset = boxes_asset([box([0, 0, i], [0.5, 0.5, 0.5]) for i in range(5)], chain)
    assert asset.articulation.carried(1) == (1, 2, 4)
    assert asset.articulation.carried(3) == (3,)


def test_a_flat_plate_is_lifted_off_the_border_of_the_triangle_inequality():
    moments = np.linalg.eigvalsh(safe_tensor(Inertial(1.0, np.zeros(3), np.diag([1.0, 2.0, 3.0]))))
    assert moments[0] + moments[1] - moments[2] == pytest.approx(3e-6)
    solid = Inertial(1.0, np.zeros(3), np.eye(3))
    assert np.array_equal(safe_tensor(solid), solid.tensor)
