"""Training samples obey their answers: moving a part as the answer says is what the object does."""

from dataclasses import replace

import numpy as np
import pytest
from box_sampled_objects import box_sampled
from hypothesis import given
from hypothesis import strategies as st
from plain_solids import box_between, parted
from refusing import refusal

from asset_factory.factory.articulation import Joint, JointKind, Part, rotation_about
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.models.particulate.prediction import MotionClass
from asset_factory.learn.objects import make_object
from asset_factory.learn.samples import sampled_object as sampled_objects
from asset_factory.learn.samples.sample import DrawSettings, draw
from asset_factory.learn.samples.sampled_object import read_sampled, sampled_from, write_sampled

EXACT = DrawSettings(points=400, scale=(1.0, 1.0), shift=0.0)
SHARES = dict.fromkeys(("turned_share", "facing_share", "mirrored_share", "merged_share"), 0.5)
BUSY = DrawSettings(points=400, **SHARES, stretch=0.6, components=True)


def sampled(category="cabinet"):
    return sampled_from(make_object(category, 0), "one", 3000, np.random.default_rng(0))


CABINET = sampled()


def lid_on_a_post():
    """A root, a turning carrier, a lid sliding on it (one part, both motions), a fixed foot."""
    base, foot, lid = ([box_between((0, 0, z), (1, 1, z + 1))] for z in (0, 2, 4))
    up = np.array([0.0, 0.0, 1.0])
    joints = (
        Joint("glued", JointKind.FIXED, 0, 1, up, np.zeros(3)),
        Joint("turn", JointKind.CONTINUOUS, 1, 2, up, np.zeros(3), -np.pi, np.pi),
        Joint("slide", JointKind.PRISMATIC, 2, 3, up, np.zeros(3), 0.0, 0.3),
    )
    return parted({"base": base, "foot": foot, "carrier": [], "lid": lid}, *joints)


def test_a_part_behind_a_carrier_turns_and_slides_and_what_is_fixed_is_one_with_its_parent():
    found = sampled_from(lid_on_a_post(), "lid", 500, np.random.default_rng(0))
    assert found.motion.tolist() == [MotionClass.FIXED, MotionClass.BOTH]
    assert found.parents.tolist() == [-1, 0]
    assert found.endless.tolist() == [False, True]
    np.testing.assert_allclose(found.slide[1], [0.0, 0.3], rtol=1e-6)
    high = found.points[:, 2] > 3.0
    assert (found.part_ids[high] == 1).all()
    assert (found.part_ids[~high] == 0).all()


@given(seed=st.integers(0, 10_000))
def test_answers_come_true(seed):
    """Parts moved to their lower limits by the answer alone lie as in the closed object."""
    sample = draw(CABINET, np.random.default_rng(seed), replace(EXACT, closed_share=0.0))
    closed = draw(CABINET, np.random.default_rng(seed), replace(EXACT, closed_share=1.0))
    assert np.array_equal(sample.part_ids, closed.part_ids)
    root = sample.part_ids == 0
    scale = np.ptp(closed.points[root], axis=0).max() / np.ptp(sample.points[root], axis=0).max()
    shift = (closed.points[root] - scale * sample.points[root]).mean(axis=0)
    for part in range(1, len(sample.parents)):
        mine = sample.part_ids == part
        points = sample.points[mine].astype(float)
        if sample.motion[part] == MotionClass.REVOLUTE:
            turn = rotation_about(
                sample.revolute_direction[part].astype(float), sample.revolute_range[part, 0]
            )
            foot = sample.closest_points[mine]
            points = foot + (points - foot) @ turn.T
        else:
            points = points + sample.prismatic_direction[part] * sample.prismatic_range[part, 0]
        np.testing.assert_allclose(scale * points + shift, closed.points[mine], atol=2e-4)


@given(seed=st.integers(0, 10_000))
def test_examples_lie_in_the_networks_box_whatever_is_done_to_them(seed):
    sample = draw(CABINET, np.random.default_rng(seed), BUSY)
    assert np.abs(sample.points).max() < 0.5 * 1.05 + 5 * 0.02
    turning = sample.motion == MotionClass.REVOLUTE
    lengths = np.linalg.norm(sample.revolute_direction[turning], axis=1)
    np.testing.assert_allclose(lengths, 1.0, rtol=1e-5)
    assert (np.linalg.norm(sample.normals, axis=1) < 1.0 + 1e-5).all()
    assert np.isfinite(sample.features).all()
    assert (sample.prismatic_range[:, 0] <= 1e-6).all()


def test_a_mirrored_door_still_opens_outwards():
    fridge = sampled("fridge")
    plain = replace(EXACT, closed_share=1.0)
    for share in (0.0, 1.0):
        sample = draw(fridge, np.random.default_rng(1), replace(plain, mirrored_share=share))
        for door in np.flatnonzero(sample.motion == MotionClass.REVOLUTE):
            mine = sample.part_ids == door
            foot = sample.closest_points[mine]
            turn = rotation_about(sample.revolute_direction[door].astype(float), 0.5)
            moved = foot + (sample.points[mine] - foot) @ turn.T
            # Towards -Y, the front.
            assert moved[:, 1].mean() < sample.points[mine][:, 1].mean() - 0.02


def test_points_spread_evenly_over_components_show_the_small_ones():
    boxes = {
        "base": [box_between((0, 0, 0), (1, 1, 1))],
        "knob": [box_between((2, 0, 0), (2.1, 0.1, 0.1))],
    }
    slide = Joint("slide", JointKind.PRISMATIC, 0, 1, [1.0, 0, 0], np.zeros(3), 0.0, 0.3)
    found = sampled_from(parted(boxes, slide), "knob", 3000, np.random.default_rng(0))
    wanted = replace(EXACT, even_share=1.0)
    shown = draw(found, np.random.default_rng(0), wanted).part_ids
    assert shown.mean() == pytest.approx(0.5, abs=0.1)
    usual = draw(found, np.random.default_rng(0), EXACT).part_ids
    assert len(usual) == len(shown) == EXACT.points
    assert usual.mean() < 0.2


def test_half_of_the_points_lie_on_sharp_edges_and_the_same_seed_draws_the_same():
    one, two = (draw(CABINET, np.random.default_rng(3), BUSY) for _ in range(2))
    assert np.array_equal(one.points, two.points)
    assert np.array_equal(one.features, two.features)
    normals = draw(CABINET, np.random.default_rng(3), EXACT).normals
    on_face = np.isclose(np.linalg.norm(normals, axis=1), 1.0)
    assert on_face.mean() == pytest.approx(0.5, abs=0.02)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"parents": [-1, 2, 1]}, "does not hang on the root"),
        ({"parents": [-1, 1, 0]}, "does not hang on the root"),
        ({"parents": [-1, -1, 0]}, "-1 for the first part alone"),
        ({"motion": [0, 7, 1]}, "want 0, 1, 2, 3"),
        ({"motion": [0, -1, 1]}, "want 0, 1, 2, 3"),
        ({"components": np.full(600, 2**31 - 1)}, "components: want 0 to"),
        ({"components": np.full(600, -1)}, "components: want 0 to"),
        ({"points": np.ones((600, 3))}, "all at one place"),
        ({"part_ids": np.full(600, 3)}, "want 0 to 2"),
        ({"points": np.full((600, 3), np.nan)}, "not finite"),
        ({"points": np.array([{}, {}], dtype=object)}, "cannot be read"),
        ({"turn": np.zeros((3, 3))}, r"turn: shape \(3, 3\), want \(3, 2\)"),
    ],
)
def test_files_that_training_would_stumble_over_are_refused(tmp_path, changes, says):
    box = next(found for found in map(box_sampled, range(20)) if len(found.parents) == 3)
    np.savez(tmp_path / "a.npz", **{**vars(box), **changes})
    with pytest.raises(InputRejected, match=says) as refused:
        read_sampled(tmp_path / "a.npz")
    assert refused.value.code == "bad_sample"


def test_files_that_say_they_are_huge_are_refused_unread(tmp_path, monkeypatch):
    monkeypatch.setattr(sampled_objects, "MOST_BYTES", 1_000_000)
    arrays = {**vars(box_sampled(0)), "points": np.zeros((200_000, 3))}
    np.savez_compressed(tmp_path / "bomb.npz", **arrays)
    refused = refusal(read_sampled, tmp_path / "bomb.npz")
    assert refused.code == "bad_sample"
    assert "want at most 1000000" in refused.message


def test_a_sampled_survives_its_file(tmp_path):
    write_sampled(tmp_path / "a.npz", CABINET)
    again = read_sampled(tmp_path / "a.npz")
    assert again.name == "one"
    assert np.array_equal(again.points, CABINET.points)


def test_what_cannot_be_learnt_from_says_so():
    fridge = make_object("fridge", 0)
    rigid = replace(fridge, joints=(), parts=(Part("all", np.arange(len(fridge.mesh.faces))),))
    refused = refusal(sampled_from, rigid, "rock", 100, np.random.default_rng(0))
    assert refused.code == "no_movable_joint"
