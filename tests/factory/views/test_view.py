"""What is seen of closed forms from each side, in one order however it is found."""

import io

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from asset_factory.factory.mesh import Material, Mesh, Texture
from asset_factory.factory.views import crossings as module
from asset_factory.factory.views.crossings import crossings, nearest_crossings
from asset_factory.factory.views.raster import Raster, Side
from asset_factory.factory.views.view import elevation


def mesh_of(shape):
    return Mesh.from_triangles(shape.vertices, shape.faces)


BOX = mesh_of(trimesh.creation.box((0.6, 0.4, 0.8)))
OUTWARD = {
    Side.FRONT: (0, -1, 0),
    Side.BACK: (0, 1, 0),
    Side.LEFT: (-1, 0, 0),
    Side.RIGHT: (1, 0, 0),
    Side.TOP: (0, 0, 1),
    Side.BOTTOM: (0, 0, -1),
}


@pytest.mark.parametrize("side", Side)
def test_a_frame_turns_and_looks_inward_and_a_box_is_a_flat_rectangle(side):
    assert np.allclose(side.frame @ side.frame.T, np.eye(3))
    assert np.allclose(side.frame[2], -np.array(OUTWARD[side]))
    # Right, up and away make a left-handed frame, as depth does behind any picture.
    assert np.isclose(abs(np.linalg.det(side.frame)), 1.0)
    seen = elevation(BOX, side, pixels=80)
    width, height = (np.abs(side.frame[:2]) @ BOX.extents) / seen.raster.pixel
    assert seen.seen.sum() == pytest.approx(width * height, rel=0.03)
    assert np.abs(seen.depth[seen.seen]).max() < 1e-9
    assert np.allclose(seen.normal[seen.seen], [0, 0, -1])
    assert not seen.seen[[0, -1]].any()
    assert not seen.seen[:, [0, -1]].any()


@given(st.sampled_from(list(Side)), st.integers(8, 60), st.integers(0, 1000))
def test_pixels_and_points_are_inverse(side, pixels, seed):
    raster = Raster.around(BOX, side, pixels)
    chance = np.random.default_rng(seed)
    rows = chance.integers(0, raster.rows, 5)
    columns = chance.integers(0, raster.columns, 5)
    depth = chance.uniform(0, 1, 5)
    back = raster.pixels(raster.points(rows, columns, depth))
    assert np.allclose(back, np.stack([rows, columns, depth], axis=1))


def test_rays_enter_a_closed_surface_as_often_as_they_leave_it():
    shape = trimesh.creation.torus(0.5, 0.2, major_sections=40, minor_sections=20)
    crossed = crossings(mesh_of(shape), Raster.around(mesh_of(shape), Side.FRONT, 120))
    turns = np.where(crossed.inward, 1, -1)
    per_pixel = np.bincount(crossed.pixel, weights=turns)
    assert (per_pixel == 0).all()
    assert nearest_crossings(mesh_of(shape), crossed.raster).inward.all()
    length = np.bincount(crossed.pixel, weights=-turns * crossed.depth).sum()
    assert length * crossed.raster.pixel**2 == pytest.approx(shape.volume, rel=0.02)


def test_crossings_lie_on_the_triangles_they_name():
    shape = mesh_of(trimesh.creation.icosphere(subdivisions=3, radius=0.5))
    raster = Raster.around(shape, Side.RIGHT, 50)
    found = crossings(shape, raster)
    points = raster.points(found.pixel // raster.columns, found.pixel % raster.columns, found.depth)
    on_face = np.einsum("ij,ijk->ik", found.weights, shape.vertices[shape.faces[found.face]])
    assert np.allclose(points, on_face)


def test_a_texture_is_seen_the_right_way_round():
    image = Image.new("RGB", (2, 2))
    image.putdata([(255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)])
    data = io.BytesIO()
    image.save(data, "PNG")
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1.0]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    mesh = Mesh(
        vertices=corners,
        faces=faces,
        corner_uv=corners[:, [0, 2]][faces],
        corner_normals=None,
        face_material=np.zeros(2, dtype=np.int64),
        materials=(Material("paint", (1.0, 1.0, 1.0, 1.0), Texture(data.getvalue(), ".png")),),
    )
    color = elevation(mesh, Side.FRONT, pixels=20).color
    assert color[18, 3] == pytest.approx([1, 0, 0])
    assert color[18, 18] == pytest.approx([0, 1, 0])
    assert color[3, 3] == pytest.approx([0, 0, 1])
    assert color[3, 18] == pytest.approx([1, 1, 1])


#: Few values, so that pixels and depths are equal often.
PAIRS = st.lists(st.tuples(st.integers(0, 5), st.sampled_from([-0.0, 0.0, 0.25, 0.5])))


@given(PAIRS, st.sampled_from([1, 2**60]))
def test_crossings_are_ordered_by_pixel_depth_and_place(found, scale):
    pixel = np.array([pair[0] for pair in found], dtype=np.int64) * scale
    depth = np.array([pair[1] for pair in found], dtype=np.float64)
    order = module._nearest_first(pixel, depth)
    rows = sorted(zip(pixel, depth, range(len(found)), strict=True))
    assert order.tolist() == [place for _, _, place in rows]


@given(PAIRS)
def test_the_nearest_are_the_first_in_that_order(found):
    pixel = np.array([pair[0] for pair in found], dtype=np.int64)
    depth = np.array([pair[1] for pair in found], dtype=np.float64)
    order = module._nearest_first(pixel, depth)
    first = order[np.flatnonzero(np.diff(pixel[order], prepend=-1))]
    assert module._nearest_only(pixel, depth).tolist() == first.tolist()


def test_how_many_pairs_are_looked_at_in_one_go_changes_nothing(monkeypatch):
    generator = np.random.default_rng(3)
    mesh = Mesh.from_triangles(generator.random((60, 3)), np.arange(60).reshape(20, 3))
    raster = Raster.around(mesh, Side.LEFT, 40)
    whole = crossings(mesh, raster)
    monkeypatch.setattr(module, "_PAIRS", 7)
    parts = crossings(mesh, raster)
    assert len(whole.pixel) > 1000
    for name in ("pixel", "depth", "face", "inward", "weights"):
        assert np.array_equal(getattr(whole, name), getattr(parts, name)), name
