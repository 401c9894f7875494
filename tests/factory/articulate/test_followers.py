"""Joints that follow others in a file still do in the asset, closed and at rest together."""

from dataclasses import replace

import numpy as np
import pytest

from asset_factory.factory.articulate.annotated import annotated_articulator
from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.errors import InvalidArticulation
from asset_factory.factory.geometry.coupling import with_common_ranges
from asset_factory.factory.geometry.posing import closed
from asset_factory.factory.geometry.welding import welded
from asset_factory.factory.intake.load import load
from asset_factory.factory.manufacture.plan import Plan, as_planned
from asset_factory.sim_checks.description import Mimic


def shown(name, center):
    place = " ".join(map(str, center))
    shape = f'<origin xyz="{place}"/><geometry><box size="0.02 0.04 0.1"/></geometry>'
    return f'<link name="{name}"><visual>{shape}</visual></link>'


def follower(inside, leader='<limit lower="0" upper="0.04"/>', kind="prismatic"):
    """A palm with two fingers along y, the right one as is said, the left one leading."""
    links = [("palm", (0, 0, -0.1)), ("left", (0, 0.03, 0)), ("right", (0, -0.03, 0))]
    joints = "".join(
        f'<joint name="{child}" type="{each}"><parent link="palm"/><child link="{child}"/>'
        f'<axis xyz="0 1 0"/>{words}</joint>'
        for child, each, words in (("left", "prismatic", leader), ("right", kind, inside))
    )
    return f'<robot name="r">{"".join(shown(*each) for each in links)}{joints}</robot>'


def articulated(folder, text, height=None):
    path = folder / ("thing.urdf" if text.startswith("<robot") else "thing.xml")
    path.write_text(text)
    intake = load(path, IntakeConfig(height=height))
    return annotated_articulator(intake).articulate(intake.mesh)


def test_a_mirrored_finger_opens_with_the_other(tmp_path):
    """Its axis is turned round, so that both are closed at their lower limit."""
    mirrored = '<limit lower="-0.04" upper="0"/><mimic joint="left" multiplier="-1"/>'
    made = articulated(tmp_path, follower(mirrored))
    right = made.joint("right")
    assert right.mimic == Mimic("left", 1.0, 0.0)
    np.testing.assert_allclose(right.axis, [0, -1, 0])
    assert (right.lower, right.upper) == (0.0, 0.04)
    poses = made.poses({"left": 0.02})
    np.testing.assert_allclose(poses[:, :3, 3], [[0, 0, 0], [0, 0.02, 0], [0, -0.02, 0]])
    assert made.together(right, 0.03) == {"left": 0.03, "right": 0.03}


def test_an_offset_becomes_the_pose_and_scales_with_the_object(tmp_path):
    mimic = '<mimic joint="left" multiplier="2" offset="0.1"/>'
    text = follower(f'<limit lower="-1" upper="1"/>{mimic}')
    made = articulated(tmp_path, text)
    assert made.joint("right").mimic == Mimic("left", 2.0, 0.0)
    assert made.part_mesh(2).bounds[:, 1] == pytest.approx([0.05, 0.09])
    assert made.joint("right").upper == pytest.approx(0.08)
    assert any("follows 'left'; posed at 0.1 m" in note for note in made.notes)
    grown = articulated(tmp_path, text, height=2.0 * float(made.mesh.extents[2]))
    assert grown.joint("right").mimic == Mimic("left", 2.0, 0.0)
    assert grown.joint("right").upper == pytest.approx(0.16)


def test_a_turning_follower_without_limits_goes_as_far_as_its_leader(tmp_path):
    text = follower('<mimic joint="left" multiplier="10"/>', kind="continuous")
    made = articulated(tmp_path, text, height=0.4)
    right = made.joint("right")
    scale = made.joint("left").upper / 0.04
    assert right.kind is JointKind.REVOLUTE
    assert right.upper == pytest.approx(0.4)
    assert right.mimic is not None
    assert right.mimic.multiplier == pytest.approx(10.0 / scale)


def test_the_leader_stops_where_its_follower_must(tmp_path):
    made = articulated(tmp_path, follower('<limit lower="0" upper="0.01"/><mimic joint="left"/>'))
    assert made.joint("left").upper == pytest.approx(0.01)
    assert made.joint("right").upper == pytest.approx(0.01)


@pytest.mark.parametrize(
    "mimic",
    [
        'joint="nothing"',
        'joint="right"',
        'joint="left" multiplier="0"',
        'joint="left" offset="7"',
        'joint="left" multiplier="-1"',
    ],
)
def test_what_nothing_can_follow_moves_freely_and_a_note_says_so(tmp_path, mimic):
    made = articulated(tmp_path, follower(f'<limit lower="0" upper="1"/><mimic {mimic}/>'))
    assert made.joint("right").mimic is None
    assert made.joint("right").range == pytest.approx(1.0)
    assert any("'right' follows" in note and "moves freely" in note for note in made.notes)


def test_a_joint_equality_is_kept_about_its_references(tmp_path):
    pytest.importorskip("mujoco")
    body = (
        '<body name="{0}"><joint name="{0}" type="slide" axis="0 1 0" range="{1}" ref="{2}"/>'
        '<geom type="box" size="0.01 0.02 0.05" pos="0 {3} 0"/></body>'
    )
    bodies = body.format("left", "0.1 0.14", 0.1, 0.03) + body.format("right", "-1 1", 0, -0.03)
    made = articulated(
        tmp_path,
        f'<mujoco><compiler autolimits="true"/><worldbody>{bodies}</worldbody><equality>'
        '<joint joint1="right" joint2="left" polycoef="0 -1 0 0 0"/>'
        '<joint joint1="left" joint2="right" polycoef="0 1 1 0 0"/></equality></mujoco>',
    )
    assert made.joint("right").mimic == Mimic("left", 1.0, 0.0)
    np.testing.assert_allclose(made.joint("right").axis, [0, -1, 0])
    assert made.joint("right").upper == pytest.approx(0.04)


def coupled():
    joint = Joint("a", JointKind.PRISMATIC, 0, 1, [0, 1, 0], [0, 0, 0], 0.0, 0.4)
    led = replace(joint, name="b", child=2, upper=0.8, mimic=Mimic("a", 2.0))
    return joint, led, replace(led, name="c", child=3, upper=0.4, mimic=Mimic("b", 0.5))


def test_repairs_shorten_all_that_move_together_and_free_what_loses_its_leader(tmp_path):
    made = with_common_ranges([*coupled()[:2], replace(coupled()[2], upper=0.1)])
    assert [joint.upper for joint in made] == [0.1, 0.2, 0.1]
    text = follower('<limit lower="0" upper="0.04"/><mimic joint="left"/>')
    whole = articulated(tmp_path, text)
    assert as_planned(whole, Plan(upper={"right": 0.03})).joint("left").upper == 0.03
    assert as_planned(whole, Plan(frozen=frozenset({"left"}))).joint("right").mimic is None
    assert welded(whole, ["left"]).joint("right").mimic is None
    assert closed(whole).joint("right").mimic == Mimic("left", 1.0, 0.0)


def test_an_articulation_refuses_a_follower_of_nothing(tmp_path):
    whole = articulated(tmp_path, follower('<limit lower="0" upper="0.04"/>'))
    for mimic in (Mimic("none"), Mimic("left", -1.0), Mimic("left", 1.0, 0.1), Mimic("right")):
        joints = (whole.joints[0], replace(whole.joints[1], mimic=mimic))
        with pytest.raises(InvalidArticulation, match="'right': follows"):
            replace(whole, joints=joints)
