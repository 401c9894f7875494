"""Doors open outwards on hinges, drawers slide out, knobs turn; what is alone stays put."""

from dataclasses import replace

import numpy as np
import pytest
from evidence_worlds import apart, chest, cupboard, oven, partition

from asset_factory.factory.articulate.evidence import NOTHING, Guess, Partition, best_motion
from asset_factory.factory.articulate.evidence.body import body_of
from asset_factory.factory.articulate.evidence.candidates import find_candidates
from asset_factory.factory.articulate.evidence.extent import (
    FARTHEST_SLIDE,
    USUAL_SLIDE,
    stands_out_by,
)
from asset_factory.factory.articulate.evidence.numbers import NAMES, measure
from asset_factory.factory.articulate.evidence.rating import load_rating
from asset_factory.factory.articulation import JointKind, rotation_about
from asset_factory.factory.geometry.posing import posed
from asset_factory.factory.mesh import Mesh, concatenate

UP = np.array([0.0, 0.0, 1.0])
OUT = np.array([0.0, -1.0, 0.0])
WORLDS = {"left": cupboard("left"), "right": cupboard("right"), "drawer": chest(), "oven": oven()}


def _rough(joint, rotation, turns=0.7):
    """The truth, 12 degrees, 8 cm and a sign off."""
    off = rotation_about(np.eye(3)[0] if abs(joint.axis[0]) < 0.5 else UP, np.radians(12.0))
    return Guess(
        turns=turns if joint.turns else 1.0 - turns,
        direction=-(rotation @ off @ joint.axis),
        point=rotation @ (joint.origin + np.array([0.05, 0.05, 0.04])),
    )


@pytest.mark.parametrize("guessed", [True, False], ids=["guessed", "blind"])
@pytest.mark.parametrize("yaw", [0.0, 0.9])
@pytest.mark.parametrize("name", ["left", "right", "drawer", "oven"])
def test_a_front_opens_as_it_should(name, yaw, guessed):
    world = WORLDS[name]
    rotation = rotation_about(UP, yaw)
    joint = world.joints[0]
    guess = _rough(joint, rotation) if guessed else NOTHING
    found = best_motion(partition(world, yaw), 1, guess)
    assert found.motion.kind is joint.kind
    assert found.motion.axis @ (rotation @ joint.axis) > 0.999
    if joint.turns:
        assert apart(found.motion.origin, found.motion.axis, rotation @ joint.origin) < 0.02
    assert found.motion.lower == 0.0
    assert 0.5 * joint.upper < found.motion.upper < 1.5 * joint.upper
    assert found.confidence > 0.5


def test_a_knob_turns_without_end():
    joint = WORLDS["oven"].joints[1]
    round_and_round = replace(_rough(joint, np.eye(3)), upper=2.0 * np.pi)
    found = best_motion(partition(WORLDS["oven"]), 2, round_and_round)
    assert found.motion.kind is JointKind.CONTINUOUS
    assert abs(found.motion.axis @ joint.axis) > 0.999
    assert apart(found.motion.origin, found.motion.axis, joint.origin) < 1e-3


def test_size_does_not_matter():
    small = partition(WORLDS["drawer"])
    tenfold = replace(small.mesh, vertices=small.mesh.vertices * 10.0)
    large = Partition(tenfold, small.face_part, small.parents)
    one = best_motion(small, 1)
    ten = best_motion(large, 1)
    assert np.allclose(one.motion.axis, ten.motion.axis)
    assert ten.motion.upper == pytest.approx(10.0 * one.motion.upper, rel=1e-6)


def test_evidence_is_one_named_finite_number_each():
    body = body_of(partition(WORLDS["oven"]), 1)
    numbers = measure(body, find_candidates(body, NOTHING), NOTHING)
    assert numbers.shape[1] == len(NAMES)
    assert np.isfinite(numbers).all()
    assert np.abs(numbers).max() < 6.0


def test_the_root_and_empty_parts_do_not_move():
    whole = partition(WORLDS["left"])
    with_empty = Partition(whole.mesh, whole.face_part, np.array([-1, 0, 0]))
    assert best_motion(with_empty, 0).motion is None
    assert best_motion(with_empty, 2).motion is None


def test_what_hangs_on_a_door_comes_along():
    whole = partition(WORLDS["left"])
    handle = np.flatnonzero(whole.face_part == 1)[12:]
    labels = whole.face_part.copy()
    labels[handle] = 2
    split = Partition(whole.mesh, labels, np.array([-1, 0, 1]))
    assert split.subtree(1).tolist() == [1, 2]
    assert best_motion(split, 1).motion.axis @ WORLDS["left"].joints[0].axis > 0.999


def test_partitions_that_do_not_fit_are_refused():
    whole = partition(WORLDS["left"])
    with pytest.raises(ValueError, match="labels for"):
        Partition(whole.mesh, whole.face_part[:-1], whole.parents)
    with pytest.raises(ValueError, match="outside"):
        Partition(whole.mesh, whole.face_part + 1, whole.parents)


@pytest.mark.parametrize("guided", [True, False])
def test_confidence_grows_with_belief(guided):
    rating = load_rating(guided)
    values = [rating.confidence(belief) for belief in (0.0, 0.1, 0.5, 0.9, 1.0)]
    assert values == sorted(values)
    assert 0.0 <= values[0] < values[-1] <= 1.0


@pytest.mark.parametrize("seed", range(8))
def test_soups_of_triangles_break_nothing(seed):
    rng = np.random.default_rng(seed)
    count = int(rng.integers(3, 30))
    corners = rng.normal(size=(3 * count, 3)) * 10.0 ** int(rng.integers(-4, 3))
    if seed % 2:
        corners[:, 2] = 0.0
    if seed % 3 == 0:
        corners[:, 1] = 0.0
    corners[:3] = corners[0]
    mesh = Mesh.from_triangles(corners, np.arange(3 * count).reshape(-1, 3))
    soup = Partition(mesh, rng.integers(0, 3, count), np.array([-1, 0, 1]))
    for part in range(3):
        for guess in (NOTHING, Guess(0.3, rng.normal(size=3), corners[4], 1.0)):
            found = best_motion(soup, part, guess)
            assert np.isfinite(found.confidence), "the numbers are"
            if found.motion is not None:
                assert np.linalg.norm(found.motion.axis) == pytest.approx(1.0)
                assert found.motion.lower <= 0.0 < found.motion.upper


@pytest.mark.parametrize(
    ("name", "turns", "said", "upper"),
    [
        ("left", 0.9, 2.5, 2.5), ("left", 0.9, 1.4, 1.4), ("left", 0.9, 0.7, 0.7),
        ("left", 0.9, None, np.pi / 2.0), ("drawer", 0.1, 0.3, 0.3),
        ("drawer", 0.1, None, USUAL_SLIDE * 0.493), ("drawer", 0.1, 9.0, FARTHEST_SLIDE * 0.493),
    ],
)  # fmt: skip
def test_a_part_goes_as_far_as_somebody_says_or_as_is_usual(name, turns, said, upper):
    joint = WORLDS[name].joints[0]
    guess = Guess(turns, joint.axis, joint.origin, said)
    found = best_motion(partition(WORLDS[name]), 1, guess)
    assert found.motion.upper == pytest.approx(upper, rel=0.03)


def test_a_limit_of_the_other_kind_is_not_believed():
    joint = WORLDS["drawer"].joints[0]
    found = best_motion(partition(WORLDS["drawer"]), 1, Guess(0.6, joint.axis, joint.origin, 1.5))
    assert found.motion.kind is JointKind.PRISMATIC
    assert found.motion.upper < 0.5


def test_what_is_blocked_by_its_holder_goes_no_further():
    closed = partition(WORLDS["drawer"])
    corners = [[x, -0.25, z] for x, z in ((-0.4, -0.1), (0.4, -0.1), (0.4, 0.4), (-0.4, 0.4))]
    wall = Mesh.from_triangles(corners, [[0, 1, 2], [0, 2, 3]])
    labels = np.concatenate([closed.face_part, [0, 0]])
    walled = Partition(concatenate([closed.mesh, wall]), labels, closed.parents)
    joint = WORLDS["drawer"].joints[0]
    found = best_motion(walled, 1, Guess(0.05, joint.axis, joint.origin))
    assert found.motion.kind is JointKind.PRISMATIC
    assert found.motion.upper < 0.27


#: Of the chest's front, which stands before its carcass [m].
THICK = 0.021


def drawn(by):
    """The chest with its drawer pulled out [m]."""
    drawer = WORLDS["drawer"]
    return partition(posed(drawer, {drawer.joints[0].name: by}))


@pytest.mark.parametrize("by", [0.15, 0.25, 0.35])
def test_an_open_drawer_goes_back_as_far_as_it_stands_out(by):
    closed = best_motion(drawn(0.0), 1, Guess(0.0, OUT)).motion
    found = best_motion(drawn(by), 1, Guess(0.0, OUT)).motion
    assert closed.lower == 0.0
    assert found.axis @ OUT > 0.999
    assert -found.lower == pytest.approx(by + THICK, abs=0.01)
    assert found.upper - found.lower == pytest.approx(closed.upper, rel=0.25)


def test_standing_out_is_measured_from_the_holders_mouth():
    for by in (0.0, 0.1, 0.3):
        assert stands_out_by(body_of(drawn(by), 1), OUT) == pytest.approx(by + THICK, abs=0.01)
    assert stands_out_by(body_of(drawn(0.3), 1), -OUT) == 0.0


def test_what_lies_outside_its_holder_or_goes_up_does_not_stand_open():
    assert stands_out_by(body_of(partition(WORLDS["left"]), 1), OUT) == 0.0
    assert stands_out_by(body_of(partition(WORLDS["oven"]), 2), OUT) == 0.0
    assert stands_out_by(body_of(drawn(0.2), 1), UP) == 0.0
