"""A network that knows the answer, through the articulator: the truth in metres, at any size."""

from dataclasses import replace

import numpy as np
import pytest
from manufactured import intake_of
from oracle_network import Oracle
from plain_solids import moved

from asset_factory.factory.articulate.catalog import choose
from asset_factory.factory.articulate.particulate import ParticulateArticulator
from asset_factory.factory.articulate.settings import require_usable
from asset_factory.factory.articulate.stage import hypotheses_of
from asset_factory.factory.articulation import JointKind, Weights
from asset_factory.factory.config import BuildConfig, ParticulateConfig
from asset_factory.factory.errors import ConfigError
from asset_factory.factory.geometry.posing import face_parts
from asset_factory.factory.models.particulate.prediction import MotionClass
from asset_factory.learn.objects.catalog import DEMO_CATEGORIES, make_object
from asset_factory.learn.surfaces import fused_like

CONFIG = ParticulateConfig(points=3000, context_points=500)
WEIGHTS = (Weights("oracle.safetensors", "ab" * 32, "no terms"),)


def asked(truth, config=CONFIG, **mistakes):
    oracle = Oracle(truth, config, **mistakes)
    return ParticulateArticulator(oracle, WEIGHTS, config).articulate(truth.mesh)


def face_sets(articulation):
    return {frozenset(part.faces.tolist()): i for i, part in enumerate(articulation.parts)}


def joint_of(found, part):
    """The one that moves exactly the faces of that part."""
    faces = set(part.faces)
    return next(each for each in found.joints if set(found.parts[each.child].faces) == faces)


def assert_same(found, truth, tolerance=1e-5):
    """Same faces, tree, kinds, lines and limits; names and order may differ."""
    mine = face_sets(found)
    assert set(mine) == set(face_sets(truth))
    size = truth.mesh.extents.max()
    for want in truth.joints:
        have = joint_of(found, truth.parts[want.child])
        assert have.kind == want.kind
        assert set(found.parts[have.parent].faces) == set(truth.parts[want.parent].faces)
        if want.movable:
            assert np.allclose(have.axis, want.axis, atol=tolerance)
            unit = 1.0 if want.turns else size
            assert have.lower == pytest.approx(want.lower, abs=tolerance * unit)
            assert have.upper == pytest.approx(want.upper, abs=tolerance * unit)
        if want.turns:
            off = have.origin - want.origin
            assert np.abs(off - want.axis * (off @ want.axis)).max() < tolerance * size


@pytest.mark.parametrize("category", DEMO_CATEGORIES)
def test_the_truth_comes_back(category):
    truth = make_object(category, 1)
    assert_same(asked(truth), truth)


@pytest.mark.parametrize(
    ("scale", "shift"), [(0.001, (0, 0, 0)), (250.0, (40.0, -3.0, 900.0)), (1.0, (5e3, 0, -7))]
)
def test_size_and_place_are_undone_exactly(scale, shift):
    """Where we leave the release: its parts fill a unit box, and are off by up to 0.5 percent."""
    matrix = np.diag([scale, scale, scale, 1.0])
    matrix[:3, 3] = shift
    truth = moved(make_object("cabinet", 3), matrix)
    assert_same(asked(truth), truth, tolerance=2e-6 if max(map(abs, shift)) < 10 else 2e-5)


def test_a_fused_mesh_keeps_its_moving_parts():
    """Where we leave the release: by default it makes one part of a mesh of one component."""
    truth = fused_like(make_object("cabinet", 1), seed=0)
    found = asked(truth, wrong=0.05)
    assert len(found.movable_joints) == len(truth.movable_joints)
    owner = face_parts(truth)
    agreed = sum(max(np.bincount(owner[part.faces])) for part in found.parts)
    assert agreed / len(owner) > 0.97
    assert len(asked(truth, config=replace(CONFIG, refinement="component")).movable_joints) == 0


def test_a_range_that_leaves_out_the_input_pose_is_widened_not_posed():
    truth = make_object("fridge", 1)
    found = asked(truth, offset=0.5)
    assert any("widened to its input pose" in note for note in found.notes)
    assert np.array_equal(found.mesh.vertices, truth.mesh.vertices)


def test_a_joint_predicted_backwards_opens_upwards():
    def backwards(fields, queries, number):
        for name in ("revolute", "prismatic"):
            fields[f"{name}_direction"] = -fields[f"{name}_direction"]
            fields[f"{name}_range"] = -fields[f"{name}_range"][:, ::-1]

    truth = make_object("microwave", 1)
    assert_same(asked(truth, change=backwards), truth)


def test_a_part_that_turns_and_slides_gets_a_carrier():
    """Where we leave the release: its writers keep the turn and drop the slide."""
    truth = make_object("microwave", 1)
    child = next(joint.child for joint in truth.joints if joint.kind is JointKind.REVOLUTE)

    def both(fields, queries, number):
        query = queries[child]
        fields["motion_logits"][query] = 12.0 * (np.arange(4) == MotionClass.BOTH)
        fields["prismatic_direction"][query] = [0.0, 0.0, 3.0]
        fields["prismatic_range"][query] = [0.0, 0.1]

    found = asked(truth, change=both)
    slide = joint_of(found, truth.parts[child])
    turn = found.parent_joint(slide.parent)
    assert (turn.kind, slide.kind) == (JointKind.REVOLUTE, JointKind.PRISMATIC)
    assert turn.child == slide.parent
    assert len(found.parts[turn.child].faces) == 0
    assert found.parts[turn.child].confidence is None
    assert np.allclose(slide.axis, [0, 0, 1])
    assert turn.confidence == slide.confidence > 0.9


def test_the_root_stays_still_and_says_so():
    def moving_root(fields, queries, number):
        fields["motion_logits"][queries[0]] = 12.0 * (np.arange(4) == MotionClass.REVOLUTE)

    truth = make_object("fridge", 1)
    found = asked(truth, change=moving_root)
    assert_same(found, truth)
    assert any("the root stays still" in note for note in found.notes)


def test_confidence_is_high_for_the_sure_and_said_of_the_doubtful():
    truth = make_object("fridge", 1)
    sure = asked(truth)
    assert all(part.confidence > 0.99 for part in sure.parts)
    assert all(joint.confidence > 0.99 for joint in sure.movable_joints)
    assert not any("doubtful" in note for note in sure.notes)

    def undecided(fields, queries, number):
        fields["motion_logits"][queries[1]] = [0.0, 3.0, 2.9, 0.0]
        fields["mask_logits"] = fields["mask_logits"] * 0.1

    doubtful = asked(truth, change=undecided)
    assert joint_of(doubtful, truth.parts[1]).confidence < 0.1
    assert any("doubtful: another kind of motion" in note for note in doubtful.notes)


def test_of_several_samples_the_one_that_agrees_with_most_is_taken():
    truth = make_object("fridge", 1)

    def odd_one(fields, queries, number):
        if number == 0:
            fields["motion_logits"][queries[1]] = 12.0 * (np.arange(4) == MotionClass.PRISMATIC)
            fields["prismatic_direction"][queries[1]] = [1.0, 0.0, 0.0]
            fields["prismatic_range"][queries[1]] = [0.0, 0.5]

    config = replace(CONFIG, samples=3)
    alone = asked(truth, change=odd_one)
    assert any(joint.kind is JointKind.PRISMATIC for joint in alone.joints)
    found = asked(truth, config=config, change=odd_one)
    assert_same(found, truth)
    # One of the two other readings has it too.
    assert joint_of(found, truth.parts[1]).confidence == pytest.approx(0.5, abs=0.02)
    assert any("3 samples were read" in note for note in found.notes)


def test_the_shipped_network_answers_unless_another_is_named():
    intake = intake_of(make_object("fridge", 1).mesh)
    assert choose(intake, BuildConfig(articulator="auto")).name == "auto"
    shipped = choose(intake, BuildConfig(articulator="particulate")).weights
    assert shipped[0].file == "small.safetensors"
    ruled = hypotheses_of(intake, BuildConfig(articulator="geometric"))[0]
    assert ruled.articulator == "geometric"
    with pytest.raises(ConfigError, match=r"nowhere\.pt: no such file"):
        choose(intake, BuildConfig(particulate=ParticulateConfig(checkpoint="nowhere.pt")))


@pytest.mark.parametrize(
    ("setting", "value", "sentence"),
    [
        ("points", 0, "points must be at least 1, not 0"),
        ("samples", 65, "must be at most 64"),
        ("max_faces", 3, "must be at least 4"),
        ("refinement", "strict", "must be one of auto, component, patch, none"),
        ("tree", "full", "must be one of present, all"),
        ("least_confidence", 2.0, "must be 0 to 1"),
        ("checkpoint", "nowhere.pt", "no such file"),
    ],
)
def test_impossible_settings_are_refused_before_any_input(setting, value, sentence):
    with pytest.raises(ConfigError, match=sentence):
        require_usable(replace(CONFIG, **{setting: value}), needed=False)
