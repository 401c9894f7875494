"""From the network's numbers to parts, tree and motions: as the release, and where we leave it."""

import itertools
from dataclasses import replace

import networkx
import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from plain_solids import surface_of
from refusing import refusal
from stored_arrays import OUTPUTS, arrays

from asset_factory.factory.config import ParticulateConfig
from asset_factory.factory.models.particulate.decoding import (
    TreeOver,
    assigned,
    decode,
    induced,
    spanning_arborescence,
)
from asset_factory.factory.models.particulate.frames import UnitBox
from asset_factory.factory.models.particulate.labels import Refinement
from asset_factory.factory.models.particulate.motion import holding_zero, read_motion
from asset_factory.factory.models.particulate.prediction import MotionClass, Prediction
from asset_factory.factory.models.particulate.proxy import Proxy
from asset_factory.factory.models.particulate.sampling import Cloud, CloudSample
from asset_factory.factory.models.particulate.surface import Surface


def prediction_of(held):
    """The logits behind stored decisions."""
    mask = np.zeros((len(held["part_ids"]), 16))
    mask[np.arange(len(mask)), held["part_ids"]] = 9.0
    hierarchy = np.full((16, 16), -9.0)
    for parent, child in held["motion_hierarchy"]:
        hierarchy[parent, child] = 9.0
    motion = 9.0 * np.eye(4)[held["is_part_revolute"] + 2 * held["is_part_prismatic"]]
    return Prediction(
        mask_logits=mask,
        hierarchy_logits=hierarchy,
        motion_logits=motion,
        revolute_direction=held["revolute_axis"],
        revolute_range=held["revolute_range"],
        prismatic_direction=held["prismatic_axis"],
        prismatic_range=held["prismatic_range"],
        closest_points=held["closest_point_on_axis"],
    )


def decoded(surface, faces, prediction, **rules):
    """What is made of a sample of which only the faces matter."""
    places = np.zeros((len(faces), 3))
    cloud = Cloud(places, places, faces, np.zeros(len(faces), dtype=bool), faces)
    seen = CloudSample(cloud, cloud, UnitBox(np.zeros(3), 1.0))
    return decode(surface, Proxy(surface), seen, prediction, ParticulateConfig(**rules))


def assert_moves_as(motion, want, index, atol):
    """The kind, axis and slide are the released code's for that part."""
    assert motion.kind.turns == want["is_part_revolute"][index]
    assert motion.kind.slides == want["is_part_prismatic"][index]
    if motion.axis is not None:
        along = motion.axis.direction
        line = np.concatenate([along, np.cross(along, motion.axis.point)])
        assert np.allclose(line, want["revolute_plucker"][index], atol=atol)
    if motion.slide_direction is not None:
        assert np.allclose(motion.slide_direction, want["prismatic_axis"][index], atol=atol)


@pytest.mark.parametrize(
    ("case", "refinement"),
    [("nonstrict", Refinement.PATCH), ("strict_induced_tree", Refinement.COMPONENT)],
)
def test_a_stored_answer_becomes_the_released_codes_prediction(fixtures, case, refinement):
    folder = fixtures / "postprocess_e2e" / case
    held = arrays(folder / "network_outputs.npz")
    want = arrays(folder / "pred.npz")
    mesh = trimesh.load(folder / "mesh.obj", process=False)
    found = decoded(
        surface_of(mesh), held["face_indices"], prediction_of(held), refinement=refinement
    )
    assert np.array_equal(found.face_part, want["face_part_ids"])
    assert sorted(found.edges) == sorted(map(tuple, want["motion_hierarchy"].tolist()))
    assert [p.query for p in found.parts] == sorted({int(p.query) for p in found.parts})
    for index, part in enumerate(found.parts):
        assert_moves_as(part.motion, want, index, atol=1e-6)
        if part.motion.axis is not None:
            assert part.motion.turn == holding_zero(want["revolute_range"][index], "rad", [])
        if part.motion.slide_direction is not None:
            assert part.motion.slide == holding_zero(want["prismatic_range"][index], "", [])


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_axes_types_and_tree_are_those_of_the_release(fixtures, seed):
    forward = arrays(fixtures / "pat_tiny" / f"forward_seed{seed}.npz")
    want = arrays(fixtures / "pat_tiny" / f"infer_seed{seed}_t00.npz")
    given = {name: forward[original][0] for name, original in OUTPUTS.items()}
    prediction = Prediction(**given, closest_points=forward["closest_point_on_axis"][0])
    points = assigned(prediction.mask_logits)
    for part in points.present:
        assert_moves_as(read_motion(prediction, part, points.parts), want, part, atol=1e-5)
    # One face per point, so that faces are points and the tree is over the same parts.
    count = len(points.parts)
    vertices = np.random.default_rng(0).normal(size=(3 * count, 3))
    surface = Surface.of(vertices, np.arange(3 * count).reshape(-1, 3))
    found = decoded(surface, np.arange(count), prediction, refinement=Refinement.NONE)
    query = [part.query for part in found.parts]
    tree = sorted((query[parent], query[child]) for parent, child in found.edges)
    assert tree == sorted(map(tuple, want["motion_hierarchy"].tolist()))


def test_a_pluecker_network_gives_the_same_axes(fixtures):
    held = arrays(fixtures / "geometry" / "plucker.npz")
    for line, axis, point in zip(held["plucker"], held["axis_out"], held["point_out"], strict=True):
        motion = only_motion(turning(direction=3.0 * line[:3], moment=3.0 * line[3:]))
        assert np.allclose(motion.axis.direction, axis, atol=1e-6)
        off = motion.axis.point - point
        assert np.allclose(off - axis * (off @ axis), 0.0, atol=1e-6)


def only_motion(prediction, count=1):
    """Of the one part, to which so many points belong."""
    return read_motion(prediction, 0, np.zeros(count, dtype=int))


def turning(direction=(0.0, 0.0, 1.0), moment=(0.0, 0.0, 0.0), kind=MotionClass.REVOLUTE):
    return Prediction(
        mask_logits=np.zeros((1, 1)),
        hierarchy_logits=np.zeros((1, 1)),
        motion_logits=5.0 * np.eye(4)[[kind]],
        revolute_direction=np.array([direction]),
        revolute_range=np.array([[0.0, 1.0]]),
        prismatic_direction=np.array([[0.0, 2.0, 0.0]]),
        prismatic_range=np.array([[0.0, 0.3]]),
        revolute_moment=np.array([moment]),
    )


@pytest.mark.parametrize(
    ("given", "want", "said"),
    [
        ((0.0, 1.5), (0.0, 1.5), 0),
        ((-0.01, 1.5), (0.0, 1.5), 0),
        ((0.02, 1.5), (0.0, 1.5), 0),
        ((-0.7, 0.8), (-0.7, 0.8), 0),
        ((1.5, 0.0), (0.0, 1.5), 1),
        ((0.4, 1.5), (0.0, 1.5), 1),
        ((-1.5, -0.4), (-1.5, 0.0), 1),
        ((0.0, 0.0), (0.0, 0.0), 0),
    ],
)
def test_limits_hold_the_input_pose(given, want, said):
    """Where we leave the release: its ranges may be swapped, or leave out the input pose."""
    notes = []
    assert holding_zero(given, "rad", notes) == pytest.approx(want)
    assert len(notes) == said


def test_a_motion_without_direction_is_left_out_with_a_note():
    nowhere = (0.0, 0.0, 0.0)
    motion = only_motion(turning(direction=nowhere))
    assert (motion.kind, motion.axis, len(motion.notes)) == (MotionClass.FIXED, None, 1)
    both = only_motion(turning(direction=nowhere, kind=MotionClass.BOTH))
    assert both.kind is MotionClass.PRISMATIC
    assert both.slide == pytest.approx((0.0, 0.3))


def test_the_margin_is_that_between_the_two_likeliest_kinds():
    logits = np.array([[0.0, np.log(3.0), np.log(2.0), -50.0]])
    undecided = only_motion(replace(turning(), motion_logits=logits))
    assert undecided.margin == pytest.approx(1 / 6, abs=1e-6)


def voting(votes):
    """The same one part, whose points say where its axis is."""
    given = {"closest_points": votes, "revolute_moment": None}
    held = turning(direction=(0.0, 0.0, 2.0))
    return replace(held, mask_logits=np.zeros((len(votes), 1)), **given)


def test_votes_for_an_axis_are_robust_and_their_spread_is_measured():
    """A third of the votes are wild; the median does not move."""
    rng = np.random.default_rng(0)
    votes = rng.normal([0.2, -0.1, 0.0], [0.01, 0.01, 0.3], (300, 3)).astype(np.float32)
    votes[:90, :2] = rng.uniform(-3, 3, (90, 2))
    axis = only_motion(voting(votes), 300).axis
    assert np.allclose(axis.point[:2], [0.2, -0.1], atol=0.01)
    assert 0.005 < axis.spread < 0.03
    assert only_motion(voting(np.full((300, 3), 0.5)), 300).axis.spread == 0.0


@pytest.mark.parametrize(
    "field", ["mask_logits", "hierarchy_logits", "motion_logits", "revolute_range"]
)
def test_broken_weights_are_a_reason_not_an_answer(field):
    prediction = turning()
    broken = np.array(getattr(prediction, field))
    broken[0, 0] = np.nan
    surface = Surface.of(np.eye(3), np.array([[0, 1, 2]]))
    given = (surface, np.zeros(1, dtype=int), replace(prediction, **{field: broken}))
    found = refusal(decoded, *given)
    assert (found.code, field in found.message) == ("prediction_not_finite", True)


def test_broken_votes_are_a_reason_too():
    found = refusal(only_motion, voting(np.full((1, 3), np.inf)))
    assert (found.code, "votes" in found.message) == ("prediction_not_finite", True)


@pytest.mark.parametrize("over", list(TreeOver))
def test_one_tree_over_parts_with_faces_also_when_the_root_has_none(over):
    """Where we leave the release: its writers then give a URDF of several roots."""
    boxes = [trimesh.creation.box().apply_translation([2.0 * i, 0, 0]) for i in range(3)]
    labels = np.repeat([4, 5, 6], 12)
    labels[:2] = 9
    hierarchy = np.full((16, 16), -9.0)
    hierarchy[9, [4, 5, 6]] = 9.0
    hierarchy[5, [4, 6]] = 1.0
    prediction = Prediction(
        mask_logits=9.0 * np.eye(16)[labels],
        hierarchy_logits=hierarchy,
        motion_logits=np.tile([9.0, 0, 0, 0], (16, 1)),
        revolute_direction=np.ones((16, 3)),
        revolute_range=np.zeros((16, 2)),
        prismatic_direction=np.ones((16, 3)),
        prismatic_range=np.zeros((16, 2)),
        revolute_moment=np.zeros((16, 3)),
    )
    rules = {"refinement": Refinement.COMPONENT, "tree": over}
    found = decoded(surface_of(*boxes), np.arange(len(labels)), prediction, **rules)
    assert [part.query for part in found.parts] == [4, 5, 6]
    assert sorted(found.edges) == [(1, 0), (1, 2)]
    assert found.root == 1
    assert any("lost every face" in note for note in found.notes)
    assert found.parts[1].parent_probability is None
    assert found.parts[0].parent_probability == pytest.approx(1 / (1 + np.exp(-1.0)))


def weight(logits, edges):
    return -sum(np.logaddexp(0.0, -float(logits[i, j])) for i, j in edges)


def every_tree(parts):
    """All rooted trees over ``parts``, as (parent, child)."""
    for root in parts:
        others = [p for p in parts if p != root]
        for parents in itertools.product(parts, repeat=len(others)):
            edges = list(zip(parents, others, strict=True))
            if networkx.is_arborescence(networkx.DiGraph(edges)):
                yield edges


@pytest.mark.parametrize("index", range(12))
def test_the_tree_is_that_of_the_release_or_a_likelier_one(fixtures, index):
    held = arrays(fixtures / "geometry" / "arborescence.npz")
    logits = held[f"m{index}_logits"]
    edges = [tuple(e) for e in held[f"m{index}_edges"].tolist()]
    found = spanning_arborescence(logits, np.arange(len(logits)))
    assert weight(logits, edges) == pytest.approx(float(held[f"m{index}_weight"]), abs=1e-5)
    if index < 11:
        assert sorted(found) == sorted(edges)
    else:
        # Single precision, as the release has it, cannot tell the best of these.
        assert weight(logits, found) >= weight(logits, edges)


@given(st.integers(0, 10**6), st.integers(2, 4))
def test_no_tree_is_likelier(seed, count):
    logits = np.random.default_rng(seed).normal(size=(count, count)) * 5
    found = spanning_arborescence(logits, np.arange(count))
    best = max(weight(logits, edges) for edges in every_tree(range(count)))
    assert weight(logits, found) == pytest.approx(best)
    assert len(found) == count - 1
    assert len({child for _, child in found}) == count - 1


def test_only_the_parts_asked_for_take_part():
    logits = np.zeros((5, 5))
    logits[2, :] = 9.0
    logits[1, 3] = 5.0
    assert spanning_arborescence(logits, np.array([1, 3])) == ((1, 3),)
    assert spanning_arborescence(logits, np.array([3])) == ()
    assert spanning_arborescence(logits, np.array([], dtype=int)) == ()


def test_a_lost_parts_children_go_to_its_nearest_surviving_ancestor():
    chain = ((0, 1), (1, 2), (2, 3), (1, 4))
    assert induced(chain, np.array([0, 3, 4])) == ((0, 3), (0, 4))
    assert induced(chain, np.array([0, 2, 3])) == ((0, 2), (2, 3))
    assert induced(chain, np.arange(5)) == ((0, 1), (1, 2), (2, 3), (1, 4))
    assert induced(chain, np.array([2, 4])) == (), "without the root there may be several trees"


def test_the_paper_and_the_release_read_different_trees():
    """In the paper a part that nobody sees can still stand between two others."""
    logits = np.full((3, 3), -2.0)
    logits[0, 1] = logits[1, 2] = 6.0
    logits[2, 0] = -1.0
    present = np.array([0, 2])
    paper = induced(spanning_arborescence(logits, np.arange(3)), present)
    released = spanning_arborescence(logits, present)
    assert paper == ((0, 2),)
    assert released == ((2, 0),)
