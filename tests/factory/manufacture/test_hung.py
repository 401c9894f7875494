"""Levers turn in a round seat, doors at their edge, knobs about their middle; others are off."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from held_parts import (
    CONFIG,
    PAIR,
    box,
    cut,
    cut_free,
    cylinder,
    deepest,
    hulls_of,
    mesh_of,
    require_refused,
)

from asset_factory.factory.articulation import Joint, rotation_about
from asset_factory.factory.manufacture.separate.budget import SeenSurface
from asset_factory.factory.manufacture.separate.hung import well_hung

RADIUS, ARM = 0.05, 0.32
UP = np.array([0.0, 0.0, 1.0])
ALONG = np.array([1.0, 0.0, 0.0])

#: A lever on the hollow top of a post: a hub, and an arm to one side of it.
HUB = cylinder(RADIUS, 0.3, 0.36, 12)
LEVER = [HUB, box((0.0, -0.02, 0.33), (ARM, 0.02, 0.36))]
COLLAR = cylinder(RADIUS + 0.02, 0.28, 0.31, 40)
POST = [cylinder(0.04, 0.0, 0.28, 12), COLLAR]
TURN = Joint("turn", "revolute", 0, 1, UP, [0.0, 0.0, 0.33], 0.0, np.pi / 2.0)


def surface_of(solids):
    return SeenSurface.of(mesh_of(solids))


def test_a_lever_on_a_collar_is_well_hung_and_beside_it_is_not():
    surface, post = surface_of(LEVER), hulls_of(POST)
    assert well_hung(surface, TURN, post, CONFIG)
    # A third of the hub's radius, and a little more.
    for side in (ALONG, -ALONG):
        beside = replace(TURN, origin=TURN.origin + 0.025 * side)
        assert not well_hung(surface, beside, post, CONFIG)
    crooked = rotation_about(ALONG, np.radians(5.0)) @ UP
    assert not well_hung(surface, replace(TURN, axis=crooked), post, CONFIG)


def test_an_arm_that_touches_nothing_around_its_axis_is_not_well_hung():
    bar = surface_of([box((-0.1, -0.02, 0.31), (ARM, 0.02, 0.36))])
    assert not well_hung(bar, TURN, hulls_of(POST), CONFIG)
    assert not well_hung(surface_of(LEVER), TURN, (), CONFIG)


def test_what_is_alike_on_all_sides_of_its_axis_turns_about_its_middle():
    assert well_hung(surface_of([HUB]), TURN, (), CONFIG)


#: Something of the post that the lever's arm passes 8 mm deep on its way.
STOP = box((-0.02, 0.1, 0.28), (0.02, 0.14, 0.338))


def test_what_a_lever_scrapes_on_its_way_is_cut_back():
    _, _, result = cut_free([*POST, STOP], LEVER, TURN)
    assert 0.005 < max(each.depth_m for each in result.trimmed[PAIR]) < CONFIG.scraped_m


SHIFT = 0.05 * 0.7
TWINS = {
    "shifted along its arm": replace(TURN, origin=TURN.origin + SHIFT * ALONG),
    "shifted away from it": replace(TURN, origin=TURN.origin - SHIFT * ALONG),
    "shifted across": replace(TURN, origin=TURN.origin + SHIFT * np.array([0.0, 1.0, 0.0])),
    "tilted": replace(TURN, axis=rotation_about(ALONG, -np.radians(10.0)) @ UP),
    "tilted the other way": replace(TURN, axis=rotation_about(ALONG, np.radians(10.0)) @ UP),
    "lying": replace(TURN, axis=np.array([0.0, 1.0, 0.0])),
}


@pytest.mark.parametrize("name", TWINS)
def test_a_lever_that_is_hung_wrongly_is_not_cut_free(name):
    require_refused([*POST, STOP], LEVER, TWINS[name])


def test_what_a_long_arm_passes_between_two_poses_is_cut_too():
    # Its end goes 26 mm in a step; it is 8 mm thick, the fin half a step further 5.
    angle = 10.5 * np.pi / 2.0 / (CONFIG.poses - 1)
    fin = box((0.76, -0.0025, 0.095), (0.8, 0.0025, 0.2))
    fin.apply_transform(trimesh.transformations.rotation_matrix(angle, UP))
    arm = box((0.0, -0.004, 0.0), (0.8, 0.004, 0.1))
    turn = replace(TURN, origin=np.zeros(3))
    floor = box((-0.2, -0.2, -0.1), (0.9, 0.9, -0.05))
    cut_free([floor, fin], [arm], turn, poses=900)


@pytest.mark.parametrize("share", np.linspace(0.0, 0.8, 5))
def test_what_leaves_its_frame_keeps_the_distance_that_engines_feel(share):
    # Its round end passes a round post at 1.3 mm, in the first tenth of its way.
    end = cylinder(0.002, 0.0, 0.1, 12).apply_translation([0.8, 0.0, 0.0])
    post = cylinder(0.002, 0.0, 0.1, 12).apply_translation([0.8 + 0.004 + 0.0013, 0.0, 0.0])
    angle = 0.1 + share * 0.005
    post.apply_transform(trimesh.transformations.rotation_matrix(angle, UP))
    arm = box((0.0, -0.002, 0.0), (0.8, 0.002, 0.1))
    floor = box((-0.2, -0.2, -0.1), (0.9, 0.9, -0.05))
    tree, _, result = cut([floor, post], [arm, end], replace(TURN, origin=np.zeros(3)))
    assert result.refused == {}
    assert -deepest(tree, result, poses=800, gap=CONFIG.clearance_m, share=0.1) > 0.0018
