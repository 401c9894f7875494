"""What fuzzing found in the input readers, each once: a verdict, no hang, crash or stray file."""

import os
import struct
import subprocess
import sys
import time
from pathlib import Path

import pytest
from fuzz_cases import MJCF, URDF, cube_files
from mesh_cube import gltf_parts, pack_glb, png, write_glb, write_obj
from refusing import refusal

from asset_factory.factory.articulate.catalog import choose
from asset_factory.factory.config import BuildConfig, IntakeConfig
from asset_factory.factory.geometry.soup import unique_names
from asset_factory.factory.intake.discover import find_inputs
from asset_factory.factory.intake.formats import gltf_document, obj
from asset_factory.factory.intake.images import load_texture
from asset_factory.factory.intake.load import load
from asset_factory.factory.mesh import Material, Mesh, concatenate

#: Far more than the work takes, far less than what it took.
QUICK_S = 3.0


def laid(folder, files, entry):
    for name, data in files.items():
        (folder / name).write_bytes(data)
    return folder / entry


def glb(folder, document, binary):
    return laid(folder, {"a.glb": pack_glb(document, binary)}, "a.glb")


def described(folder, text):
    """A URDF beside the meshes that it names."""
    return laid(folder, {**cube_files(), "box.urdf": text.encode()}, "box.urdf")


def refused(path, config=None):
    def read():
        intake = load(path, config or IntakeConfig())
        choose(intake, BuildConfig(articulator="annotated")).articulate(intake.mesh)

    return refusal(read)


def counted(monkeypatch, module, name):
    """The calls that a function of a module gets from now on."""
    calls = []
    real = getattr(module, name)

    def count(*args):
        calls.append(args)
        return real(*args)

    monkeypatch.setattr(module, name, count)
    return calls


@pytest.mark.parametrize(
    "text",
    [
        "height = 1" + "0" * 400,
        "height = " + "9" * 5000,
        "scale = 1e300",
        "density = 1e-300",
        "annotation = '" + "n" * 300 + "'",
        "annotation = 'loop'",
        "#" * 70_000,
    ],
)
def test_a_sidecar_of_odd_numbers_or_references_is_refused(text, tmp_path):
    path = write_glb(tmp_path)
    (tmp_path / "loop").symlink_to("loop")
    (tmp_path / "cube.toml").write_text(text)
    assert refused(path).code in ("bad_sidecar", "external_reference")


@pytest.mark.parametrize(
    ("sidecar", "height"), [("scale = 1e-9", None), ("scale = 1e9", None), ("", 1e300)]
)
def test_a_size_that_no_object_has_is_absurd(sidecar, height, tmp_path):
    for path in (write_glb(tmp_path), described(tmp_path, URDF)):
        path.with_suffix(".toml").write_text(sidecar)
        assert refused(path, IntakeConfig(height=height)).code == "absurd_size"


def test_continued_lines_are_joined_at_once(tmp_path):
    text = b"v 0 0 0\nv 1 0 0\nv 0 1 \\\n1\nf 1 \\\r\n2 3\n" + b"\\\n" * 1_000_000
    started = time.process_time()
    assert len(load(laid(tmp_path, {"a.obj": text}, "a.obj"), IntakeConfig()).mesh.faces) == 1
    assert time.process_time() - started < QUICK_S


def test_blanks_of_every_kind_bound_a_polygon(tmp_path):
    text = b"v 0 0 0\nv 1 0 0\nv 0 1 1\nf" + b"\v1" * 1000 + b"\n"
    path = laid(tmp_path, {"a.obj": text}, "a.obj")
    assert refused(path, IntakeConfig(max_faces=900)).code == "too_large"


def test_a_library_and_a_picture_are_read_once_however_often_they_are_named(monkeypatch, tmp_path):
    path = write_obj(tmp_path)
    path.write_text("mtllib cube.mtl\n" * 500 + path.read_text())
    (tmp_path / "cube.mtl").write_text("newmtl red wood\n" + "map_Kd wood.png\n" * 500)
    libraries = counted(monkeypatch, obj, "read_mtl")
    pictures = counted(monkeypatch, obj, "read_texture")
    assert any(material.texture for material in load(path, IntakeConfig()).mesh.materials)
    assert (len(libraries), len(pictures)) == (1, 1)


def test_more_libraries_than_anybody_has_are_too_large(tmp_path):
    path = write_obj(tmp_path)
    path.write_text("".join(f"mtllib {k}.mtl\n" for k in range(100)) + path.read_text())
    assert refused(path).code == "too_large"


def test_only_the_first_of_a_thousand_notes_are_kept(tmp_path):
    path = write_obj(tmp_path)
    pictures = "".join(f"map_Kd {k}{'x' * 200}.png\n" for k in range(1000))
    (tmp_path / "cube.mtl").write_text(f"newmtl a\n{pictures}")
    notes = load(path, IntakeConfig()).provenance.notes
    assert len(notes) < 50
    assert any(note.endswith("more notes of this kind.") for note in notes)


def test_an_accessor_is_read_once_and_all_of_them_are_bounded(monkeypatch, tmp_path):
    document, binary = gltf_parts()
    empty = {"componentType": 5125, "count": 0, "type": "SCALAR"}
    document["accessors"] += [{"componentType": 5126, "count": 3000, "type": "VEC3"}, empty]
    document["meshes"][0]["primitives"] += [{"attributes": {"POSITION": 4}, "indices": 5}] * 300
    read = counted(monkeypatch, gltf_document.GltfDocument, "_read_accessor")
    assert len(load(glb(tmp_path, document, binary), IntakeConfig()).mesh.faces) == 12
    assert len(read) == 6
    document["accessors"] += [{"componentType": 5126, "count": 3000, "type": "VEC3"}] * 11
    primitives = [{"attributes": {"POSITION": 6 + k}, "indices": 5} for k in range(11)]
    document["meshes"] = [{"primitives": primitives}]
    rejection = refused(glb(tmp_path, document, binary), IntakeConfig(max_faces=1500))
    assert "numbers" in rejection.message


def test_primitives_without_faces_cost_their_instances_nothing(tmp_path):
    document, binary = gltf_parts(nodes=[{"mesh": 0}] * 3000)
    document["accessors"][3]["count"] = 0
    document["meshes"][0]["primitives"] *= 3000
    path = glb(tmp_path, document, binary)
    started = time.process_time()
    assert refused(path).code == "empty"
    assert time.process_time() - started < QUICK_S


@pytest.mark.parametrize(("side", "most"), [(2, 512 * 512), (100, 10_000)])
def test_many_pictures_are_too_large_together(side, most, tmp_path):
    document, binary = gltf_parts(image=png((side, side)))
    document["images"] *= 17
    document["textures"] = [{"source": k} for k in range(17)]
    looks = [{"baseColorTexture": {"index": k}} for k in range(17)]
    document["materials"] = [{"pbrMetallicRoughness": look} for look in looks]
    path = glb(tmp_path, document, binary)
    assert refused(path, IntakeConfig(max_texture_pixels=most)).code == "too_large"
    assert load(path, IntakeConfig(max_texture_pixels=600 * 512)).mesh.materials


def test_names_and_materials_are_told_apart_without_counting_from_one():
    started = time.process_time()
    assert unique_names(["a"] * 20_000)[-1] == "a_20000"
    assert unique_names(["a", "a_2", "a", "a"]) == ["a", "a_2", "a_3", "a_4"]
    triangle = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    looks = [Material("a", (k / 1e4, 0, 0, 1)) for k in range(3000)]
    meshes = [Mesh.from_triangles(triangle, [[0, 1, 2]], look) for look in looks]
    assert concatenate(meshes).materials[-1].name == "a_3000"
    assert time.process_time() - started < QUICK_S


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian"])
def test_ply_tables_of_nothing_are_bounded_together(form, tmp_path):
    tables = "".join(f"element e{k} 3000\n" for k in range(3))
    text = f"ply\nformat {form} 1.0\n{tables}end_header\n".encode() + b"\n" * 9000
    path = laid(tmp_path, {"a.ply": text}, "a.ply")
    assert refused(path, IntakeConfig(max_faces=1499)).code == "too_large"
    assert refused(path, IntakeConfig(max_faces=1501)).code == "unreadable"


@pytest.mark.parametrize("error", [struct.error, RuntimeError, AttributeError, OverflowError])
def test_whatever_a_decoder_raises_the_picture_is_left_out(error, monkeypatch):
    from PIL import Image

    from asset_factory.factory.intake.files import InputFiles

    def fail(*_, **__):
        raise error("deep inside")

    monkeypatch.setattr(Image, "open", fail)
    assert load_texture(png(), "a.png", InputFiles(Path(), IntakeConfig())) is None


@pytest.mark.parametrize(
    "reference", ["a%00b.obj", "loop.obj", "n" * 300 + ".obj", "d/" * 3000 + "x.obj"]
)
def test_references_with_names_that_no_file_has_are_refused(reference, tmp_path):
    (tmp_path / "loop.obj").symlink_to("loop.obj")
    rejection = refused(described(tmp_path, URDF.replace("cube.obj", reference)))
    assert rejection.code in ("missing_file", "external_reference")
    assert len(rejection.message) < 400


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ('xyz="0 0 1"', 'xyz="0 0 1e300"', "unreadable"),
        ('scale="1 1 1"', 'scale="1e308 1e308 1e308"', "unreadable"),
        ('lower="-0.5"', 'lower="-1e308"', "no_limits"),
        ("</robot>", '<link name="l"/>' * 5000 + "</robot>", "too_large"),
        ("</robot>", "<a/>" * 1_000_001 + "</robot>", "too_large"),
        ("</robot>", "</robot>" + " " * 70_000_000, "too_large"),
    ],
)
def test_a_urdf_of_absurd_numbers_or_size_is_refused(old, new, code, tmp_path):
    assert refused(described(tmp_path, URDF.replace(old, new, 1))).code == code


def test_too_many_shapes_are_refused_before_they_are_made(tmp_path):
    boxes = '<visual><geometry><box size="1 1 1"/></geometry></visual>' * 10_001
    text = URDF.replace("<inertial>", boxes + "<inertial>")
    assert "shapes" in refused(described(tmp_path, text)).message


def test_the_compiler_of_mjcf_leaves_no_log_behind(tmp_path):
    pytest.importorskip("mujoco")
    text = MJCF.replace('rgba="1 0 0 1"', 'rgba="1 0"')
    for part in ('<include file="assets.xml"/>', '<geom type="mesh" mesh="cube" material="wood"/>'):
        text = text.replace(part, "")
    path = laid(tmp_path, {**cube_files(), "box.xml": text.encode()}, "box.xml")
    code = (
        "import sys, pathlib\n"
        "from asset_factory.sim_checks.read.mjcf_compiler import compile_model\n"
        "try:\n    compile_model(pathlib.Path(sys.argv[1]))\nexcept ValueError:\n    pass\n"
    )
    (tmp_path / "elsewhere").mkdir()
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    command = [sys.executable, "-c", code, str(path)]
    elsewhere = tmp_path / "elsewhere"
    subprocess.run(command, cwd=elsewhere, env=environment, check=True, timeout=60)
    assert list(elsewhere.iterdir()) == []


def test_the_root_of_an_xml_file_is_looked_for_at_its_beginning_only(tmp_path):
    write_glb(tmp_path)
    (tmp_path / "a.xml").write_bytes(b"<!--" + b"x" * 3_000_000 + b"--><mujoco/>")
    assert [path.name for path in find_inputs((tmp_path,))] == ["cube.glb"]
    (tmp_path / "a.xml").write_bytes(b"<!--" + b"x" * 3000 + b"--><mujoco>")
    # It names no mesh, so the one beside it is an input too.
    assert [path.name for path in find_inputs((tmp_path,))] == ["a.xml", "cube.glb"]
