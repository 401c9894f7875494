"""One-piece meshes as they should not be: a reading or none, and never a crash."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from tests.samples import one_piece

from asset_factory.factory.articulate.seams import SeamsArticulator
from asset_factory.factory.mesh import Mesh


def kept(mesh, faces):
    return replace(
        mesh,
        faces=mesh.faces[faces],
        corner_uv=None,
        corner_normals=None,
        face_material=mesh.face_material[faces],
    )


def joined(*meshes):
    start = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    return Mesh.from_triangles(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([mesh.faces + at for mesh, at in zip(meshes, start, strict=False)]),
    )


def moved(mesh, *by):
    place = np.eye(4)
    place[:3, 3] = by
    return mesh.transformed(place)


def require_sound(found):
    """Every triangle has one part, every joint is finite, and nothing that moves is empty."""
    owned = np.concatenate([part.faces for part in found.parts])
    assert np.array_equal(np.sort(owned), np.arange(len(found.mesh.faces)))
    assert all(len(found.parts[joint.child].faces) for joint in found.joints)
    for joint in found.joints:
        assert np.isfinite(joint.axis).all()
        assert np.isfinite(joint.origin).all()
    assert found.joints or found.notes


@cache
def read(name):
    return SeamsArticulator().articulate(getattr(one_piece, name)())


def motions(found):
    return sorted((joint.kind.value, joint.axis.round(3).tolist()) for joint in found.joints)


@pytest.mark.parametrize("name", ["fridge", "drawers", "chest"])
def test_inside_out_is_read_as_the_right_way_round(name):
    mesh = getattr(one_piece, name)()
    turned = replace(mesh, faces=mesh.faces[:, ::-1], corner_normals=None)
    wanted = motions(read(name))
    assert wanted
    assert motions(SeamsArticulator().articulate(turned)) == wanted


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("name", ["fridge", "chest"])
def test_half_a_skin_has_a_reading_or_none(name, axis):
    mesh = getattr(one_piece, name)()
    middle = mesh.vertices[mesh.faces].mean(axis=1)[:, axis]
    half = kept(mesh, middle < mesh.bounds[:, axis].mean())
    require_sound(SeamsArticulator().articulate(half))


def test_small_holes_hide_nothing():
    mesh = one_piece.drawers()
    rng = np.random.default_rng(3)
    torn = kept(mesh, rng.random(len(mesh.faces)) > 0.01)
    found = SeamsArticulator().articulate(torn)
    require_sound(found)
    assert motions(found) == motions(read("drawers"))


def test_a_ground_plate_is_no_part_of_the_front():
    mesh = one_piece.fridge()
    low, high = mesh.bounds
    plate = one_piece.mesh_of(
        one_piece._box((low[0] - 0.3, low[1] - 0.3, low[2] - 0.02), (*(high[:2] + 0.3), low[2])),
        1.0,
    )
    found = SeamsArticulator().articulate(joined(mesh, plate))
    require_sound(found)
    assert motions(found) == motions(read("fridge"))


def test_several_objects_in_one_file_have_a_reading_or_none():
    pair = joined(one_piece.fridge(), moved(one_piece.chest(), 1.5, 0.4, 0.0))
    require_sound(SeamsArticulator().articulate(pair))


def test_a_door_that_stands_open_has_a_reading_or_none():
    shut = read("fridge")
    mesh = shut.mesh
    vertices = mesh.vertices[mesh.faces].reshape(-1, 3).copy()
    for joint in shut.joints:
        corners = (3 * shut.parts[joint.child].faces[:, None] + np.arange(3)).ravel()
        motion = joint.motion(1.0)
        vertices[corners] = vertices[corners] @ motion[:3, :3].T + motion[:3, 3]
    opened = Mesh.from_triangles(vertices, np.arange(len(vertices)).reshape(-1, 3))
    require_sound(SeamsArticulator().articulate(opened))


def test_needles_and_points_are_rigid():
    needle = Mesh.from_triangles([[0, 0, 0], [0.001, 0, 0], [0, 0.001, 1]], [[0, 1, 2], [2, 1, 0]])
    assert not SeamsArticulator().articulate(needle).joints
