"""Cuts keep the surface; small things in a row are knobs, and handles where seams part them."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.samples import one_piece

from asset_factory.factory.articulate.seams.controls import with_strips
from asset_factory.factory.articulate.seams.cutting import Region, cut_along, inside
from asset_factory.factory.articulate.seams.handles import Face, Protrusion
from asset_factory.factory.articulate.seams.knobs import knobs_of
from asset_factory.factory.articulate.seams.rectangles import Lines
from asset_factory.factory.articulation import JointKind
from asset_factory.factory.geometry.triangles import face_areas
from asset_factory.factory.part import PartKind


def box_region(low, high):
    normals = np.concatenate([np.eye(3), -np.eye(3)])
    return Region(normals, np.concatenate([high, -np.array(low)]))


def open_edges(mesh):
    """Edges that are not there exactly once in each direction."""
    edges = mesh.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    forward = {(int(a), int(b)) for a, b in edges}
    return sum((b, a) not in forward for a, b in forward) + len(edges) - len(forward)


@settings(max_examples=15, deadline=None)
@given(
    low=st.lists(st.floats(-0.1, 0.5), min_size=3, max_size=3),
    size=st.lists(st.floats(0.02, 0.6), min_size=3, max_size=3),
)
def test_a_cut_keeps_the_surface(low, size):
    plain = one_piece.fridge()
    corners = plain.vertices[plain.faces]
    normals = np.broadcast_to(np.array([0.0, 0.6, 0.8]), corners.shape)
    # Texture coordinates and normals are linear in the position.
    mesh = replace(plain, corner_uv=corners[:, :, [0, 2]], corner_normals=normals)
    cut = cut_along(mesh, [box_region(low, [a + b for a, b in zip(low, size, strict=True)])])
    assert open_edges(cut.mesh) == open_edges(mesh) == 0
    assert face_areas(cut.mesh).sum() == pytest.approx(face_areas(mesh).sum(), rel=1e-9)
    corners = cut.mesh.vertices[cut.mesh.faces]
    assert cut.mesh.corner_uv is not None
    assert cut.mesh.corner_normals is not None
    assert np.allclose(cut.mesh.corner_uv, corners[:, :, [0, 2]], atol=1e-9)
    assert np.allclose(cut.mesh.corner_normals, [0.0, 0.6, 0.8])
    assert (mesh.face_material[cut.source] == cut.mesh.face_material).all()


def test_no_triangle_is_on_both_sides():
    mesh = one_piece.fridge()
    region = box_region([0.1, -1.0, 0.2], [0.45, 0.1, 1.3])
    cut = cut_along(mesh, [region])
    within = inside(cut.mesh, region)
    corners = cut.mesh.vertices[cut.mesh.faces[within]]
    assert within.any()
    slack = 2e-5 * mesh.diagonal
    assert (corners >= np.array([0.1, -1.0, 0.2]) - slack).all()
    assert (corners <= np.array([0.45, 0.1, 1.3]) + slack).all()
    outside = cut.mesh.vertices[cut.mesh.faces[~within]].mean(axis=1)
    center = np.array([0.275, -0.45, 0.75])
    half = np.array([0.175, 0.55, 0.55])
    assert not (np.abs(outside - center) < half - slack).all(axis=1).any()


def test_what_needs_no_cut_is_not_cut():
    mesh = one_piece.fridge()
    assert cut_along(mesh, [box_region([-1.0, -1.0, -1.0], [2.0, 2.0, 2.0])]).mesh is mesh


def lines(at, length):
    sums = np.tile(np.arange(length + 1.0), (len(at), 1))
    return Lines(np.array(at, np.int64), sums, sums, sums)


@pytest.mark.parametrize(("parted", "wanted"), [(False, True), (True, False)])
def test_knobs_far_apart_on_one_strip_turn_unless_seams_part_them(parted, wanted):
    corners = [np.array([90, column]) for column in (20, 90, 160)]
    knobs = tuple(Protrusion(corner, corner + 7, 6.0, 1.0) for corner in corners)
    face = Face(np.zeros((120, 200)), np.zeros((120, 200), np.bool_), knobs)
    level = lines([75, 110], 200)
    upright = lines([60, 130] if parted else [], 120)
    assert all(each.control is wanted for each in with_strips(face, level, upright))


@pytest.mark.parametrize(
    ("name", "axis", "places"),
    [
        ("stove", (0, 1, 0), [(0.28, 0.78), (0.35, 0.78), (0.42, 0.78)]),
        ("microwave", (0, 1, 0), [(0.525, 0.1), (0.525, 0.16), (0.525, 0.22)]),
        ("cooktop", (0, 0, -1), [(0.2, 0.06), (0.3, 0.06), (0.4, 0.06), (0.5, 0.06)]),
    ],
)
def test_knobs_are_cut_out_and_turn_about_their_middles(name, axis, places):
    found = knobs_of(getattr(one_piece, name)(), "auto")
    assert [part.kind for part in found.parts[1:]] == [PartKind.KNOB] * len(places)
    across = [0, 1] if axis[2] else [0, 2]
    at = sorted(tuple(joint.origin[across].tolist()) for joint in found.joints)
    assert np.allclose(at, sorted(places), atol=0.01)
    for joint in found.joints:
        assert joint.kind is JointKind.CONTINUOUS
        assert joint.axis == pytest.approx(axis)


@pytest.mark.parametrize(
    "name", ["filing_cabinet", "bars_that_meet", "buttons", "moulding", "table"]
)
def test_buttons_and_handles_are_no_knobs(name):
    assert not knobs_of(getattr(one_piece, name)(), "auto").joints
