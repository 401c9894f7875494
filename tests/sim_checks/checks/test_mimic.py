"""Joints that follow other joints: read, judged and moved along."""

import numpy as np
import pytest
from box_world import built, linted, sliding, with_joint
from hypothesis import given
from hypothesis import strategies as st
from small_cabinet import write_urdf

from asset_factory.sim_checks.checks.agreement import pose_samples
from asset_factory.sim_checks.description import DescriptionError, Mimic
from asset_factory.sim_checks.geometry.kinematics import build_tree
from asset_factory.sim_checks.read.read import read_here

NAMES = ("a", "b", "c")
END = "/></joint>"


def three(**mimics):
    """A base with three slides along x, side by side along y, each with a range of 1 m."""
    return built(
        *(
            sliding(name, [((0, y, 0), (0.1, 0.1, 0.1))], (1, 0, 0), 1.0, mimic=mimics.get(name))
            for y, name in enumerate(NAMES)
        )
    )


def places(description, values):
    poses = build_tree(description).link_poses(values)
    return [float(poses[name][0, 3]) for name in NAMES]


@given(value=st.floats(0, 1), multiplier=st.floats(-3, 3), offset=st.floats(-1, 1))
def test_a_follower_goes_by_its_leader_and_a_chain_by_its_head(value, multiplier, offset):
    description = three(b=Mimic("a", multiplier, offset), c=Mimic("b", -2.0, 0.5))
    b = multiplier * value + offset
    assert places(description, {"a": value}) == pytest.approx([value, b, -2.0 * b + 0.5])


def test_a_follower_s_own_value_counts_where_it_is_given():
    assert places(three(b=Mimic("a", 2.0), c=Mimic("b")), {"a": 0.1, "b": 0.7}) == [0.1, 0.7, 0.7]


def test_only_free_joints_are_chosen_and_each_knows_who_follows_it():
    tree = build_tree(three(b=Mimic("a"), c=Mimic("b")))
    a, b, c = tree.moving
    assert tree.free == (a,)
    assert tree.followers(a) == (b, c)
    assert tree.followers(b) == (c,)
    assert tree.followers(c) == ()
    assert tree.completed({"a": 0.25}) == {"a": 0.25, "b": 0.25, "c": 0.25}


@pytest.mark.parametrize(
    ("mimic", "expected"),
    [
        (Mimic("a", 2.0), (0.0, 0.5)),
        (Mimic("a", -1.0, 1.0), (0.0, 1.0)),
        (Mimic("a", -2.0, 1.5), (0.25, 0.75)),
        (Mimic("a", 0.1), (0.0, 1.0)),
        (Mimic("a", 0.0, 0.5), (0.0, 1.0)),
        (Mimic("a", 1.0, 2.0), None),
        (Mimic("a", -1.0), None),
    ],
)
def test_a_leader_goes_as_far_as_its_followers_can(mimic, expected):
    found = build_tree(three(b=mimic)).ranges.get("a")
    assert found == (None if expected is None else pytest.approx(expected))


@pytest.mark.parametrize(
    "changes", [{"kind": "continuous", "lower": None, "upper": None}, {"lower": -10.0, "upper": 10}]
)
def test_a_follower_that_turns_far_enough_does_not_stop_its_leader(changes):
    turned = with_joint(three(b=Mimic("a", -1.0)), "b", **{"kind": "revolute", **changes})
    assert build_tree(turned).ranges.get("a") == (0.0, 1.0)
    assert linted(turned, "mimic") == []


def test_followers_that_agree_with_their_leader_but_not_with_each_other_hold_it_fast():
    description = three(b=Mimic("a", 1.0, 0.6), c=Mimic("a", 1.0, -0.6))
    assert build_tree(description).ranges.get("a") is None
    found = linted(description, "mimic")
    assert [(f.joint, str(f.severity), f.code) for f in found] == [
        (name, "error", "mimic_limits") for name in ("b", "c")
    ]
    assert "so none can" in found[0].message


@pytest.mark.parametrize(
    ("mimics", "faults"),
    [
        ({"b": Mimic("a", -1.0, 1.0)}, set()),
        ({"b": Mimic("a", 0.5), "c": Mimic("b", 2.0)}, set()),
        ({"b": Mimic("ghost")}, {("mimic_unknown", "error", None)}),
        ({"b": Mimic("b")}, {("mimic_unknown", "error", None)}),
        ({"b": Mimic("c"), "c": Mimic("b")}, {("mimic_unknown", "error", None)}),
        ({"b": Mimic("a", float("nan"))}, {("mimic_not_finite", "error", None)}),
        ({"b": Mimic("a", 1.5)}, {("mimic_limits", "warning", 0.5)}),
        ({"b": Mimic("a", 1.0, -0.2)}, {("mimic_limits", "warning", 0.2)}),
        ({"b": Mimic("a", 1.0, 1.5)}, {("mimic_limits", "error", 1.5)}),
        ({"b": Mimic("a", -1.0)}, {("mimic_limits", "error", 1.0)}),
    ],
)
def test_each_fault_of_a_follower_has_its_code(mimics, faults):
    findings = linted(three(**mimics), "mimic")
    assert {(f.code, str(f.severity), f.value) for f in findings} == faults
    assert [f.joint for f in findings[:1]] == ["b"] * len(faults)


def test_a_follower_of_nobody_moves_freely():
    assert places(three(b=Mimic("ghost", 1.0, 0.3), c=Mimic("c")), {"c": 0.5}) == [0.0, 0.0, 0.5]


@pytest.mark.parametrize(
    ("element", "mimic"),
    [
        ('<mimic joint="slide"/>', Mimic("slide", 1.0, 0.0)),
        ('<mimic joint="slide" multiplier="-5" offset="1"/>', Mimic("slide", -5.0, 1.0)),
    ],
)
def test_urdf_says_who_follows_whom(tmp_path, element, mimic):
    path = write_urdf(tmp_path, replace={END: f"/>{element}</joint>"})
    assert read_here(path).joints[-1].mimic == mimic


def test_a_mimic_without_a_joint_cannot_be_read(tmp_path):
    path = write_urdf(tmp_path, replace={END: '/><mimic multiplier="2"/></joint>'})
    with pytest.raises(DescriptionError, match="names no joint"):
        read_here(path)


MJCF = """<mujoco><option gravity="0 0 0"/><compiler angle="radian"/><worldbody>
  <body name="a"><geom size="0.1"/><joint name="lead" type="hinge" axis="0 0 1" ref="0.2"/></body>
  <body name="b" pos="1 0 0"><geom size="0.1"/>
    <joint name="led" type="slide" axis="0 0 1" ref="0.3"/></body></worldbody>
  <equality><joint joint1="led" joint2="lead" polycoef="0.1 -2 0 0 0"/></equality></mujoco>"""


def test_mjcf_s_equality_holds_where_mujoco_settles(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    path = tmp_path / "pair.xml"
    path.write_text(MJCF)
    description = read_here(path)
    (led,) = [item for item in description.joints if item.mimic is not None]
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    data.qpos[:] = (0.5, 0.0)
    for _ in range(2000):
        mujoco.mj_step(model, data)
    lead, slid = (float(value) for value in data.qpos)
    assert led.mimic.multiplier * lead + led.mimic.offset == pytest.approx(slid, abs=1e-4)
    assert build_tree(description).value_of("led", {"lead": lead}) == pytest.approx(slid, abs=1e-4)


def test_an_equality_that_is_off_or_locks_one_joint_is_no_leader(tmp_path):
    pytest.importorskip("mujoco")
    path = tmp_path / "pair.xml"
    for old, new in (('joint2="lead"', 'joint2="lead" active="false"'), ('joint2="lead"', "")):
        path.write_text(MJCF.replace(old, new))
        assert [item.mimic for item in read_here(path).joints] == [None, None]


def test_pose_samples_put_followers_where_their_leaders_take_them():
    for sample in pose_samples(three(b=Mimic("a", -1.0, 1.0))):
        assert set(sample) == set(NAMES)
        assert sample["b"] == pytest.approx(1.0 - sample["a"])
        assert np.isfinite(list(sample.values())).all()
