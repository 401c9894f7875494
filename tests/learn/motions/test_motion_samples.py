"""Samples name the right candidates for any labels."""

import numpy as np
import pytest

from asset_factory.factory.articulate.evidence.numbers import GUESS, NAMES
from asset_factory.learn.datasets.objects import generated
from asset_factory.learn.motions.motion_sample import known_motions, motion_samples
from asset_factory.learn.motions.spoiling import made_up_guess, spoilt
from asset_factory.learn.objects.catalog import make_object


@pytest.mark.parametrize("category", ["cabinet", "oven", "office_chair"])
def test_truth_has_one_joint_per_part_and_no_empty_parts(category):
    partition, joints = known_motions(make_object(category, 3), 0.4)
    assert (np.bincount(partition.face_part, minlength=len(partition.parents))[1:] > 0).all()
    assert joints
    assert all(joint.lower == 0.0 or joint.kind == "continuous" for joint in joints.values())


@pytest.mark.parametrize("seed", range(6))
def test_spoilt_labels_keep_every_part(seed):
    whole, _ = known_motions(make_object("cabinet", 1), 0.0)
    other = spoilt(whole, np.random.default_rng(seed))
    assert set(np.unique(other.face_part)) == set(np.unique(whole.face_part))
    assert (other.face_part != whole.face_part).mean() < 0.5
    assert (spoilt(whole, np.random.default_rng(seed)).face_part == other.face_part).all()


def test_motion_samples_know_what_is_right():
    found = list(motion_samples("chest", make_object("chest", 7), np.random.default_rng(0)))
    assert found
    for one in found:
        assert one.numbers.shape == (len(one.worth), len(NAMES))
        assert one.right[int(np.argmax(one.worth))]
        blind = one.unguided()
        assert not blind.guessed.any()
        assert (blind.numbers[:, -len(GUESS) :] == 0.0).all()
        assert blind.alike.shape == (len(blind.worth),) * 2


def test_guesses_are_rough_but_not_wild():
    joint = make_object("oven", 0).movable_joints[0]
    rng = np.random.default_rng(1)
    guesses = [made_up_guess(joint, joint.origin, 1.0, rng) for _ in range(200)]
    cosine = np.array([guess.direction @ joint.axis for guess in guesses])
    assert np.median(np.degrees(np.arccos(np.abs(cosine)))) < 20.0
    assert 0.5 < (cosine > 0.0).mean() < 0.9


def test_generated_objects_are_named():
    assert [name for name, _ in generated([1], ["laptop"])] == ["generated/laptop_1"]
