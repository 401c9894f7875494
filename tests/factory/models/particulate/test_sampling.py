"""The network's points: where they lie, what they know, and that the way back is exact."""

import json

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from plain_solids import surface_of
from stored_arrays import arrays

from asset_factory.factory.models.particulate.components import (
    COMPONENT_FEATURES,
    component_features,
)
from asset_factory.factory.models.particulate.frames import UnitBox
from asset_factory.factory.models.particulate.sampling import draw, sample
from asset_factory.factory.models.particulate.surface import Surface

SHARP_MESHES = ("box", "cyl10", "ico", "plus", "thin_wedge")


def by_place(ends, values):
    """Edges with a value each, in an order that depends on their places alone."""
    places = [sorted(map(tuple, np.round(pair, 9).tolist())) for pair in ends]
    return sorted((*pair, *np.round(v, 6)) for pair, v in zip(places, values, strict=True))


@pytest.mark.parametrize("name", SHARP_MESHES)
def test_sharp_edges_are_those_the_network_was_trained_on(fixtures, name):
    held = arrays(fixtures / "geometry" / "sharp_edges.npz")
    vertices = held[f"{name}_vertices"]
    faces = held[f"{name}_faces"]
    surface = Surface.of(vertices, faces)
    found = surface.sharp
    ours = by_place(surface.vertices[surface.edges.ends[found.edges]], found.normals)
    edges = held[f"{name}_sharp_edges"]
    normals = held[f"{name}_sharp_edge_normal_unnormalised_mean"]
    assert [row[:2] for row in ours] == [row[:2] for row in by_place(vertices[edges], normals)]
    ours_normals = np.array([row[2:] for row in ours])
    theirs_normals = np.array([row[2:] for row in by_place(vertices[edges], normals)])
    assert np.allclose(ours_normals, theirs_normals, atol=2e-6)


@pytest.mark.parametrize("count", [20, 256])
@pytest.mark.parametrize("name", [*SHARP_MESHES, "cyl12"])
def test_half_the_points_are_sharp_and_every_face_has_one(fixtures, name, count):
    held = arrays(fixtures / "geometry" / "sharp_edges.npz")
    counts = json.loads((fixtures / "geometry" / "notes.json").read_text())["sample_point_counts"]
    surface = Surface.of(held[f"{name}_vertices"], held[f"{name}_faces"])
    cloud = draw(surface, count, np.random.default_rng(0), most_covered=10**6)
    want = counts[f"{name}_N{count}_alo"]
    assert (len(cloud.points), int(cloud.sharp.sum())) == (want["total"], want["sharp"])
    assert len(np.unique(cloud.faces[~cloud.sharp])) == want["faces"]


def test_points_lie_on_their_faces_and_are_spread_by_area():
    surface = surface_of(trimesh.creation.box(extents=(1.0, 2.0, 4.0)))
    cloud = draw(surface, 40_000, np.random.default_rng(1), most_covered=0)
    across = cloud.points - surface.vertices[surface.faces[cloud.faces, 0]]
    off = np.einsum("ij,ij->i", across, surface.normals[cloud.faces])
    assert np.abs(off).max() < 1e-12
    flat = ~cloud.sharp
    share = np.bincount(cloud.faces[flat], minlength=12) / flat.sum()
    assert np.allclose(share, surface.areas / surface.areas.sum(), atol=0.01)
    # Within a face the mean of uniform points is the centroid.
    for face in range(12):
        mean = cloud.points[flat & (cloud.faces == face)].mean(axis=0)
        assert np.allclose(mean, surface.vertices[surface.faces[face]].mean(axis=0), atol=0.08)


def test_sharp_points_carry_the_mean_of_two_normals_as_it_is():
    surface = surface_of(trimesh.creation.box())
    cloud = draw(surface, 2000, np.random.default_rng(2), most_covered=0)
    assert np.allclose(np.linalg.norm(cloud.normals[cloud.sharp], axis=1), np.sqrt(0.5))
    assert np.allclose(np.linalg.norm(cloud.normals[~cloud.sharp], axis=1), 1.0)
    on_border = (np.abs(np.abs(cloud.points[cloud.sharp]) - 0.5) < 1e-12).sum(axis=1)
    assert (on_border >= 2).all()


def test_the_same_seed_gives_the_same_points_and_another_gives_others():
    surface = surface_of(trimesh.creation.cylinder(1.0, 2.0, sections=10))
    one, again, other = (
        sample(surface, 500, 300, 10**6, np.random.default_rng(seed)) for seed in (7, 7, 8)
    )
    assert np.array_equal(one.cloud.points, again.cloud.points)
    assert np.array_equal(one.context.points, again.context.points)
    assert not np.array_equal(one.cloud.points, other.cloud.points)


def test_split_and_welded_meshes_give_the_same_points():
    """Where we leave the release: split vertices cost it every sharp edge and every neighbour."""
    surface = surface_of(trimesh.creation.cylinder(1.0, 2.0, sections=10))
    corners = surface.vertices[surface.faces].reshape(-1, 3)
    split = Surface.of(corners, np.arange(len(corners)).reshape(-1, 3))
    points = [sample(s, 400, 100, 10**6, np.random.default_rng(0)).cloud for s in (surface, split)]
    for cloud in points:
        assert int(cloud.sharp.sum()) == 200
    assert np.array_equal(np.sort(points[0].faces[200:]), np.sort(points[1].faces[200:]))


def test_of_too_many_faces_only_the_largest_are_sure_of_a_point():
    surface = surface_of(trimesh.creation.box(extents=(1.0, 2.0, 4.0)))
    cloud = draw(surface, 8, np.random.default_rng(0), most_covered=4)
    assert len(cloud.points) == 8
    assert set(cloud.faces[4:]) == set(np.argsort(-surface.areas, kind="stable")[:4])


def test_faces_without_area_get_no_point_and_make_no_edge_sharp():
    box = trimesh.creation.box()
    vertices = np.vstack([box.vertices, [[0.0, 0.0, 0.5]]])
    corner = int(np.flatnonzero((box.vertices == [0.5, 0.5, 0.5]).all(axis=1))[0])
    opposite = int(np.flatnonzero((box.vertices == [-0.5, -0.5, 0.5]).all(axis=1))[0])
    faces = np.vstack([box.faces, [[corner, 8, opposite], [corner, corner, 8]]])
    surface = Surface.of(vertices, faces)
    assert len(surface.sharp.edges) == 12
    cloud = draw(surface, 300, np.random.default_rng(0), most_covered=100)
    assert cloud.faces[~cloud.sharp].max() == 11
    assert np.isfinite(cloud.normals).all()


def test_the_network_sees_the_box_of_the_points_and_the_way_back_is_exact():
    """Where we leave the release: it scales twice, undoes neither; a cone is 0.46 percent off."""
    cone = trimesh.creation.cone(radius=3.0, height=5.0, sections=32)
    surface = surface_of(cone.apply_translation([70.0, -2.0, 9.0]))
    seen = sample(surface, 2000, 1000, 10**6, np.random.default_rng(0))
    both = np.concatenate([seen.context.points, seen.cloud.points])
    inside = seen.box.inside(both)
    assert np.allclose(inside.min(axis=0) + inside.max(axis=0), 0.0, atol=1e-12)
    assert np.ptp(inside, axis=0).max() == pytest.approx(1.0, abs=1e-12)
    out = seen.box.outwards
    assert np.allclose(inside @ out[:3, :3].T + out[:3, 3], both, atol=1e-12)
    mesh_box = UnitBox.around(surface.vertices)
    # For a cone the two boxes differ, so that undoing only one would show.
    assert np.abs(inside - mesh_box.inside(both)).max() > 1e-3


@given(st.integers(0, 10**6))
def test_two_boxes_are_one(seed):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(20, 3)) * 10.0 ** rng.uniform(-3, 3) + rng.normal(size=3) * 5
    outer = UnitBox.around(points)
    inner = UnitBox.around(outer.inside(points[:7]))
    nested = inner.inside(outer.inside(points))
    assert np.allclose(outer.then(inner).inside(points), nested, atol=1e-9)


def test_components_survive_sheets_and_boxes_that_touch():
    box = trimesh.creation.box()
    touching = box.copy().apply_translation([1.0, 1.0, 0.0])
    assert surface_of(box, touching).components.max() == 1
    sheet = np.array([[0, 1, 2], [0, 2, 3], [2, 1, 0], [3, 2, 0]])
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    assert Surface.of(corners, sheet).components.max() == 0


def test_two_components_are_told_by_their_boxes_and_points_by_their_place_in_them():
    points = np.array([[-0.5, 0, 0], [0, 0, 0.2], [0.1, 0, 0], [0.5, 0.4, 0]])
    normals = np.tile([0.0, 0.0, -1.0], (4, 1))
    found = component_features(points, normals, np.array([7, 7, 3, 3]))
    assert found.shape == (4, COMPONENT_FEATURES)
    np.testing.assert_allclose(found[0, :9], [-0.5, 0, 0, 0, 0, 0.2, -0.25, 0, 0.1], atol=1e-6)
    np.testing.assert_allclose(found[2, 9:12], [0.2, 0.2, 0], atol=1e-6)
    np.testing.assert_allclose(found[:, 12:18], np.tile([0, 0, -1, 0, 0, 1], (4, 1)), atol=1e-6)
    np.testing.assert_allclose(found[:, 19], [-1, 1, -1, 1], atol=1e-6)
    np.testing.assert_allclose(found[:, 22:25], np.tile([1.0, 0.4, 0.2], (4, 1)), atol=1e-6)
    # A mesh of one piece says so.
    assert not found[:, 26].any()
    assert component_features(points, normals, np.zeros(4, dtype=np.int64))[:, 26].all()


def test_numbers_of_components_mean_nothing():
    rng = np.random.default_rng(1)
    points = rng.normal(size=(60, 3))
    normals = rng.normal(size=(60, 3))
    components = rng.integers(0, 5, 60)
    renamed = np.array([40, 2, 9, 17, 3])[components]
    found = component_features(points, normals, components)
    np.testing.assert_allclose(found, component_features(points, normals, renamed), rtol=1e-6)
