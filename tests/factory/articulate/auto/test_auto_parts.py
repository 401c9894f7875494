"""Views made one, faces shared out, loose pieces put to what they touch, trust in closed form."""

import resource
from itertools import combinations

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from plain_solids import box_between

from asset_factory.factory.articulate.auto.contacts import _touching, contacts_of, settled
from asset_factory.factory.articulate.auto.partition import share_out
from asset_factory.factory.articulate.auto.parts import agreed_parts, shared
from asset_factory.factory.articulate.auto.trust import SIGNS, Trust, load_trust, log_odds, signs_of
from asset_factory.factory.articulate.auto.views import NetworkView, SeenPart
from asset_factory.factory.articulate.proposal import Motion
from asset_factory.factory.mesh import Mesh, concatenate
from asset_factory.factory.models.perceptron import linear

AREAS = np.ones(10)
UP = np.array([0.0, 0.0, 1.0])


def mask(*faces):
    found = np.zeros(10, dtype=bool)
    found[list(faces)] = True
    return found


def view(labels, sign=1.0, moves=0.9, both=0.0, slide=None):
    root = SeenPart(1.0, 0.0, 0.0, 0.0, 1.0, None, None, 0.0, 0.0)
    door = SeenPart(0.9, moves, 1.0, both, 0.8, sign * UP, np.zeros(3), 0.0, 1.5, slide)
    return NetworkView(np.array(labels), (root, door))


def test_a_part_seen_from_every_side_is_agreed_on_and_its_axis_is_the_majoritys():
    here = [1, 1, 1, 0, 0, 0, 0, 0, 0, 0]
    there = [1, 1, 1, 1, 0, 0, 0, 0, 0, 0]
    (part,) = agreed_parts((view(here), view(there, -1.0), view(here)), AREAS)
    assert part.agreement == 1.0
    assert part.faces.tolist() == mask(0, 1, 2).tolist()
    np.testing.assert_allclose(part.guess.direction, [0, 0, 1])


def test_different_parts_stay_different_and_still_ones_are_left_out():
    views = (view([1, 1] + [0] * 8), view([0] * 8 + [1, 1]), view([0, 1] * 5, moves=0.1))
    parts = agreed_parts(views, AREAS)
    assert [part.agreement for part in parts] == [1 / 3, 1 / 3]
    assert {tuple(part.faces) for part in parts} == {tuple(mask(0, 1)), tuple(mask(8, 9))}


def test_what_turns_and_slides_must_be_more_probable_than_either_alone():
    here = [1, 1] + [0] * 8
    ways = ((UP, 0.1), (UP, 0.2), (-UP, 0.4))
    slides = [Motion("prismatic", along, np.zeros(3), 0.0, far) for along, far in ways]
    sure = tuple(view(here, both=0.9, slide=slide) for slide in slides)
    (part,) = agreed_parts(sure, AREAS)
    np.testing.assert_allclose(part.slide.axis, UP)
    assert (part.slide.lower, part.slide.upper) == (0.0, 0.2)
    assert part.guess.turns == 1.0
    unsure = tuple(view(here, both=both, slide=slides[0]) for both in (0.9, 0.2, 0.3))
    (part,) = agreed_parts(unsure, AREAS)
    assert part.slide is None
    (part,) = agreed_parts((view(here, both=0.9),), AREAS)
    assert part.slide is None, "nobody says which way"


def test_the_share_of_an_overlap():
    assert shared(mask(0, 1, 2), mask(2, 3), AREAS) == pytest.approx(0.25)
    assert shared(mask(), mask(), AREAS) == 0.0


def test_a_small_part_inside_another_hangs_on_it_and_a_rival_is_left_out():
    sharing = share_out([mask(0, 1, 2, 3, 4, 5), mask(5), mask(3, 4, 6), mask(7)], AREAS)
    assert sharing.chosen == (0, 1, 3)
    assert sharing.hosts == (0, 1, 0)
    assert sharing.face_part.tolist() == [1, 1, 1, 1, 1, 2, 0, 3, 0, 0]


def test_something_always_stays():
    assert share_out([np.ones(10, dtype=bool)], AREAS).chosen == ()


@given(st.lists(st.lists(st.booleans(), min_size=10, max_size=10), max_size=6))
def test_every_chosen_part_keeps_faces_and_hangs_on_an_earlier_one(parts):
    sharing = share_out([np.array(part) for part in parts], AREAS)
    assert set(sharing.face_part) == set(range(len(sharing.chosen) + 1))
    assert all(host < number for number, host in enumerate(sharing.hosts, start=1))


def test_trust_is_a_logistic_of_the_signs():
    trust = Trust(linear(np.eye(len(SIGNS))[SIGNS.index("evidence")]), 0.5)
    assert trust.confidence({"evidence": log_odds(0.8)}) == pytest.approx(0.8)
    assert trust.confidence({}) == 0.5
    with pytest.raises(KeyError, match="no sign"):
        signs_of({"feeling": 1.0})


def test_the_shipped_trust_believes_more_where_more_speaks_for_it():
    trust = load_trust()
    seen = {"agreement": 1.0, "area": -1.0, "rivals": 1.5}
    seen |= dict.fromkeys(("moves", "hangs"), log_odds(0.95))
    seen |= dict.fromkeys(("confidence", "evidence", "unguided"), log_odds(0.9))
    doubtful = seen | {"agreement": 0.25, "confidence": log_odds(0.4), "evidence": log_odds(0.3)}
    both = trust.confidence(seen | {"shared": 1.0, "alike": 1.0})
    assert both > trust.confidence(doubtful | {"learned": 1.0})
    assert trust.confidence(seen | {"learned": 1.0}) > trust.confidence(doubtful | {"learned": 1.0})
    assert 0.05 < trust.least < 0.9


FACES = 12
BODY, DOOR, HANDLE, SHELF, FAR = range(5)


#: A body, a door 20 mm before it, a handle on the door, a shelf on the body's back, and something
#: that touches nothing.
SCENE = concatenate([
    box_between((-0.5, -0.25, 0.0), (0.5, 0.25, 1.0)),
    box_between((-0.5, -0.29, 0.0), (0.5, -0.27, 1.0)),
    box_between((0.39, -0.33, 0.4), (0.41, -0.29, 0.6)),
    box_between((-0.15, 0.25, 0.49), (0.15, 0.45, 0.51)),
    box_between((-0.05, -0.05, 1.95), (0.05, 0.05, 2.05)),
])  # fmt: skip
COMPONENTS = np.repeat(np.arange(5), FACES)


@pytest.mark.parametrize(
    ("labels", "wanted"),
    [
        ([0, 1, 0, 1, 0], [0, 1, 1, 0, 0]),
        ([0, 1, 1, 0, 1], [0, 1, 1, 0, 1]),
        ([1, 1, 1, 1, 1], [1, 1, 1, 1, 1]),
        ([2, 1, 1, 0, 0], [2, 1, 1, 0, 0]),
    ],
    ids=[
        "a handle goes with its door, a shelf with the body",
        "what is right stays, and what touches nothing",
        "all are one",
        "a large piece is no loose one",
    ],
)
def test_loose_pieces_go_with_what_they_touch(labels, wanted):
    found = settled(contacts_of(SCENE, COMPONENTS), np.repeat(labels, FACES))
    assert found.tolist() == np.repeat(wanted, FACES).tolist()


def test_a_component_of_several_parts_is_left_as_it_is():
    labels = np.repeat([0, 1, 0, 0, 0], FACES)
    labels[HANDLE * FACES] = 1
    assert np.array_equal(settled(contacts_of(SCENE, COMPONENTS), labels), labels)


@pytest.mark.parametrize("seed", range(3))
def test_contacts_do_not_depend_on_the_order_of_faces(seed):
    order = np.random.default_rng(seed).permutation(len(SCENE.faces))
    shuffled = SCENE.submesh(order)
    there = contacts_of(shuffled, COMPONENTS[order])
    here = contacts_of(SCENE, COMPONENTS)
    assert there.pairs.tolist() == here.pairs.tolist() == [[BODY, SHELF], [DOOR, HANDLE]]


@given(st.integers(0, 10_000), st.integers(1, 6), st.floats(0.01, 0.5))
def test_contacts_are_counted_as_if_every_pair_were_listed(seed, owners, reach):
    chance = np.random.default_rng(seed)
    points = chance.uniform(size=(60, 3))
    owner = np.sort(chance.integers(0, owners, 60)) * 3
    pairs, weights = _touching(points, owner, reach)
    near = np.linalg.norm(points[:, None] - points[None], axis=2) <= reach
    both = combinations(np.unique(owner).tolist(), 2)
    expected = {(a, b): int(near[np.ix_(owner == a, owner == b)].sum()) for a, b in both}
    found = dict(zip(map(tuple, pairs.tolist()), weights.tolist(), strict=True))
    assert found == {pair: count for pair, count in expected.items() if count}


def test_dense_boards_that_lie_in_one_another_take_no_memory():
    board = trimesh.creation.box((1.0, 1.0, 0.001))
    for _ in range(6):
        board = board.subdivide()
    boards = [board.copy().apply_translation([0.0, 0.0, 0.0005 * k]) for k in range(3)]
    both = trimesh.util.concatenate(boards)
    mesh = Mesh.from_triangles(both.vertices, both.faces)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    components = np.repeat(np.arange(3), len(board.faces))
    contacts = contacts_of(mesh, components)
    assert contacts.pairs.tolist() == [[0, 1], [0, 2], [1, 2]]
    assert contacts.weights.sum() > 1_000_000
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 1_000_000
