"""Exported meshes: nothing lost, nothing invented, every simulator's rules kept."""

import io
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from export_samples import box, hull_of, image
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from asset_factory.factory.export.meshes import hull_obj, material_mtl, visual_obj
from asset_factory.factory.export.text import number, vector
from asset_factory.factory.export.visuals import TextureFolder, png_bytes
from asset_factory.factory.mesh import Material, Mesh, Texture


def load(text):
    return trimesh.load(io.StringIO(text), file_type="obj", process=False, maintain_order=True)


@given(st.floats(-1e6, 1e6))
def test_a_number_reads_back_within_half_a_nanometre(value):
    # Far from zero, neighbouring doubles are themselves that far apart.
    assert abs(float(number(value)) - value) <= 0.5e-9 + 2.0 * np.spacing(abs(value))


def test_negative_zero_is_written_as_zero():
    assert vector([-0.0, -1e-12, 1.0, 0.5]) == "0 0 1 0.5"


def test_an_exported_hull_has_the_same_corners_and_volume():
    hull = hull_of(box([1.0, 2.0, 3.0], [0.1, 0.2, 0.3]))
    loaded = load(hull_obj(hull, np.array([1.0, 2.0, 3.0])))
    assert len(loaded.vertices) == 8
    assert loaded.volume == pytest.approx(hull.volume)
    assert np.allclose(loaded.bounds, [[-0.05, -0.1, -0.15], [0.05, 0.1, 0.15]])


def test_welded_vertices_stay_welded_and_a_box_keeps_its_sharp_edges():
    text = visual_obj(box([0, 0, 0], [1, 1, 1]), np.zeros(3), "x")
    assert text.count("\nv ") == 8
    assert text.count("\nvn ") == 6
    assert text.count("\nf ") == 12


def test_a_missing_texture_coordinate_does_not_reach_the_file():
    mesh = box([0, 0, 0], [1, 1, 1])
    uv = np.full((12, 3, 2), np.nan)
    uv[:6] = 0.25
    text = visual_obj(replace(mesh, corner_uv=uv), np.zeros(3), "m")
    assert "nan" not in text
    texels = [line for line in text.splitlines() if line.startswith("vt")]
    assert texels == ["vt 0 0", "vt 0.25 0.25"]


def test_given_normals_are_kept_and_missing_ones_are_the_faces_own():
    mesh = Mesh.from_triangles([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    normals = np.full((1, 3, 3), np.nan)
    normals[0, 0] = [1.0, 0.0, 0.0]
    text = visual_obj(replace(mesh, corner_normals=normals), np.zeros(3), "m")
    assert [line for line in text.splitlines() if line.startswith("vn")] == ["vn 0 0 1", "vn 1 0 0"]
    assert text.splitlines()[-1] == "f 1//2 2//1 3//1"
    # A lone triangle is padded to the four vertices that MuJoCo wants.
    assert text.count("\nv ") == 4


def test_a_material_names_its_texture_and_colour():
    text = material_mtl(Material("wood", (0.5, 0.25, 1.0, 0.5)), "door_0", "texture.png")
    look = ["Kd 0.5 0.25 1", "Ks 0 0 0", "d 0.5", "illum 1", "map_Kd texture.png"]
    assert text.splitlines() == ["newmtl door_0", *look]


def test_pictures_become_plain_pngs_and_one_that_is_keeps_its_bytes():
    texture = image((0, 0, 0), "JPEG")
    decoded = Image.open(io.BytesIO(png_bytes(texture)))
    assert decoded.format == "PNG"
    assert np.array_equal(np.asarray(decoded), np.asarray(Image.open(io.BytesIO(texture.data))))
    buffer = io.BytesIO()
    Image.new("P", (4, 4), 3).save(buffer, format="PNG")
    assert Image.open(io.BytesIO(png_bytes(Texture(buffer.getvalue(), ".png")))).mode == "RGB"
    plain = image((1, 2, 3))
    assert png_bytes(plain) == plain.data


def test_a_broken_image_leaves_a_plain_colour_and_a_sentence(tmp_path):
    textures = TextureFolder(tmp_path)
    assert textures.file_name(Material("wood", texture=Texture(b"not an image", ".png"))) is None
    assert "'wood'" in textures.notes[0]
    assert list(tmp_path.iterdir()) == []
