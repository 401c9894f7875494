"""Each way an input can be unusable has its own code, and nothing else ever escapes."""

import json
import struct
import zlib

import pytest
from fuzz_cases import DAE
from mesh_cube import (
    WRITERS,
    gltf_parts,
    pack_glb,
    png,
    write_glb,
    write_gltf,
    write_obj,
    write_stl,
    write_stl_ascii,
)
from refusing import refusal

from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.errors import ConfigError
from asset_factory.factory.intake.loading import load_mesh, load_visual

CONFIG = IntakeConfig()


def _rejected(path, config=CONFIG):
    found = refusal(load_mesh, path, config)
    assert str(path.parent) not in found.message
    return found


def test_a_text_stl_that_is_cut_off_between_its_triangles_is_rejected(tmp_path):
    path = write_stl_ascii(tmp_path)
    whole = path.read_text()
    path.write_text(whole[: whole.rindex("facet normal")])
    assert _rejected(path).code == "unreadable"
    path.write_text(whole + whole[: whole.rindex("facet normal")])
    assert _rejected(path).code == "unreadable"
    path.write_text(whole + whole + "\n; made by hand\n")
    assert len(load_mesh(path, CONFIG).mesh.faces) == 24


CLOUD = (
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
)
NOT_FINITE = "v nan nan nan\nv inf 0 0\nv 0 1 0\nf 1 2 3\n"
NO_AREA = {
    "line": "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n",
    "point": "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n",
    "slanted": "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n",
}


@pytest.mark.parametrize(
    ("name", "content", "code"),
    [
        ("unknown suffix.fbx", "x", "unsupported"),
        ("text in a binary format.glb", "this is no mesh", "unreadable"),
        *((f"nothing.{form}", "", "empty") for form in ("glb", "gltf", "obj", "ply", "stl", "off")),
        ("no face.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "empty"),
        ("no face.ply", CLOUD, "empty"),
        ("no finite vertex.obj", NOT_FINITE, "not_finite"),
        *((f"{name}.obj", text, "zero_size") for name, text in NO_AREA.items()),
    ],
)
def test_each_way_to_be_no_mesh_has_its_code(name, content, code, tmp_path):
    (tmp_path / name).write_text(content)
    assert _rejected(tmp_path / name).code == code


@pytest.mark.parametrize("extension", ["KHR_draco_mesh_compression", "EXT_meshopt_compression"])
def test_compressed_geometry_is_unsupported_and_named(extension, tmp_path):
    rejection = _rejected(write_glb(tmp_path, extensionsRequired=[extension]))
    assert rejection.code == "unsupported"
    assert extension in rejection.message


def test_a_scene_without_nodes_is_empty(tmp_path):
    assert _rejected(write_glb(tmp_path, scenes=[{"nodes": []}])).code == "empty"


def test_a_missing_file_and_a_folder_are_unreadable(tmp_path):
    assert _rejected(tmp_path / "absent.glb").code == "unreadable"
    (tmp_path / "folder.obj").mkdir()
    assert _rejected(tmp_path / "folder.obj").code == "unreadable"


def test_a_cyclic_node_tree_is_unreadable(tmp_path):
    nodes = [{"mesh": 0, "children": [1]}, {"children": [0]}]
    path = write_glb(tmp_path, nodes=nodes, scenes=[{"nodes": [0]}])
    assert _rejected(path).code == "unreadable"


def test_a_file_over_the_byte_limit_is_too_large(tmp_path):
    rejection = _rejected(write_glb(tmp_path), IntakeConfig(max_bytes=100))
    assert rejection.code == "too_large"
    assert rejection.limit == 100
    assert rejection.value > 100


@pytest.mark.parametrize("form", WRITERS)
def test_more_faces_than_the_limit_are_too_large_and_as_many_are_fine(form, tmp_path):
    path = WRITERS[form](tmp_path)
    assert _rejected(path, IntakeConfig(max_faces=11)).code == "too_large"
    assert len(load_mesh(path, IntakeConfig(max_faces=12)).mesh.faces) == 12


def test_instances_count_towards_the_face_limit(tmp_path):
    path = write_glb(tmp_path, nodes=[{"mesh": 0, "translation": [2 * k, 0, 0]} for k in range(10)])
    assert _rejected(path, IntakeConfig(max_faces=100)).code == "too_large"


def test_a_huge_announced_count_is_refused_before_allocation(tmp_path):
    document, binary = gltf_parts()
    document["accessors"][0] = {"componentType": 5126, "count": 2**40, "type": "VEC3"}
    (tmp_path / "a.glb").write_bytes(pack_glb(document, binary))
    assert _rejected(tmp_path / "a.glb").code == "too_large"
    head = "ply\nformat binary_little_endian 1.0\nelement vertex 99999999999\n"
    (tmp_path / "b.ply").write_text(f"{head}property float x\nend_header\n")
    assert _rejected(tmp_path / "b.ply").code == "too_large"
    (tmp_path / "c.off").write_text("OFF\n99999999999 1 0\n")
    assert _rejected(tmp_path / "c.off").code == "unreadable"
    (tmp_path / "d.stl").write_bytes(b"\1" * 80 + struct.pack("<I", 2**32 - 1) + b"\0" * 100)
    assert _rejected(tmp_path / "d.stl").code == "unreadable"


def test_a_texture_over_the_pixel_limit_is_refused_by_its_header(tmp_path):
    path = write_glb(tmp_path, image=png((300, 200)))
    rejection = _rejected(path, IntakeConfig(max_texture_pixels=50_000))
    assert rejection.code == "too_large"
    assert rejection.value == 60_000


def test_a_decompression_bomb_is_refused_by_its_header(tmp_path):
    data = bytearray(png())
    data[16:24] = struct.pack(">II", 60_000, 60_000)
    data[29:33] = struct.pack(">I", zlib.crc32(data[12:29]))
    assert _rejected(write_glb(tmp_path, image=bytes(data))).code == "too_large"


def test_out_of_memory_is_too_large(tmp_path, monkeypatch):
    def no_memory(path):
        raise MemoryError

    path = write_stl(tmp_path)
    monkeypatch.setattr("asset_factory.factory.intake.files.open_regular", no_memory)
    assert _rejected(path).code == "too_large"


def test_faces_that_are_not_finite_or_flat_are_dropped_and_counted(tmp_path):
    vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv 2 0 0\nv 0 0 1\n"
    (tmp_path / "m.obj").write_text(f"{vertices}f 1 2 4\nf 1 2 3\nf 1 2 5\nf 1 1 3\nf 1 3 6\n")
    intake = load_mesh(tmp_path / "m.obj", CONFIG)
    assert intake.provenance.dropped_non_finite == 1
    assert intake.provenance.dropped_degenerate == 2
    assert intake.source_faces.tolist() == [1, 4]


def test_a_flat_mesh_cannot_be_scaled_to_a_height(tmp_path):
    (tmp_path / "rug.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert len(load_mesh(tmp_path / "rug.obj", CONFIG).mesh.faces) == 1
    assert _rejected(tmp_path / "rug.obj", IntakeConfig(height=0.5)).code == "zero_size"


HERE = ("../secret.png", "/etc/hostname", "C:\\a.png", "a/../../b.png")


@pytest.mark.parametrize("reference", [*HERE, "https://example.com/a.png", "file:///etc/hostname"])
def test_a_reference_that_leaves_the_folder_is_external(reference, tmp_path):
    inside = tmp_path / "inside"
    inside.mkdir()
    (tmp_path / "secret.png").write_bytes(png())
    path = write_gltf(inside)
    document = json.loads(path.read_text())
    document["images"] = [{"uri": reference}]
    path.write_text(json.dumps(document))
    assert _rejected(path).code == "external_reference"
    obj = write_obj(inside)
    (inside / "cube.mtl").write_text(f"newmtl red wood\nmap_Kd {reference}\n")
    assert _rejected(obj).code == "external_reference"
    obj.write_text(f"mtllib {reference}\n" + obj.read_text())
    assert _rejected(obj).code == "external_reference"


def test_a_collada_file_shows_pictures_of_its_own_folder_only(tmp_path):
    pytest.importorskip("collada", reason="pycollada is not installed")
    inside = tmp_path / "inside"
    inside.mkdir()
    for folder in (tmp_path, inside):
        (folder / "wood.png").write_bytes(png())
    path = inside / "picture.dae"
    path.write_text(DAE.format("wood.png"))
    assert load_mesh(path, CONFIG).mesh.materials[0].texture is not None
    for reference in ("../wood.png", f"{tmp_path}/wood.png", f"file://{tmp_path}/wood.png"):
        path.write_text(DAE.format(reference))
        assert _rejected(path).code == "external_reference"
    (inside / "link.png").symlink_to(tmp_path / "wood.png")
    path.write_text(DAE.format("link.png"))
    assert _rejected(path).code == "external_reference"


def test_a_visual_outside_its_root_is_external(tmp_path):
    (tmp_path / "robot").mkdir()
    found = refusal(load_visual, write_stl(tmp_path), tmp_path / "robot", CONFIG)
    assert (found.code, "outside" in found.message) == ("external_reference", True)


def test_a_visual_may_refer_to_anything_below_its_root(tmp_path):
    (tmp_path / "meshes").mkdir()
    path = write_obj(tmp_path / "meshes")
    (tmp_path / "images").mkdir()
    (tmp_path / "meshes" / "wood.png").rename(tmp_path / "images" / "wood.png")
    (tmp_path / "meshes" / "cube.mtl").write_text("newmtl red wood\nmap_Kd ../images/wood.png\n")
    mesh = load_visual(path, tmp_path, CONFIG).mesh
    assert mesh.materials[0].texture is not None


@pytest.mark.parametrize("field", [{"height": 0.0}, {"height": float("nan")}])
def test_a_setting_that_cannot_be_is_a_config_error(field, tmp_path):
    with pytest.raises(ConfigError):
        load_mesh(write_stl(tmp_path), IntakeConfig(**field))
