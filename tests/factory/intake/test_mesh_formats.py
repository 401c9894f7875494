"""Every format gives the same cube, textures and materials included; oddities are told."""

import base64
import struct
from pathlib import Path
from unittest.mock import Mock

import numpy as np
import pytest
from fuzz_cases import DAE
from laid import laid
from mesh_cube import TEXTURED, WRITERS, cube, gltf_parts, pack_glb, png, write_glb, write_obj
from plain_solids import signed_volume

from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.intake.files import InputFiles
from asset_factory.factory.intake.images import load_texture
from asset_factory.factory.intake.loading import load_mesh, load_visual
from asset_factory.factory.mesh import Texture

LIMITS = IntakeConfig()
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
PLACES = "property float x\nproperty float y\nproperty float z\n"


def _corners(mesh):
    return np.asarray(mesh.vertices[mesh.faces])


def _normals(mesh):
    a, b, c = np.moveaxis(_corners(mesh), 1, 0)
    return np.cross(b - a, c - a)


def _load(path):
    return load_visual(path, path.parent, LIMITS)


def _looks(mesh):
    """Name, colour and whether there is a texture, of each material."""
    return [(each.name, each.color, each.texture is not None) for each in mesh.materials]


@pytest.mark.parametrize("form", WRITERS)
def test_cube_survives_in_file_order_and_seams_are_welded(form, tmp_path):
    visual = _load(WRITERS[form](tmp_path))
    shape = cube()
    assert visual.mesh.vertices.shape == (8, 3)
    np.testing.assert_allclose(_corners(visual.mesh), shape["positions"][shape["faces"]], atol=1e-7)
    assert signed_volume(visual.mesh) == pytest.approx(1.0)
    assert visual.source_faces.tolist() == list(range(12))
    assert visual.source_face_count == 12


@pytest.mark.parametrize("form", TEXTURED)
def test_texture_bytes_coordinates_and_normals_survive(form, tmp_path):
    mesh = _load(WRITERS[form](tmp_path)).mesh
    shape = cube()
    assert mesh.materials[int(mesh.face_material[0])].texture == Texture(png(), ".png")
    np.testing.assert_allclose(mesh.corner_uv, shape["uv"][shape["faces"]], atol=1e-7)
    np.testing.assert_allclose(mesh.corner_normals, shape["normals"][shape["faces"]], atol=1e-7)


def test_gltf_keeps_base_colour_and_license(tmp_path):
    visual = _load(write_glb(tmp_path))
    assert _looks(visual.mesh) == [("red_wood", (1.0, 0.5, 0.25, 1.0), True)]
    assert visual.license == "CC0-1.0"


def test_obj_keeps_several_materials(tmp_path):
    mesh = _load(write_obj(tmp_path)).mesh
    wood, steel = ("red_wood", (1.0, 1.0, 1.0, 1.0), True), ("steel", (0.5, 0.6, 0.7, 0.5), False)
    assert _looks(mesh) == [wood, steel]
    assert mesh.face_material.tolist() == [0] * 8 + [1] * 4


def test_gltf_applies_nested_transforms_and_every_instance_and_faces_outward(tmp_path):
    quarter = float(np.sqrt(0.5))
    nodes = [
        {"children": [1, 2], "translation": [10, 0, 0]},
        {"mesh": 0, "scale": [2, 2, 2]},
        {"mesh": 0, "rotation": [0, 0, quarter, quarter], "translation": [0, 5, 0]},
        {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -3, 0, 0, 1]},
        {"mesh": 0, "scale": [-1, 1, 1]},
    ]
    mesh = _load(write_glb(tmp_path, nodes=nodes)).mesh
    boxes = [mesh.submesh(np.arange(12 * k, 12 * k + 12)).bounds for k in range(4)]
    np.testing.assert_allclose(boxes[0], [[10, 0, 0], [12, 2, 2]], atol=1e-6)
    np.testing.assert_allclose(boxes[1], [[9, 5, 0], [10, 6, 1]], atol=1e-6)
    np.testing.assert_allclose(boxes[2], [[-3, 0, 0], [-2, 1, 1]], atol=1e-6)
    np.testing.assert_allclose(boxes[3], [[-1, 0, 0], [0, 1, 1]], atol=1e-6)
    assert signed_volume(mesh) == pytest.approx(8 + 1 + 1 + 1)
    assert len(mesh.materials) == 1
    np.testing.assert_allclose(mesh.corner_normals[36:, 0], _normals(mesh)[36:], atol=1e-6)


def _appended(document, binary, *blobs):
    """The binary part with more in it, each a view of its own."""
    for blob in blobs:
        view = {"buffer": 0, "byteOffset": len(binary), "byteLength": len(blob)}
        document["bufferViews"].append(view)
        binary += blob
    document["buffers"][0]["byteLength"] = len(binary)
    return binary


@pytest.mark.parametrize(("mode", "indices"), [(5, [0, 1, 3, 2]), (6, [0, 1, 2, 3])])
def test_gltf_strips_and_fans_become_triangles(mode, indices, tmp_path):
    document, binary = gltf_parts()
    document["meshes"][0]["primitives"][0].update(mode=mode)
    binary = _appended(document, binary, np.array(indices, dtype="<u2").tobytes())
    document["accessors"][3] |= {"bufferView": 5, "count": 4}
    normals = _normals(_load(laid(tmp_path / "quad.glb", pack_glb(document, binary))).mesh)
    np.testing.assert_allclose(normals, [[-1, 0, 0], [-1, 0, 0]], atol=1e-6)


def test_gltf_texture_transform_moves_coordinates(tmp_path):
    transform = {"offset": [0.25, 0.5], "scale": [0.5, 0.25]}
    picture = {"index": 0, "extensions": {"KHR_texture_transform": transform}}
    materials = [{"pbrMetallicRoughness": {"baseColorTexture": picture}}]
    uv = _load(write_glb(tmp_path, materials=materials)).mesh.corner_uv
    assert uv is not None
    u, v = np.moveaxis(cube()["uv"][cube()["faces"]], -1, 0)
    expected = np.stack([0.25 + 0.5 * u, 1 - (0.5 + 0.25 * (1 - v))], axis=-1)
    np.testing.assert_allclose(uv, expected, atol=1e-7)


def test_gltf_sparse_accessor_moves_one_vertex(tmp_path):
    document, binary = gltf_parts()
    moved = np.array([-1, 0, 0], dtype="<f4").tobytes()
    binary = _appended(document, binary, np.zeros(2, dtype="<u2").tobytes(), moved)
    indices = {"bufferView": 5, "componentType": 5123}
    sparse = {"count": 1, "indices": indices, "values": {"bufferView": 6}}
    document["accessors"][0]["sparse"] = sparse
    path = laid(tmp_path / "cube.glb", pack_glb(document, binary))
    assert _load(path).mesh.bounds[0].tolist() == [-1.0, 0.0, 0.0]


def _meshes(*primitives):
    return {"meshes": [{"primitives": primitives}]}


BINARY = gltf_parts()[1]
DATA_URI = f"data:application/octet-stream;base64,{base64.b64encode(BINARY).decode()}"
CUBE = {"attributes": {"POSITION": 0}, "indices": 3}
POINTS = {"attributes": {"POSITION": 0}, "mode": 0}
TWO_COLOURS = {"pbrMetallicRoughness": {"baseColorFactor": [1, 2]}}
#: What is odd -> what of the document is so, faces that are read, and what is told.
ODDITIES = {
    "data uri": ({"buffers": [{"byteLength": len(BINARY), "uri": DATA_URI}]}, 12, ""),
    "no indices": (_meshes({"attributes": {"POSITION": 0}}), 8, ""),
    "points": (_meshes(CUBE, POINTS), 12, "Points or lines of mesh 0 were left out"),
    "no positions": (_meshes(CUBE, {"attributes": {}}), 12, "no positions and was left out"),
    "skin": ({"nodes": [{"mesh": 0, "skin": 0}]}, 12, "stands in its rest pose"),
    "colour": ({"materials": [TWO_COLOURS]}, 12, "which is no RGBA; white was taken"),
}


@pytest.mark.parametrize("oddity", ODDITIES)
def test_an_odd_gltf_is_read_and_its_oddity_told(oddity, tmp_path):
    document, faces, note = ODDITIES[oddity]
    intake = load_mesh(write_glb(tmp_path, **document), LIMITS)
    assert len(intake.mesh.faces) + intake.provenance.dropped_degenerate == faces
    assert note in " ".join(intake.provenance.notes)


def test_a_gltf_of_specular_and_gloss_keeps_its_diffuse_colour(tmp_path):
    told = {"diffuseFactor": [1, 0, 0, 1]}
    materials = [{"extensions": {"KHR_materials_pbrSpecularGlossiness": told}}]
    (material,) = _load(write_glb(tmp_path, materials=materials)).mesh.materials
    assert material.color == (1.0, 0.0, 0.0, 1.0)


def test_obj_understands_negative_indices_and_missing_attributes(tmp_path):
    text = f"{TRIANGLE}vt 0 0\nf -3/-1 -2 -1\nf 1 3 2\n"
    mesh = _load(laid(tmp_path / "t.obj", text)).mesh
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 1]]
    assert np.isnan(mesh.corner_uv[0, 1:]).all()
    assert mesh.corner_normals is None


@pytest.mark.parametrize(
    ("name", "told"), [("cube.mtl", "cube.mtl is missing"), ("wood.png", "wood.png")]
)
def test_an_obj_without_its_library_or_a_whole_texture_loads_and_says_so(tmp_path, name, told):
    path = write_obj(tmp_path)
    if name == "wood.png":
        (tmp_path / name).write_bytes(png()[:30])
    else:
        (tmp_path / name).unlink()
    visual = _load(path)
    assert any(told in note for note in visual.notes)
    assert all(m.texture is None for m in visual.mesh.materials)


def test_only_the_first_of_a_thousand_notes_are_kept(tmp_path):
    path = write_obj(tmp_path)
    pictures = "".join(f"map_Kd {k}{'x' * 200}.png\n" for k in range(1000))
    (tmp_path / "cube.mtl").write_text(f"newmtl a\n{pictures}")
    notes = load_mesh(path, LIMITS).provenance.notes
    assert len(notes) < 50
    assert any(note.endswith("more notes of this kind.") for note in notes)


@pytest.mark.parametrize("error", [struct.error, RuntimeError, AttributeError, OverflowError])
def test_whatever_a_decoder_raises_the_picture_is_left_out(error, monkeypatch):
    monkeypatch.setattr("PIL.Image.open", Mock(side_effect=error("deep inside")))
    assert load_texture(png(), "a.png", InputFiles(Path(), LIMITS)) is None


def test_faces_that_are_not_finite_or_flat_are_dropped_and_counted(tmp_path):
    vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv 2 0 0\nv 0 0 1\n"
    text = f"{vertices}f 1 2 4\nf 1 2 3\nf 1 2 5\nf 1 1 3\nf 1 3 6\n"
    intake = load_mesh(laid(tmp_path / "m.obj", text), LIMITS)
    dropped = (intake.provenance.dropped_non_finite, intake.provenance.dropped_degenerate)
    assert (*dropped, intake.source_faces.tolist()) == (1, 2, [1, 4])


def test_transparency_and_texture_coordinates_of_older_formats_are_read(tmp_path):
    path = laid(tmp_path / "a.obj", f"mtllib a.mtl\nusemtl a\n{TRIANGLE}f 1 2 3\n")
    laid(tmp_path / "a.mtl", "newmtl a\nKd 1 0 0\nTr 0.25\n")
    assert _load(path).mesh.materials[0].color == (1.0, 0.0, 0.0, 0.75)
    corners = "0 0 0 255 0 0 255\n1 0 0 255 0 0 255\n0 1 0 255 0 0 255\n"
    path = laid(tmp_path / "a.off", f"COFF\n3 1 0\n{corners}3 0 1 2\n")
    assert len(_load(path).mesh.faces) == 1
    head = f"ply\nformat ascii 1.0\ncomment TextureFile wood.png\nelement vertex 4\n{PLACES}"
    lists = "property list uchar int vertex_indices\nproperty list uchar float texcoord\n"
    rows = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2 6 0 0 1 0 0 1\n3 0 2 3 6 0 0 0 1 1 1\n"
    laid(tmp_path / "wood.png", png())
    path = laid(tmp_path / "a.ply", f"{head}element face 2\n{lists}end_header\n{rows}")
    np.testing.assert_allclose(_load(path).mesh.corner_uv[0], [[0, 0], [1, 0], [0, 1]])


def test_ply_vertex_colours_become_one_linear_colour(tmp_path):
    rows = "0 0 0 188 0 255\n1 0 0 188 0 255\n0 1 0 188 0 255\n"
    head = f"ply\nformat ascii 1.0\nelement vertex 3\n{PLACES}"
    colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n"
    tail = "element face 1\nproperty list uchar int vertex_index\nend_header\n"
    path = laid(tmp_path / "t.ply", head + colors + tail + rows + "3 0 1 2\n")
    color = _load(path).mesh.materials[0].color
    np.testing.assert_allclose(color, (0.5, 0.0, 1.0, 1.0), atol=0.005)


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian"])
def test_ply_mixed_polygons_keep_their_order(form, tmp_path):
    lists = "element face 2\nproperty list uchar int vertex_indices\n"
    head = f"ply\nformat {form} 1.0\nelement vertex 5\n{PLACES}{lists}end_header\n".encode()
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 2, 0]], dtype="<f4")
    polygons = [[0, 1, 2, 3], [3, 2, 4]]
    if form == "ascii":
        body = "".join(f"{x} {y} {z}\n" for x, y, z in points).encode() + b"4 0 1 2 3\n3 3 2 4\n"
    else:
        rows = (bytes([len(p)]) + np.array(p, dtype="<i4").tobytes() for p in polygons)
        body = b"".join((points.tobytes(), *rows))
    faces = _load(laid(tmp_path / "t.ply", head + body)).mesh.faces
    assert faces.tolist() == [[0, 1, 2], [0, 2, 3], [3, 2, 4]]


def test_collada_applies_its_unit_and_nodes(tmp_path):
    text = DAE.format("wood.png").replace('<unit name="meter" meter="1"/>', '<unit meter="0.01"/>')
    lifted = text.replace("<node>", "<node><translate>0 0 3</translate>")
    bounds = _load(laid(tmp_path / "t.dae", lifted)).mesh.bounds
    np.testing.assert_allclose(bounds, [[0.0, 0.0, 0.03], [0.01, 0.01, 0.03]], rtol=1e-6)
