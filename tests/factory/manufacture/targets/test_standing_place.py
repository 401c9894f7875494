"""Where a robot stands: before its target, clear of what swings."""

import dataclasses

import numpy as np
import pytest
from plain_solids import box
from target_worlds import BAR, BODY, HINGE, PANEL, SLIDE, asset_of, best, moved, world

from asset_factory.factory.asset import Asset, Hull, PartBody
from asset_factory.factory.manufacture.targets.standing import (
    BASE_RADIUS_M,
    facing_direction,
    standing_place,
)


def place_of(articulation):
    place = standing_place(asset_of(articulation), articulation.joints[0], best(articulation))
    assert place is not None
    return place


def swept(articulation):
    joint = articulation.joints[0]
    vertices = articulation.part_mesh(1).vertices
    motions = [joint.motion(value) for value in np.linspace(0, joint.upper, 200)]
    rows = [vertices @ motion[:3, :3].T + motion[:3, 3] for motion in motions]
    return np.concatenate([articulation.part_mesh(0).vertices, *rows])[:, :2]


@pytest.mark.parametrize("joint", [HINGE, SLIDE], ids=["hinge", "slide"])
def test_the_base_is_clear_of_everything_that_moves_and_faces_its_target(joint):
    articulation = world([PANEL, *BAR], joint)
    place = place_of(articulation)
    assert np.linalg.norm(swept(articulation) - place.position, axis=1).min() > BASE_RADIUS_M
    ahead = best(articulation).point[:2] - place.position
    assert np.arctan2(ahead[1], ahead[0]) == pytest.approx(place.yaw, abs=1e-6)
    assert place.position[1] < -0.3


def test_a_longer_drawer_is_opened_from_farther_away():
    near = place_of(world([PANEL, *BAR], SLIDE))
    far = place_of(world([PANEL, *BAR], dataclasses.replace(SLIDE, upper=0.6)))
    assert np.linalg.norm(far.position) > np.linalg.norm(near.position)


def test_a_turned_object_is_opened_from_the_turned_place():
    articulation = world([PANEL, *BAR])
    turn = np.eye(4)[[1, 0, 2, 3]] * [[-1.0], [1.0], [1.0], [1.0]]
    before = place_of(articulation)
    after = place_of(moved(articulation, turn))
    np.testing.assert_allclose(after.position, turn[:2, :2] @ before.position, atol=1e-6)
    assert (after.yaw - before.yaw) % (2 * np.pi) == pytest.approx(np.pi / 2)


def test_without_room_there_is_no_place():
    look = BODY.materials[0]
    front = box((-4.0, 4.0), (-4.0, -0.5), (0.0, 0.6), look)
    sides = [box(x, (-0.5, 4.0), (0.0, 0.6), look) for x in ((-4.0, -0.1), (0.5, 4.0))]
    walls = [BODY, front, *sides]
    articulation = world([PANEL, *BAR], SLIDE, walls)
    # Solids of their own, so that the space between them is not taken for one of them.
    hulls = tuple(Hull(w.vertices, w.faces) for w in walls)
    plain = asset_of(articulation).bodies
    bodies = (PartBody(hulls, plain[0].inertial), plain[1])
    asset = Asset("test", articulation, bodies)
    assert standing_place(asset, SLIDE, best(articulation)) is None


def test_a_lid_pulled_upward_is_approached_from_where_its_handle_faces():
    up = np.array([0.0, 0.0, 1.0])
    side = np.array([1.0, 0.0, 0.0])
    np.testing.assert_allclose(facing_direction(up, side), side)
    np.testing.assert_allclose(facing_direction(up, up, np.array([0.0, 1.0, 1.0])), [0, 1, 0])
    np.testing.assert_allclose(facing_direction(up, up, up), [0, -1, 0])
