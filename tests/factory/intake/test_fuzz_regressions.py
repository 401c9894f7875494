"""What fuzzing found of what reading costs, each once: no work is done again and again."""

import time
from pathlib import Path
from unittest.mock import patch

import pytest
from mesh_cube import gltf_parts, pack_glb, write_obj
from refusing import refusal

from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.geometry.soup import unique_names
from asset_factory.factory.intake.formats import obj
from asset_factory.factory.intake.formats.gltf_document import GltfDocument
from asset_factory.factory.intake.load import load
from asset_factory.factory.mesh import Material, Mesh, concatenate
from asset_factory.sim_checks.read.mjcf_compiler import compile_model

CONFIG = IntakeConfig()


@pytest.fixture
def quick():
    """Fail a test that takes far more than the work does; what was wrong took far longer."""
    started = time.process_time()
    yield
    assert time.process_time() - started < 3.0


def glb(folder, document, binary):
    (folder / "a.glb").write_bytes(pack_glb(document, binary))
    return folder / "a.glb"


def counted(owner, name):
    """Lets one count the calls of a function, or of a method."""
    return patch.object(owner, name, autospec=True, side_effect=getattr(owner, name))


@pytest.mark.usefixtures("quick")
def test_continued_lines_are_joined_at_once(tmp_path):
    text = b"v 0 0 0\nv 1 0 0\nv 0 1 \\\n1\nf 1 \\\r\n2 3\n" + b"\\\n" * 1_000_000
    (tmp_path / "a.obj").write_bytes(text)
    assert len(load(tmp_path / "a.obj", CONFIG).mesh.faces) == 1


def test_a_library_and_a_picture_are_read_once_however_often_they_are_named(tmp_path):
    path = write_obj(tmp_path)
    path.write_text("mtllib cube.mtl\n" * 500 + path.read_text())
    (tmp_path / "cube.mtl").write_text("newmtl red wood\n" + "map_Kd wood.png\n" * 500)
    with counted(obj, "read_mtl") as libraries, counted(obj, "read_texture") as pictures:
        assert any(material.texture for material in load(path, CONFIG).mesh.materials)
    assert (libraries.call_count, pictures.call_count) == (1, 1)


def test_an_accessor_is_read_once(tmp_path):
    document, binary = gltf_parts()
    empty = {"componentType": 5125, "count": 0, "type": "SCALAR"}
    document["accessors"] += [{"componentType": 5126, "count": 3000, "type": "VEC3"}, empty]
    document["meshes"][0]["primitives"] += [{"attributes": {"POSITION": 4}, "indices": 5}] * 300
    with counted(GltfDocument, "_read_accessor") as read:
        assert len(load(glb(tmp_path, document, binary), CONFIG).mesh.faces) == 12
    assert read.call_count == 6


@pytest.mark.usefixtures("quick")
def test_primitives_without_faces_cost_their_instances_nothing(tmp_path):
    document, binary = gltf_parts(nodes=[{"mesh": 0}] * 3000)
    document["accessors"][3]["count"] = 0
    document["meshes"][0]["primitives"] *= 3000
    assert refusal(load, glb(tmp_path, document, binary), CONFIG).code == "empty"


@pytest.mark.usefixtures("quick")
def test_names_and_materials_are_told_apart_without_counting_from_one():
    assert unique_names(["a"] * 20_000)[-1] == "a_20000"
    assert unique_names(["a", "a_2", "a", "a"]) == ["a", "a_2", "a_3", "a_4"]
    triangle = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    looks = [Material("a", (k / 1e4, 0, 0, 1)) for k in range(3000)]
    meshes = [Mesh.from_triangles(triangle, [[0, 1, 2]], look) for look in looks]
    assert concatenate(meshes).materials[-1].name == "a_3000"


def test_the_compiler_of_mjcf_leaves_no_log_behind(monkeypatch, tmp_path):
    nowhere = '<body pos="nan 0 0"><geom size="1"/></body>'
    (tmp_path / "box.xml").write_text(f"<mujoco><worldbody>{nowhere}</worldbody></mujoco>")
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    compile_model(tmp_path / "box.xml")
    assert list(Path().iterdir()) == []
