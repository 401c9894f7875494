"""Mesh files that are rare, odd or a little broken: read with a note, or refused with the fault."""

import base64
import struct

import numpy as np
import pytest
from mesh_cube import gltf_parts, pack_glb, png
from refusing import refusal

from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.intake.loading import load_mesh

CONFIG = IntakeConfig()
CORNERS = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
PLY = (
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 2\nproperty list uchar int vertex_indices\n"
    "property list uchar float texcoord\nend_header\n"
    f"{CORNERS}3 0 1 2 6 0 0 1 0 0 1\n3 0 2 3 6 0 0 0 1 1 1\n"
)
LFS = "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n"
OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"


def _glb(folder, change):
    document, binary = gltf_parts()
    binary = change(document, binary) or binary
    (folder / "cube.glb").write_bytes(pack_glb(document, binary))
    return folder / "cube.glb"


def _primitive(document):
    return document["meshes"][0]["primitives"][0]


def _with_data_uri(document, binary):
    payload = base64.b64encode(binary).decode()
    document["buffers"][0]["uri"] = f"data:application/octet-stream;base64,{payload}"


def _without_indices(document, binary):
    del _primitive(document)["indices"]


def _with_points(document, binary):
    document["meshes"][0]["primitives"].append({"attributes": {"POSITION": 0}, "mode": 0})


def _without_positions(document, binary):
    document["meshes"][0]["primitives"].append({"attributes": {}})


def _with_skin(document, binary):
    document["nodes"][0]["skin"] = 0


def _with_two_colours(document, binary):
    document["materials"][0]["pbrMetallicRoughness"] = {"baseColorFactor": [1, 2]}


@pytest.mark.parametrize(
    ("change", "faces", "note"),
    [
        (_with_data_uri, 12, ""),
        (_without_indices, 8, ""),
        (_with_points, 12, "Points or lines of mesh 0 were left out"),
        (_without_positions, 12, "has no positions and was left out"),
        (_with_skin, 12, "stands in its rest pose"),
        (_with_two_colours, 12, "which is no RGBA; white was taken"),
    ],
)
def test_an_odd_gltf_is_read_and_its_oddity_told(change, faces, note, tmp_path):
    intake = load_mesh(_glb(tmp_path, change), CONFIG)
    assert len(intake.mesh.faces) + intake.provenance.dropped_degenerate == faces
    assert note in " ".join(intake.provenance.notes)


def test_a_gltf_of_specular_and_gloss_keeps_its_diffuse_colour(tmp_path):
    def glossy(document, binary):
        told = {"diffuseFactor": [1, 0, 0, 1]}
        document["materials"] = [{"extensions": {"KHR_materials_pbrSpecularGlossiness": told}}]

    (material,) = load_mesh(_glb(tmp_path, glossy), CONFIG).mesh.materials
    assert material.color == (1.0, 0.0, 0.0, 1.0)


def test_texture_coordinates_and_transparency_of_older_formats_are_read(tmp_path):
    text = PLY.replace("element vertex", "comment TextureFile wood.png\nelement vertex")
    (tmp_path / "wood.png").write_bytes(png())
    (tmp_path / "a.ply").write_text(text)
    uv = load_mesh(tmp_path / "a.ply", CONFIG).mesh.corner_uv
    np.testing.assert_allclose(uv[0], [[0, 0], [1, 0], [0, 1]])
    (tmp_path / "a.obj").write_text(f"mtllib a.mtl\nusemtl glass\n{OBJ}f 1 2 3\n")
    (tmp_path / "a.mtl").write_text("newmtl glass\nKd 1 0 0\nTr 0.25\n")
    assert load_mesh(tmp_path / "a.obj", CONFIG).mesh.materials[0].color == (1.0, 0.0, 0.0, 0.75)
    (tmp_path / "a.off").write_text(
        "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 255 0 0 255\n0 1 0 255 0 0 255\n3 0 1 2\n"
    )
    assert len(load_mesh(tmp_path / "a.off", CONFIG).mesh.faces) == 1


@pytest.mark.parametrize(
    ("name", "content", "fault"),
    [
        ("bare.glb", struct.pack("<4sIIII", b"glTF", 2, 20, 0, 0x004E4942), "has no JSON chunk"),
        ("lfs.glb", LFS, "git lfs pull"),
        ("wrecked.glb", b"\xba\x01\x02\x03 and so on", "begins with ba 01 02 03, want 'glTF'"),
        ("damaged.glb", b'{"asset": \xff}', "its JSON is damaged at byte 10"),
        ("cut.glb", b'{"asset": ', "its JSON is damaged at byte"),
        ("a.ply", PLY.replace("format ascii 1.0\n", ""), "its header names no format"),
        ("b.ply", PLY.replace("ply\n", "plx\n", 1), "does not start with ply"),
        ("c.ply", PLY.rsplit("3 0 2 3", 1)[0], "ends before its 2 entries of face"),
        ("d.ply", PLY.replace("3 0 1 2", "3 0 99 1"), "a vertex outside 0..3"),
        ("e.ply", PLY.replace("3 0 1 2", "200 0 1 2"), "announces 200 values"),
        ("a.obj", f"{OBJ}f 0 1 2\n", "refers to entry 0"),
        ("b.obj", f"{OBJ}f 1/7 2/7 3/7\n", "refers to entry 7, but there are 0"),
        ("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4 0 1 2\n", "announces 4 corners and lists 3"),
        ("a.stl", b"abc" * 20, "neither a text nor a binary STL"),
    ],
)
def test_a_broken_file_is_refused_with_its_fault(name, content, fault, tmp_path):
    data = content if isinstance(content, bytes) else content.encode()
    (tmp_path / name).write_bytes(data)
    found = refusal(load_mesh, tmp_path / name, CONFIG)
    assert (found.code, fault in found.message) == ("unreadable", True)
    assert str(tmp_path) not in found.message


def test_a_gltf_of_another_version_is_unsupported(tmp_path):
    (tmp_path / "old.glb").write_bytes(struct.pack("<4sIIII", b"glTF", 1, 20, 0, 0))
    found = refusal(load_mesh, tmp_path / "old.glb", CONFIG)
    assert (found.code, "version 1" in found.message) == ("unsupported", True)


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        (lambda d: d["buffers"][0].update(uri="gone.bin"), "its buffer 'gone.bin' is missing"),
        (lambda d: d["buffers"][0].update(byteLength=10**6), "its header says 1000000"),
        (lambda d: d["accessors"][0].update(type="VEC2"), "positions have 2 coordinates"),
    ],
)
def test_a_gltf_that_contradicts_itself_is_refused_with_its_fault(change, fault, tmp_path):
    found = refusal(load_mesh, _glb(tmp_path, lambda document, binary: change(document)), CONFIG)
    assert (found.code, fault in found.message) == ("unreadable", True)
