"""Loose pieces find the part they touch."""

import resource
from itertools import combinations

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from plain_solids import sized_box

from asset_factory.factory.articulate.auto.contacts import _touching, contacts_of, settled
from asset_factory.factory.mesh import Mesh, concatenate

FACES = 12
BODY, DOOR, HANDLE, SHELF, FAR = range(5)


def box(size, center):
    return Mesh.from_triangles(*sized_box(size, center))


#: A body, a door 20 mm before it, a handle on the door, a shelf on the body's back, and something
#: that touches nothing.
SCENE = concatenate([
    box((1.0, 0.5, 1.0), (0.0, 0.0, 0.5)),
    box((1.0, 0.02, 1.0), (0.0, -0.28, 0.5)),
    box((0.02, 0.04, 0.2), (0.4, -0.31, 0.5)),
    box((0.3, 0.2, 0.02), (0.0, 0.35, 0.5)),
    box((0.1, 0.1, 0.1), (0.0, 0.0, 2.0)),
])  # fmt: skip
COMPONENTS = np.repeat(np.arange(5), FACES)


def after(labels):
    found = settled(contacts_of(SCENE, COMPONENTS), np.repeat(labels, FACES))
    return found.reshape(5, FACES)


def test_a_handle_goes_with_the_door_that_it_stands_on_and_a_shelf_with_the_body():
    found = after([0, 1, 0, 1, 0])
    assert (found[HANDLE] == 1).all()
    assert (found[SHELF] == 0).all()


def test_what_is_right_stays_and_so_does_what_touches_nothing():
    assert after([0, 1, 1, 0, 1])[:, 0].tolist() == [0, 1, 1, 0, 1]


def test_a_large_piece_is_no_loose_one():
    assert after([1, 1, 1, 1, 1])[BODY, 0] == 1
    assert after([2, 1, 1, 0, 0])[BODY, 0] == 2


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
