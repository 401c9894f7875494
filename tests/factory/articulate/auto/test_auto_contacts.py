"""Loose pieces find the part they touch."""

import numpy as np
import pytest
import trimesh

from asset_factory.factory.articulate.auto.contacts import contacts_of, settled
from asset_factory.factory.geometry.areas import face_areas
from asset_factory.factory.mesh import Mesh, concatenate

FACES = 12
BODY, DOOR, HANDLE, SHELF, FAR = range(5)


def box(size, center):
    made = trimesh.creation.box(size)
    return Mesh.from_triangles(made.vertices + np.array(center), made.faces)


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
    areas = face_areas(SCENE)
    found = settled(contacts_of(SCENE, COMPONENTS, areas), np.repeat(labels, FACES), areas)
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
    areas = face_areas(SCENE)
    assert np.array_equal(settled(contacts_of(SCENE, COMPONENTS, areas), labels, areas), labels)


@pytest.mark.parametrize("seed", range(3))
def test_contacts_do_not_depend_on_the_order_of_faces(seed):
    order = np.random.default_rng(seed).permutation(len(SCENE.faces))
    shuffled = SCENE.submesh(order)
    areas = face_areas(SCENE)
    there = contacts_of(shuffled, COMPONENTS[order], areas[order])
    here = contacts_of(SCENE, COMPONENTS, areas)
    assert there.pairs.tolist() == here.pairs.tolist() == [[BODY, SHELF], [DOOR, HANDLE]]
