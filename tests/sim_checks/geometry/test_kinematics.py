"""The judge's own forward kinematics."""

from dataclasses import replace

import numpy as np
import pytest
from box_world import body, described, joint
from hypothesis import given
from hypothesis import strategies as st

from asset_factory.sim_checks.geometry.kinematics import (
    NotATree,
    Poser,
    build_tree,
    rotation_about,
    sweep_range,
)

CUBE = [((0.0, 0.0, 0.0), (0.1, 0.1, 0.1))]


def arm():
    """Two links of 1 m in a plane, and a slide at the tip."""
    links = [body(name, CUBE) for name in ("base", "upper", "fore", "tip")]
    joints = [
        joint("wrist", "prismatic", "fore", "tip", (1, 0, 0), (1, 0, 0), (0.0, 0.5)),
        joint("shoulder", "revolute", "base", "upper", (0, 0, 0), (0, 0, 1), (-3.0, 3.0)),
        joint("elbow", "revolute", "upper", "fore", (1, 0, 0), (0, 0, 2), (-3.0, 3.0)),
    ]
    return build_tree(described(links, joints))


@given(a=st.floats(-3, 3), b=st.floats(-3, 3), d=st.floats(0, 0.5))
def test_a_planar_arm_reaches_where_trigonometry_says(a, b, d):
    tip = arm().link_poses({"shoulder": a, "elbow": b, "wrist": d})["tip"]
    expected = [np.cos(a) + (1 + d) * np.cos(a + b), np.sin(a) + (1 + d) * np.sin(a + b), 0.0]
    assert tip[:3, 3] == pytest.approx(expected, abs=1e-12)
    assert tip[:3, :3] == pytest.approx(rotation_about(np.array([0, 0, 1.0]), a + b), abs=1e-12)


VALUES = st.dictionaries(st.sampled_from(["shoulder", "elbow", "wrist"]), st.floats(-3, 3))


@given(st.lists(VALUES, min_size=2, max_size=5))
def test_posing_again_gives_the_digits_of_posing_for_the_first_time(samples):
    tree = arm()
    poser = Poser(tree)
    for values in samples:
        again = poser.link_poses(values)
        first = tree.link_poses(values)
        assert all(np.array_equal(again[name], first[name]) for name in first)


@pytest.mark.parametrize(
    ("links", "pairs", "message"),
    [
        ("ab", [], r"2 root links \('a', 'b'\)"),
        ("ab", [("a", "b"), ("b", "a")], "0 root links"),
        ("abc", [("a", "b"), ("a", "b")], "child of joints"),
        ("ab", [("a", "ghost")], "not there"),
        ("abc", [("b", "c"), ("c", "b")], "loop"),
    ],
)
def test_what_is_no_tree_is_refused(links, pairs, message):
    joints = [joint(f"{a}{b}", "fixed", a, b, (0, 0, 0), (1, 0, 0), None) for a, b in pairs]
    with pytest.raises(NotATree, match=message):
        build_tree(described([body(name, CUBE) for name in links], joints))


@pytest.mark.parametrize(
    ("changes", "swept"),
    [
        ({}, (0.0, 1.0)),
        ({"lower": 1.0, "upper": 0.0}, None),
        ({"upper": float("inf")}, None),
        ({"kind": "continuous", "lower": None, "upper": None}, (0.0, 2 * np.pi)),
        ({"kind": "prismatic", "lower": None, "upper": None}, None),
        ({"lower": -10.0, "upper": 10.0}, (-10.0, -10.0 + 2 * np.pi)),
    ],
)
def test_ranges_that_cannot_be_swept_are_none_and_a_turn_is_one_turn(changes, swept):
    line = joint("j", "revolute", "a", "b", (0, 0, 0), (0, 0, 1), (0.0, 1.0))
    assert sweep_range(replace(line, **changes)) == swept
