"""One-piece meshes: the detector tells what opens, and seams tell where it ends."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from manufactured import intake_of
from tests.samples import one_piece

pytest.importorskip("torch")

from asset_factory.factory.articulate.auto.articulator import articulator_for
from asset_factory.factory.articulate.origin import MeshOrigin
from asset_factory.factory.articulation import JointKind, rotation_about
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.mesh import Mesh, concatenate
from asset_factory.learn.objects import make_object

UP = np.array([0.0, 0.0, 1.0])
HINGED = JointKind.REVOLUTE
SLIDES = JointKind.PRISMATIC
TURNS = JointKind.CONTINUOUS
#: What opens: kind, axis (sign matters: positive opens) and a point on the axis; the mirror is x.
OPENS = {
    "fridge": [(HINGED, (0, 0, 1), (0.6, 0, 0))] * 2,
    "drawers": [(SLIDES, (0, -1, 0), None)] * 3,
    "doors": [(HINGED, (0, 0, -1), (0.03, 0, 0)), (HINGED, (0, 0, 1), (0.87, 0, 0))],
    "stove": [
        (HINGED, (1, 0, 0), (0, 0, 0.12)),
        *((TURNS, (0, 1, 0), (x, 0, 0.78)) for x in (0.28, 0.35, 0.42)),
    ],
    "cooktop": [(TURNS, (0, 0, -1), (x, 0.06, 0)) for x in (0.2, 0.3, 0.4, 0.5)],
    "thick_doors": [(HINGED, (0, 0, -1), (0, 0, 0)), (HINGED, (0, 0, 1), (0.9, 0, 0))],
    "tall_drawers": [(SLIDES, (0, -1, 0), None)] * 3,
    "filing_cabinet": [(SLIDES, (0, -1, 0), None)] * 5,
    "proud_drawers": [(SLIDES, (0, -1, 0), None)] * 2,
}
OPENS["doors_with_grown_knobs"] = OPENS["doors"]
STAYS = ("plain_box", "table", "buttons")
#: Turned so far about the vertical [degrees], then scaled along x, y and z.
PLACES = (
    (0.0, (1.0, 1.0, 1.0)),
    (90.0, (-1.0, 1.0, 1.0)),
    (180.0, (0.05, 0.05, 0.05)),
    (270.0, (30.0, 30.0, 30.0)),
    (-7.0, (1.0, 1.0, 1.0)),
    (20.0, (1.0, 1.0, 1.0)),
)


@cache
def watcher():
    """Return who is asked about a mesh that came with nothing."""
    corner = Mesh.from_triangles(np.eye(3), [[0, 1, 2]])
    return articulator_for(intake_of(corner), BuildConfig())


def articulated(mesh):
    return watcher().articulate(mesh)


@cache
def sample(name):
    mesh = one_piece.bumpy(getattr(one_piece, name)(edge=0.03))
    assert MeshOrigin.of(mesh).is_generated
    return mesh


def require(found, name, linear):
    """What opens is what was modelled, moved along by ``linear``, shape [3, 3]; none is certain."""
    assert all(0.0 < (joint.confidence or 0.0) <= 1.0 for joint in found.joints)
    wanted = list(OPENS[name])
    assert len(found.joints) == len(wanted), found.joints
    mirrored = np.linalg.det(linear) < 0.0
    size = float(found.mesh.extents.max())
    for joint in found.joints:
        match = None
        for index, (kind, axis, point) in enumerate(wanted):
            along = linear @ np.array(axis, dtype=float) / np.cbrt(abs(np.linalg.det(linear)))
            if mirrored and kind is HINGED:
                along = -along
            if joint.kind is not kind or float(along @ joint.axis) < 0.99:
                continue
            if point is not None:
                off = joint.origin - linear @ np.array(point, dtype=float)
                off = off - (off @ joint.axis) * joint.axis
                if np.linalg.norm(off) > 0.04 * size:
                    continue
            match = index
        assert match is not None, joint
        wanted.pop(match)


@pytest.mark.parametrize(("number", "name"), list(enumerate(OPENS)))
def test_what_opens_is_found_wherever_it_stands(number, name):
    degrees, sizes = PLACES[number % len(PLACES)]
    pose = np.eye(4)
    pose[:3, :3] = rotation_about(UP, np.radians(degrees)) @ np.diag(sizes)
    require(articulated(sample(name).transformed(pose)), name, pose[:3, :3])


@pytest.mark.parametrize("name", STAYS)
def test_what_does_not_open_stays_rigid_and_says_what_it_looks_like(name):
    found = articulated(sample(name))
    assert not found.joints
    assert any(note.startswith("it looks like a ") for note in found.notes)


def test_the_lid_of_a_bin_opens_upwards():
    # It is seen on all sides, but less probable than what is opened by default.
    found = replace(watcher(), least=0.2).articulate(sample("bin_with_lid"))
    (joint,) = found.joints
    assert joint.kind is HINGED
    lid = found.part_mesh(1)
    assert lid.bounds[0][2] == pytest.approx(0.86, abs=0.07)
    middle = lid.bounds.mean(axis=0)
    assert (joint.motion(0.5) @ np.append(middle, 1.0))[2] > middle[2] + 0.05


def test_a_panel_ends_at_its_seam_and_takes_its_handle_along():
    found = articulated(sample("drawers"))
    low = sorted(found.part_mesh(part).bounds[0, 2] for part in (1, 2, 3))
    assert low == pytest.approx([0.06, 0.34, 0.62], abs=0.01)
    for part in (1, 2, 3):
        bounds = found.part_mesh(part).bounds
        assert bounds[:, 0] == pytest.approx([0.04, 0.76], abs=0.01)
        assert bounds[0, 1] == pytest.approx(-0.03, abs=0.005)


def test_a_door_is_as_thick_as_the_seam_beside_it_shows():
    found = articulated(sample("thick_doors"))
    for part in (1, 2):
        assert found.part_mesh(part).bounds[1][1] == pytest.approx(0.1, abs=0.015)


def test_one_surface_with_crumbs_is_one_piece_and_an_assembly_is_not():
    whole = one_piece.plain_box()
    assert MeshOrigin.of(whole).one_piece
    assert MeshOrigin.of(with_crumb(whole, 0.05)).one_piece
    assert not MeshOrigin.of(with_crumb(whole, 0.8)).one_piece
    assert not MeshOrigin.of(make_object("cabinet", 0).mesh).one_piece


def with_crumb(mesh, size):
    """The same with a small tetrahedron beside it."""
    corners = np.vstack([np.zeros(3), size * np.eye(3)]) + mesh.bounds[1]
    sides = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    return concatenate([mesh, Mesh.from_triangles(corners, sides)])


def test_only_what_bends_a_little_everywhere_is_generated():
    assert not MeshOrigin.of(one_piece.drawers()).is_generated
    assert MeshOrigin.of(sample("drawers")).is_generated
    assert not MeshOrigin.of(one_piece.bumpy(make_object("cabinet", 0).mesh)).is_generated


def kept(mesh, faces):
    left = {"faces": mesh.faces[faces], "face_material": mesh.face_material[faces]}
    return replace(mesh, corner_uv=None, corner_normals=None, **left)


def require_sound(found):
    """Nothing that moves is empty, and where nothing does, a note says so."""
    assert all(len(found.parts[joint.child].faces) for joint in found.joints)
    assert found.joints or found.notes


def test_inside_out_is_read_as_the_right_way_round():
    mesh = sample("fridge")
    turned = replace(mesh, faces=mesh.faces[:, ::-1], corner_normals=None)
    require(articulated(turned), "fridge", np.eye(3))


@pytest.mark.parametrize("axis", range(3))
def test_half_a_skin_has_an_articulation_or_none(axis):
    mesh = sample("doors")
    middle = mesh.vertices[mesh.faces].mean(axis=1)[:, axis]
    require_sound(articulated(kept(mesh, middle < mesh.bounds[:, axis].mean())))


def test_small_holes_hide_nothing():
    mesh = sample("drawers")
    torn = kept(mesh, np.random.default_rng(3).random(len(mesh.faces)) > 0.01)
    require(articulated(torn), "drawers", np.eye(3))


def test_a_ground_plate_is_no_part_of_the_front():
    mesh = sample("fridge")
    low, high = mesh.bounds
    corner = (low[0] - 0.3, low[1] - 0.3, low[2] - 0.02)
    plate = one_piece.mesh_of(one_piece.block(corner, (*(high[:2] + 0.3), low[2])), 1.0)
    require_sound(articulated(concatenate([mesh, plate])))


@pytest.mark.parametrize(
    ("corners", "triangles"),
    [
        ([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]], [[0, 1, 2], [0, 2, 3]]),
        ([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]]),
        ([[0, 0, 0], [0.001, 0, 0], [0, 0.001, 1]], [[0, 1, 2], [2, 1, 0]]),
    ],
    ids=["sheet", "lying", "needle"],
)
def test_sheets_and_needles_are_rigid(corners, triangles):
    assert not articulated(Mesh.from_triangles(corners, triangles)).joints
