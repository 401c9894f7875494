"""The true axis is among the candidates; moving along them meets what is in the way."""

import numpy as np
import pytest
from evidence_worlds import WOOD, apart, chest, cupboard, partition
from hypothesis import given, settings
from hypothesis import strategies as st
from plain_solids import box

from asset_factory.factory.articulate.evidence import NOTHING, Guess, Partition
from asset_factory.factory.articulate.evidence.body import body_of
from asset_factory.factory.articulate.evidence.candidates import (
    Candidates,
    LineSource,
    find_candidates,
)
from asset_factory.factory.articulate.evidence.extent import USUAL_SLIDE, extent_of, free_way
from asset_factory.factory.articulate.evidence.numbers import NAMES, measure
from asset_factory.factory.articulate.evidence.travel import displaced
from asset_factory.factory.articulation import Joint, JointKind, rotation_about
from asset_factory.factory.mesh import concatenate

UP = np.array([0.0, 0.0, 1.0])
OUT = np.array([0.0, -1.0, 0.0])


@settings(max_examples=10, deadline=None)
@given(st.floats(-3.1, 3.1), st.sampled_from(["left", "right"]))
def test_the_hinge_is_a_candidate_at_any_yaw(yaw, side):
    world = cupboard(side)
    joint = world.joints[0]
    rotation = rotation_about(UP, yaw)
    axis = rotation @ joint.axis
    origin = rotation @ joint.origin
    found = find_candidates(body_of(partition(world, yaw), 1), NOTHING)
    good = ~found.slides & (found.axis @ axis > np.cos(np.radians(1.0)))
    assert min(apart(o, axis, origin) for o in found.origin[good]) < 0.008


def test_the_way_out_of_a_drawer_is_a_candidate():
    found = find_candidates(body_of(partition(chest(), 0.3), 1), NOTHING)
    out = rotation_about(UP, 0.3) @ chest().joints[0].axis
    assert (found.slides & (found.axis @ out > 0.9999)).sum() == 1


def test_each_line_comes_both_ways_round():
    found = find_candidates(body_of(partition(cupboard()), 1), NOTHING)
    assert np.allclose(found.axis[::2], -found.axis[1::2])
    assert np.allclose(found.origin[::2], found.origin[1::2])


def test_a_guess_adds_its_own_line():
    direction = np.array([0.1, 0.2, 1.0])
    point = np.array([0.0, 0.0, 0.3])
    found = find_candidates(body_of(partition(cupboard()), 1), Guess(0.9, direction, point))
    along = found.axis @ direction > 0.9999 * np.linalg.norm(direction)
    mine = (found.source == LineSource.GUESSED) & ~found.slides & along
    assert mine.sum() == 1
    assert np.allclose(found.origin[mine], point)


def test_guesses_that_cannot_be_are_refused():
    with pytest.raises(ValueError, match="want 0 to 1"):
        Guess(turns=1.5)
    with pytest.raises(ValueError, match="points somewhere"):
        Guess(direction=np.zeros(3))


@pytest.mark.parametrize("slides", [False, True])
def test_displaced_points_are_where_the_joint_puts_them(slides):
    rng = np.random.default_rng(3)
    axis = rng.normal(size=(4, 3))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    origin = rng.normal(size=(4, 3))
    points = rng.normal(size=(9, 3))
    values = rng.uniform(-1, 1, 4)
    sources = np.full(4, LineSource.EDGE)
    lines = Candidates(np.full(4, slides), axis, origin, sources, np.zeros(4))
    moved, headings, gone = displaced(lines, points, values)
    kind = JointKind.PRISMATIC if slides else JointKind.REVOLUTE
    for k in range(4):
        pose = Joint("j", kind, 0, 1, axis[k], origin[k], -1.0, 1.0).motion(values[k])
        assert np.allclose(moved[k], points @ pose[:3, :3].T + pose[:3, 3])
    assert np.allclose(np.linalg.norm(headings, axis=2), 1.0)
    later, _, _ = displaced(lines, points, values + 1e-6)
    speed = later - moved
    assert np.allclose(speed / np.linalg.norm(speed, axis=2, keepdims=True), headings, atol=1e-3)
    assert (gone >= np.linalg.norm(moved - points, axis=2) - 1e-9).all()


def with_box(whole, x, y, z):
    """One more part, a box on the root."""
    extra = box(x, y, z, WOOD)
    labels = np.append(whole.face_part, np.full(len(extra.faces), len(whole.parents)))
    return Partition(concatenate([whole.mesh, extra]), labels, np.append(whole.parents, 0))


def tried(whole, part, axis):
    """The slide of a part along an axis: its body, itself, and its evidence."""
    body = body_of(whole, part)
    found = find_candidates(body, NOTHING)
    best = int(np.argmax(found.slides * (found.axis @ axis)))
    return body, found.at([best]), measure(body, found, NOTHING)[best]


def test_a_closed_door_is_in_the_way_but_does_not_hold():
    whole = with_box(partition(cupboard()), (-0.25, 0.25), (0.01, 0.45), (0.1, 0.3))
    body, _, evidence = tried(whole, 2, OUT)
    named = dict(zip(NAMES, evidence, strict=True))
    assert body.crowded
    assert named["slide_hit_4"] > 0.2
    assert named["slide_held_4"] == 0.0
    assert named["slide_ways"] > 0.05


def test_what_is_alone_in_its_holder_is_not_crowded():
    body, _, evidence = tried(partition(chest()), 1, OUT)
    assert not body.crowded
    assert body.holder is body.grid
    assert evidence[NAMES.index("slide_hit_4")] == evidence[NAMES.index("slide_held_4")]


def test_a_drawer_is_measured_by_its_length_and_a_front_by_the_object():
    body, chosen, _ = tried(partition(chest()), 1, OUT)
    long = extent_of(body, chosen, NOTHING)
    assert long.upper == pytest.approx(USUAL_SLIDE * 0.47, abs=0.04)
    assert long.share == 1.0
    bare = with_box(partition(cupboard()), (-0.29, 0.29), (-0.06, -0.03), (0.05, 0.35))
    body, chosen, _ = tried(bare, 2, OUT)
    depth = float(np.ptp(bare.mesh.vertices[:, 1]))
    assert extent_of(body, chosen, NOTHING).upper == pytest.approx(USUAL_SLIDE * depth, rel=0.02)


def test_the_way_in_is_stopped_by_the_back():
    body, chosen, _ = tried(partition(chest()), 1, -OUT)
    assert free_way(body, chosen, 0.5) < 0.3
