"""What is hollow must stay hollow: the free inside of a link that its collision shapes leave."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from box_world import body, box_shape
from fault_corpus.good_things import carcass, drawer
from fault_corpus.things import Body, Thing, at, box, write_mjcf, write_urdf
from hypothesis import given, settings
from hypothesis import strategies as st

from asset_factory.sim_checks.checks.lint_interior import interior_findings
from asset_factory.sim_checks.config import LintConfig
from asset_factory.sim_checks.description import DescribedShape, Link
from asset_factory.sim_checks.geometry.hull import convex_hull
from asset_factory.sim_checks.geometry.kinematics import rotation_about
from asset_factory.sim_checks.read.primitives import cylinder
from asset_factory.sim_checks.read.read import read_here

T = 0.018
DOWN = np.array([0.0, 0.0, -1.0])
#: An open-fronted box of boards, 0.6 x 0.4 x 0.8 m, its opening towards -y.
BOARDS = (
    ((-0.291, 0.0, 0.4), (T, 0.4, 0.8)),
    ((0.291, 0.0, 0.4), (T, 0.4, 0.8)),
    ((0.0, 0.0, 0.009), (0.564, 0.4, T)),
    ((0.0, 0.0, 0.791), (0.564, 0.4, T)),
    ((0.0, 0.191, 0.4), (0.564, T, 0.764)),
)
CLOSED = (*BOARDS, ((0.0, -0.191, 0.4), (0.564, T, 0.764)))
SOLID = (((0.0, 0.0, 0.4), (0.6, 0.4, 0.8)),)
TABLE = (
    ((0.0, 0.0, 0.7), (1.2, 0.8, 0.03)),
    *(((x, y, 0.34), (0.05, 0.05, 0.68)) for x in (-0.55, 0.55) for y in (-0.35, 0.35)),
)
CRUMB = (((0.0, 0.0, 0.0), (0.01, 0.02, 0.03)),)
#: A drawer, open above.
DRAWER = (
    ((-0.2, 0.0, 0.1), (T, 0.4, 0.2)),
    ((0.2, 0.0, 0.1), (T, 0.4, 0.2)),
    ((0.0, -0.2, 0.1), (0.4, T, 0.2)),
    ((0.0, 0.2, 0.1), (0.4, T, 0.2)),
    ((0.0, 0.0, 0.009), (0.4, 0.4, T)),
)
#: Its inside is a slot too narrow for a hand.
SMALL = tuple((np.multiply(center, 0.06), np.multiply(size, 0.06)) for center, size in DRAWER)
FRONT = (((0.0, 0.0, 0.4), (0.6, T, 0.8)),)
HANDLE = (
    ((0.2, -0.04, 0.3), (0.02, 0.06, 0.02)),
    ((0.2, -0.04, 0.5), (0.02, 0.06, 0.02)),
    ((0.2, -0.065, 0.4), (0.02, 0.02, 0.22)),
)


def seen_and_touched(seen, touched):
    visuals, collisions = (body("part", boxes).visuals for boxes in (seen, touched))
    return Link("part", None, collisions, tuple(replace(shape, kind="mesh") for shape in visuals))


def thin_tube():
    turn = rotation_about(np.array([0.36, 0.48, 0.8]), 0.7)
    vertices, faces = cylinder(0.3, 0.6)
    tube = DescribedShape("tube", "mesh", vertices @ turn.T, faces)
    return Link("part", None, (tube,), (tube,))


def dense_balls(highest):
    """A round shell below a height [m], whose hull's corners against all its faces are 27 GB."""
    ball = trimesh.creation.icosphere(subdivisions=6, radius=0.3)
    shape = DescribedShape("ball", "mesh", np.array(ball.vertices), ball.faces.astype(np.int64))
    shells = tuple(
        replace(s, faces=s.faces[s.vertices[s.faces][:, :, 2].max(axis=1) < highest])
        for s in (shape, replace(shape, vertices=0.9 * shape.vertices))
    )
    return Link("ball", None, (box_shape((0.0, 0.0, -0.125), (0.6, 0.6, 0.35)),), shells)


def told(link, down=DOWN):
    hulls = [convex_hull(shape.vertices) for shape in link.collisions]
    findings, numbers = interior_findings(link, hulls, down, LintConfig())
    assert {finding.code for finding in findings} <= {"interior_filled"}
    return [str(finding.severity) for finding in findings], numbers


@pytest.mark.parametrize(
    ("link", "severities", "interior", "pocket"),
    [
        (seen_and_touched(BOARDS, BOARDS), [], 1.0, 1.0),
        (seen_and_touched(BOARDS, SOLID), ["error"], 0.0, 0.0),
        (seen_and_touched(CLOSED, SOLID), [], None, None),
        (seen_and_touched(SOLID, SOLID), [], None, None),
        (seen_and_touched(CRUMB, CRUMB), [], None, None),
        (thin_tube(), [], None, None),
        (body("part", BOARDS), [], None, None),
        (
            seen_and_touched(TABLE, (((0.0, 0.0, 0.36), (1.2, 0.8, 0.71)),)),
            ["warning"], 0.0, None,
        ),
        (
            seen_and_touched((*FRONT, *HANDLE), (*FRONT, ((0.2, -0.04, 0.4), (0.02, 0.08, 0.22)))),
            [], 1.0, None,
        ),
        (
            seen_and_touched(SMALL, (((0.0, 0.0, 0.006), (0.024, 0.024, 0.012)),)),
            ["warning"], 0.0, None,
        ),
        (dense_balls(1.0), [], None, None),
        (dense_balls(0.05), ["error"], 0.0, 0.0),
    ],
    ids=[
        "boards as hulls leave the whole inside", "one hull leaves nothing",
        "nobody reaches the inside of a closed box", "a solid", "a crumb",
        "a thin tube does not leak whatever its direction", "what is seen as it is touched",
        "a table is no container, so its filled underside is only reported",
        "the gap behind a handle", "a slot too narrow for a hand is no pocket",
        "a dense ball", "a dense bowl",
    ],
)  # fmt: skip
def test_collision_shapes_leave_of_an_inside_what_is_free(link, severities, interior, pocket):
    assert told(link) == (severities, {"interior_kept": interior, "pocket_kept": pocket})


@given(share=st.floats(0.0, 1.0))
@settings(max_examples=15, deadline=None)
def test_the_share_kept_is_the_share_of_the_height_left_free(share):
    block = ((0.0, 0.0, 0.8 * share / 2), (0.6, 0.4, max(0.8 * share, 0.01)))
    severities, numbers = told(seen_and_touched(BOARDS, (*BOARDS, block)))
    # Of the inside, 18 mm to 782 mm high, less a voxel or two along the boards.
    free = np.clip((0.782 - 0.8 * share) / 0.764, 0.0, 1.0)
    assert numbers["pocket_kept"] == pytest.approx(free, abs=0.04)
    assert (severities == ["error"]) == (numbers["pocket_kept"] < 0.5)


def test_a_cap_open_below_is_no_pocket_but_the_same_as_a_drawer_is():
    filled = seen_and_touched(DRAWER, (((0.0, 0.0, 0.1), (0.418, 0.418, 0.2)),))
    assert told(filled, DOWN)[0] == ["error"]
    assert told(filled, -DOWN)[0] == ["warning"]


def test_shapes_that_are_not_seen_as_they_are_touched_are_looked_at():
    link = body("part", BOARDS)
    strip = replace(link, visuals=(*link.visuals, box_shape((0, -0.19, 0.4), (0.5, 0.01, 0.1))))
    assert told(strip)[1]["interior_kept"] == 1.0


def bowl(radius):
    """Staves around a floor, [m]."""
    turns = np.linspace(0.0, 2.0 * np.pi, 13)
    rings = [
        scale * np.column_stack([np.cos(turns), np.sin(turns)]) for scale in (0.85 * radius, radius)
    ]
    staves = [
        np.array([[*ring[k + j], z] for ring in rings for j in (0, 1) for z in (0.0, radius)])
        for k in range(12)
    ]
    return (*staves, box((0.0, 0.0, 0.05 * radius), (1.5 * radius, 1.5 * radius, 0.1 * radius)))


@pytest.mark.parametrize(
    "looks",
    [
        carcass((0.8, 0.6, 0.7)),
        carcass((0.8, 0.8, 1.1)),
        carcass((1.16, 0.31, 1.17)),
        carcass((0.7, 1.2, 0.3)),
        carcass((0.384, 0.3, 0.2)),
        drawer(0.5, 0.1, 0.3, 0.4, (0.5, 0.24)),
        drawer(0.32, 0.0, 0.16, 0.32, (0.32, 0.16)),
        bowl(0.16),
        bowl(0.4),
    ],
)
@pytest.mark.parametrize("share", [0.5, 0.7])
def test_both_formats_of_an_asset_leave_the_same_share_free(looks, share, tmp_path):
    low, high = np.min(looks, axis=(0, 1)), np.max(looks, axis=(0, 1))
    size = (high - low) * [1.0, 1.0, share]
    block = box(low + size / 2.0, size)
    frame = at(0.013, -0.207, 0.31)
    thing = Thing("thing", (Body("body", (*looks, block), frame, 5.0, looks),), ())
    figures = []
    for write in (write_urdf, write_mjcf):
        link = next(link for link in read_here(write(thing, tmp_path)).links if link.visuals)
        figures.append(told(link)[1])
    urdf, mjcf = figures
    assert 0.1 < urdf["interior_kept"] < 0.9
    assert mjcf == pytest.approx(urdf, abs=5e-4)


def test_corners_that_a_format_repeats_change_nothing():
    # So many posts under a dome that their outline is thinned where each triangle has its own.
    places = 0.05 * (np.arange(11.0) - 5.0)
    heights = 0.3 - 0.3 * np.add.outer(places**2, places**2)
    posts = [
        box_shape((x, y, heights[i, j] / 2.0), (0.004, 0.004, heights[i, j]), "mesh")
        for i, x in enumerate(places)
        for j, y in enumerate(places)
    ]
    corners = np.vstack([post.vertices for post in posts])
    faces = np.vstack([post.faces + 8 * i for i, post in enumerate(posts)])
    welded = DescribedShape("posts", "mesh", corners, faces)
    own = np.arange(faces.size).reshape(-1, 3)
    repeated = replace(welded, vertices=corners[faces].reshape(-1, 3), faces=own)
    block = box_shape((0.0, 0.0, 0.2), (0.55, 0.55, 0.2))
    one, other = (told(Link("posts", None, (block,), (shape,)))[1] for shape in (welded, repeated))
    assert 0.1 < one["interior_kept"] < 0.9
    assert one == other
