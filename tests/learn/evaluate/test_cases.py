import csv
import re
from dataclasses import replace

import numpy as np
import pytest
from boxy_urdf import write_cabinets
from cupboards import cupboard, hinge

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.geometry.components import connected_components
from asset_factory.factory.geometry.posing import face_parts
from asset_factory.factory.geometry.triangles import face_areas
from asset_factory.learn.bodies import bodies_of, face_centres
from asset_factory.learn.evaluate.cases import (
    folder_requests,
    in_settings,
    make_case,
    procedural_requests,
)
from asset_factory.learn.evaluate.listing import COLUMNS, HALVES, half_of, list_text, real_requests
from asset_factory.learn.evaluate.physical import physical
from asset_factory.learn.evaluate.transfer import merged
from asset_factory.learn.objects.export import write_sample

HEAD = f"{','.join(COLUMNS)}\n"
CABINETS = ["made__one__one--closed-front", "made__two__two--closed-front"]


def bits(articulation):
    """What is the same of articulations that are equal to the last bit."""
    lines = [(j.name, j.lower, j.upper, *j.axis, *j.origin) for j in articulation.joints]
    mesh = articulation.mesh
    return mesh.vertices.tobytes(), mesh.faces.tobytes(), face_parts(articulation).tobytes(), lines


def cases(root, poses=("closed",), yaws=("front",), kept=None):
    objects = real_requests(root, None, root / "list.csv")
    return [make_case(request, kept) for request in in_settings(objects, poses, yaws)]


@pytest.fixture(scope="module")
def fused():
    """A fridge made one piece, and what asks for it."""
    (request,) = procedural_requests(("fridge",), (3,))
    request = replace(request, fused=True)
    return request, make_case(request)


def test_the_packages_list_is_sound_and_halved_by_its_rule():
    rows = list(csv.DictReader(list_text().splitlines()))
    assert len(rows) == len({row["path"].rpartition(".")[0] for row in rows}) == 259
    assert {row["half"] for row in rows} == set(HALVES)
    assert len({row["shape"] for row in rows}) < len(rows)
    for row in rows:
        # So objects of one shape are in one half; another rule would move those written down.
        assert row["half"] == half_of(row["shape"])
        assert re.fullmatch(r"[0-9a-f]{64}", row["digest"])
        assert row["front_yaw"] == "" or float(row["front_yaw"]) in (-90.0, 0.0, 90.0, 180.0)
        assert row["category"] == row["category"].lower() != ""
    assert 0.4 < np.mean([row["half"] == "develop" for row in rows]) < 0.6


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("path,source\n", "no column 'category'"),
        (f"{HEAD}a,s,c,d,a,{HALVES[half_of('a') == HALVES[0]]},\n", "line 2: half is"),
        (f"{HEAD},s,c,d,a,{half_of('a')},\n", "line 2: want a path"),
        (f"{HEAD}a,s,c,d,a,{half_of('a')},left\n", "not 'left'"),
    ],
)
def test_a_bad_list_is_refused(tmp_path, text, message):
    (tmp_path / "list.csv").write_text(text)
    with pytest.raises(ConfigError, match=message):
        real_requests(tmp_path, None, tmp_path / "list.csv")


def test_nothing_but_the_surface_is_left_of_how_a_mesh_was_put_together():
    """In whatever order parts and faces come, the same surface gives the same places."""
    door = cupboard(hinge())
    one, other = (merged(door, np.random.default_rng(seed)) for seed in (1, 2))
    assert not np.array_equal(one.mesh.faces, other.mesh.faces)
    parts = face_parts(one)
    # Runs of faces of one part are as short as chance makes them.
    assert np.count_nonzero(np.diff(parts)) == pytest.approx(len(parts) / 2, rel=0.1)
    assert len(one.mesh.materials) == 1
    for part in range(2):
        areas = [face_areas(a.mesh)[face_parts(a) == part].sum() for a in (door, one, other)]
        assert areas == pytest.approx([1.0] * 3)
    # Vertices are numbered as the faces use them.
    flat = one.mesh.faces.ravel()
    first_uses = flat[np.sort(np.unique(flat, return_index=True)[1])]
    assert np.array_equal(first_uses, np.arange(len(one.mesh.vertices)))


def test_vertices_are_welded_across_parts():
    touching = cupboard(hinge())
    lowered = touching.mesh.vertices.copy()
    lowered[:, 1] = 0.0  # the front lies in the wall
    mesh = replace(touching.mesh, vertices=lowered)
    whole = merged(replace(touching, mesh=mesh), np.random.default_rng(0))
    assert len(whole.mesh.vertices) == len(lowered) / 2
    assert len(whole.mesh.faces) == len(touching.mesh.faces)


def test_a_case_is_closed_with_its_front_towards_minus_y(tmp_path):
    objects = real_requests(tmp_path, None, write_cabinets(tmp_path))
    assert [request.name for request in objects] == CABINETS
    assert objects[0].category == "cabinet"
    truth = make_case(objects[0])
    assert [joint.lower for joint in truth.joints] == [0.0, 0.0]
    bodies = bodies_of(truth)
    centres = face_centres(truth.mesh)
    assert len(bodies) == 3
    for body in (1, 2):
        moved = bodies.centres_at(0.25)[bodies.labels == body] - centres[bodies.labels == body]
        assert moved.mean(axis=0)[1] < -0.01
        assert centres[bodies.labels == body].mean(axis=0)[1] < -0.19


def test_open_cases_are_in_range_and_the_truth_still_fits_them(tmp_path):
    write_cabinets(tmp_path)
    shut, wide = (cases(tmp_path, (pose,), ("random",))[0] for pose in ("closed", "open"))
    for before, after in zip(shut.joints, wide.joints, strict=True):
        assert after.lower < 0.0 < after.upper
        assert after.range == pytest.approx(before.range)
    assert physical(wide, wide).values["articulated_iou"] == pytest.approx(1.0)


def test_a_case_is_the_same_again_with_and_without_what_was_kept(tmp_path):
    write_cabinets(tmp_path)
    folder = tmp_path / "kept"
    drawn = (("closed", "open"), ("front", "random"))
    read, kept, anew = (cases(tmp_path, *drawn, each) for each in (folder, folder, None))
    assert len(read) == 8
    assert [bits(a) for a in read] == [bits(a) for a in kept] == [bits(a) for a in anew]
    yaws = {tuple(a.joints[1].axis.round(6)) for a in read}
    assert len(yaws) == 5  # two objects of one front; four different random ones


def test_another_file_than_the_listed_one_is_refused(tmp_path):
    file = real_requests(tmp_path, None, write_cabinets(tmp_path))[0].file
    file.write_text(file.read_text() + "\n")
    with pytest.raises(ConfigError, match="want the file that was listed"):
        cases(tmp_path)
    file.unlink()
    with pytest.raises(ConfigError, match="no such file"):
        cases(tmp_path)


def test_a_folder_of_objects_with_joints(tmp_path):
    write_cabinets(tmp_path / "things")
    requests = folder_requests(tmp_path / "things")
    assert [request.name for request in requests] == CABINETS
    assert len(make_case(requests[0]).movable_joints) == 2
    (tmp_path / "empty").mkdir()
    with pytest.raises(ConfigError, match="holds no URDF"):
        folder_requests(tmp_path / "empty")


def test_skins_are_the_annotated_meshes_of_a_folder(tmp_path, fused):
    write_cabinets(tmp_path / "described")
    with pytest.raises(ConfigError, match="holds no mesh with an annotation"):
        folder_requests(tmp_path, skins=True)
    write_sample(fused[1], tmp_path / "fridge_3")
    (request,) = folder_requests(tmp_path, skins=True)
    assert (request.source, request.category) == ("skins", "fridge")
    assert len(make_case(request).movable_joints) == len(fused[1].movable_joints)


def test_a_fused_case_is_one_skin_whose_truth_is_the_objects_own(fused):
    request, skin = fused
    whole = replace(request, fused=False)
    assert request.name == f"{whole.name}-fused"
    plain = make_case(whole)
    assert len(np.unique(connected_components(skin.mesh))) < 5
    assert len(np.unique(connected_components(plain.mesh))) > 10
    for one, other in zip(plain.joints, skin.joints, strict=False):
        assert abs(one.axis @ other.axis) > 0.999
    np.testing.assert_allclose(skin.mesh.extents, plain.mesh.extents, rtol=0.1)
