"""Each way a mesh file can be unusable has its own code, and nothing else ever escapes."""

import json
import struct
import zlib
from unittest.mock import Mock

import pytest
from fuzz_cases import DAE
from laid import laid
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
OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
OFF = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n"
XYZ = "property float x\nproperty float y\nproperty float z\n"
PLY = (
    f"ply\nformat ascii 1.0\nelement vertex 4\n{XYZ}element face 2\n"
    "property list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 2 3\n"
)
CLOUD = f"ply\nformat ascii 1.0\nelement vertex 3\n{XYZ}end_header\n0 0 0\n1 0 0\n0 1 0\n"
VAST_PLY = f"ply\nformat binary_little_endian 1.0\nelement vertex 99999999999\n{XYZ}end_header\n"
#: A triangle, and then a polygon that says it has fewer corners than none.
NEGATIVE_PLY = (
    f"ply\nformat binary_little_endian 1.0\nelement vertex 3\n{XYZ}element face 2\n"
    "property list char int vertex_indices\nend_header\n"
).encode() + struct.pack("<9fb3ib", *range(9), 3, 0, 1, 2, -1)
LFS = "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n"


def _rejected(path, config=CONFIG):
    found = refusal(load_mesh, path, config)
    assert str(path.parent) not in found.message
    return found


def _glb(**options):
    return pack_glb(*gltf_parts(**options))


def _positions(count, shape="VEC3"):
    """A GLB of that many positions."""
    accessor = {"bufferView": 0, "componentType": 5126, "count": count, "type": shape}
    return _glb(accessors=[accessor])


CYCLE = [{"mesh": 0, "children": [1]}, {"children": [0]}]
#: Name -> content and code.
USELESS = {
    "unknown suffix.fbx": ("x", "unsupported"),
    "version 1.glb": (struct.pack("<4sIIII", b"glTF", 1, 20, 0, 0), "unsupported"),
    **{f"nothing.{form}": ("", "empty") for form in ("glb", "gltf", "obj", "ply", "stl", "off")},
    "no face.obj": (OBJ, "empty"),
    "no face.ply": (CLOUD, "empty"),
    "no node.glb": (_glb(scenes=[{"nodes": []}]), "empty"),
    "no finite vertex.obj": ("v nan nan nan\nv inf 0 0\nv 0 1 0\nf 1 2 3\n", "not_finite"),
    "line.obj": ("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "zero_size"),
    "point.obj": ("v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n", "zero_size"),
    "slanted.obj": ("v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n", "zero_size"),
    "vast.glb": (_positions(2**40), "too_large"),
    "vast.ply": (VAST_PLY, "too_large"),
}
#: Name -> content, and what is told of what is unreadable in it.
UNREADABLE = {
    "text.glb": ("this is no mesh", ""),
    "bare.glb": (struct.pack("<4sIIII", b"glTF", 2, 20, 0, 0x004E4942), "has no JSON chunk"),
    "lfs.glb": (LFS, "git lfs pull"),
    "wrecked.glb": (b"\xba\x01\x02\x03 and so on", "begins with ba 01 02 03, want 'glTF'"),
    "damaged.glb": (b'{"asset": \xff}', "its JSON is damaged at byte 10"),
    "cut.glb": ('{"asset": ', "its JSON is damaged at byte"),
    "cycle.glb": (_glb(nodes=CYCLE, scenes=[{"nodes": [0]}]), ""),
    "no buffer.glb": (
        _glb(buffers=[{"byteLength": 1, "uri": "gone.bin"}]),
        "buffer 'gone.bin' is missing",
    ),
    "short buffer.glb": (_glb(buffers=[{"byteLength": 10**6}]), "its header says 1000000"),
    "plane.glb": (_positions(24, "VEC2"), "positions have 2 coordinates"),
    "no format.ply": (PLY.replace("format ascii 1.0\n", ""), "its header names no format"),
    "no head.ply": (PLY.replace("ply\n", "plx\n", 1), "does not start with ply"),
    "cut.ply": (PLY.rsplit("3 0 2 3", 1)[0], "ends before its 2 entries of face"),
    "negative.ply": (NEGATIVE_PLY, "a list of face has -1 values"),
    "vertex.ply": (PLY.replace("3 0 1 2", "3 0 99 1"), "a vertex outside 0..3"),
    "count.ply": (PLY.replace("3 0 1 2", "200 0 1 2"), "announces 200 values"),
    "entry 0.obj": (f"{OBJ}f 0 1 2\n", "refers to entry 0"),
    "entry 7.obj": (f"{OBJ}f 1/7 2/7 3/7\n", "refers to entry 7, but there are 0"),
    "corners.off": (f"{OFF}4 0 1 2\n", "announces 4 corners and lists 3"),
    "vast.off": ("OFF\n99999999999 1 0\n", ""),
    "neither.stl": ("abc" * 20, "neither a text nor a binary STL"),
    "vast.stl": (b"\1" * 80 + struct.pack("<I", 2**32 - 1) + b"\0" * 100, ""),
}


@pytest.mark.parametrize("name", USELESS)
def test_each_way_to_be_no_mesh_has_its_code(name, tmp_path):
    content, code = USELESS[name]
    assert _rejected(laid(tmp_path / name, content)).code == code


@pytest.mark.parametrize("name", UNREADABLE)
def test_a_broken_file_is_refused_with_its_fault(name, tmp_path):
    content, said = UNREADABLE[name]
    found = _rejected(laid(tmp_path / name, content))
    assert (found.code, said in found.message) == ("unreadable", True)


@pytest.mark.parametrize("extension", ["KHR_draco_mesh_compression", "EXT_meshopt_compression"])
def test_compressed_geometry_is_unsupported_and_named(extension, tmp_path):
    rejection = _rejected(write_glb(tmp_path, extensionsRequired=[extension]))
    assert (rejection.code, extension in rejection.message) == ("unsupported", True)


def test_a_missing_file_and_a_folder_are_unreadable(tmp_path):
    assert _rejected(tmp_path / "absent.glb").code == "unreadable"
    (tmp_path / "folder.obj").mkdir()
    assert _rejected(tmp_path / "folder.obj").code == "unreadable"


def test_a_text_stl_that_is_cut_off_between_its_triangles_is_rejected(tmp_path):
    path = write_stl_ascii(tmp_path)
    whole = path.read_text()
    cut = whole[: whole.rindex("facet normal")]
    for text in (cut, whole + cut):
        path.write_text(text)
        assert _rejected(path).code == "unreadable"
    path.write_text(whole + whole + "\n; made by hand\n")
    assert len(load_mesh(path, CONFIG).mesh.faces) == 24


def _bomb():
    """A picture whose header announces far more pixels than it has."""
    data = bytearray(png())
    data[16:24] = struct.pack(">II", 60_000, 60_000)
    data[29:33] = struct.pack(">I", zlib.crc32(data[12:29]))
    return bytes(data)


def _empty_tables(form):
    """A PLY with three tables of nothing, of 9000 rows together."""
    tables = "".join(f"element e{k} 3000\n" for k in range(3))
    return f"ply\nformat {form} 1.0\n{tables}end_header\n" + "\n" * 9000


def _pictures(side):
    """A GLB that shows 17 pictures of so many pixels a side."""
    looks = [{"baseColorTexture": {"index": k}} for k in range(17)]
    return _glb(
        image=png((side, side)),
        images=[{"bufferView": 4, "mimeType": "image/png"}] * 17,
        textures=[{"source": k} for k in range(17)],
        materials=[{"pbrMetallicRoughness": look} for look in looks],
    )


def _accessors():
    """A GLB of 11 accessors that together hold far more numbers than each of them."""
    positions = {"componentType": 5126, "count": 3000, "type": "VEC3"}
    indices = {"componentType": 5125, "count": 0, "type": "SCALAR"}
    primitives = [{"attributes": {"POSITION": k}, "indices": 11} for k in range(11)]
    return _glb(accessors=[positions] * 11 + [indices], meshes=[{"primitives": primitives}])


ROW_OF_CUBES = [{"mesh": 0, "translation": [2 * k, 0, 0]} for k in range(10)]
LIBRARIES = "".join(f"mtllib {k}.mtl\n" for k in range(100))
PLY_FORMS = ("ascii", "binary_little_endian")
#: Name -> content, settings, and what is told.
TOO_LARGE = {
    "file.glb": (_glb(), {"max_bytes": 100}, f"{len(_glb()):,} bytes, the limit is 100"),
    "instances.glb": (_glb(nodes=ROW_OF_CUBES), {"max_faces": 100}, "108 faces, the limit is 100"),
    "accessors.glb": (_accessors(), {"max_faces": 1500}, "numbers"),
    "pixels.glb": (_glb(image=png((300, 200))), {"max_texture_pixels": 50_000}, "60,000 pixels"),
    "bomb.glb": (_glb(image=_bomb()), {}, "3600000000 pixels"),
    **{
        f"{side} pixels a side.glb": (_pictures(side), {"max_texture_pixels": most}, "all textures")
        for side, most in ((2, 512 * 512), (100, 10_000))
    },
    **{
        f"{form}.ply": (_empty_tables(form), {"max_faces": 1499}, "9,000 entries")
        for form in PLY_FORMS
    },
    "blanks.obj": (f"{OBJ}f" + "\v1" * 1000 + "\n", {"max_faces": 900}, "999 faces"),
    "libraries.obj": (f"{LIBRARIES}{OBJ}f 1 2 3\n", {}, "100 material libraries"),
}


@pytest.mark.parametrize("name", TOO_LARGE)
def test_what_goes_beyond_a_limit_is_too_large(name, tmp_path):
    content, settings, said = TOO_LARGE[name]
    found = _rejected(laid(tmp_path / name, content), IntakeConfig(**settings))
    assert (found.code, said in found.message) == ("too_large", True)


def test_what_keeps_to_a_limit_is_not(tmp_path):
    for side in (2, 100):
        path = laid(tmp_path / "pictures.glb", _pictures(side))
        assert load_mesh(path, IntakeConfig(max_texture_pixels=600 * 512)).mesh.materials
    for form in PLY_FORMS:
        path = laid(tmp_path / "tables.ply", _empty_tables(form))
        assert _rejected(path, IntakeConfig(max_faces=1501)).code == "unreadable"


@pytest.mark.parametrize("form", WRITERS)
def test_more_faces_than_the_limit_are_too_large_and_as_many_are_fine(form, tmp_path):
    path = WRITERS[form](tmp_path)
    assert _rejected(path, IntakeConfig(max_faces=11)).code == "too_large"
    assert len(load_mesh(path, IntakeConfig(max_faces=12)).mesh.faces) == 12


def test_out_of_memory_is_too_large(tmp_path, monkeypatch):
    path = write_stl(tmp_path)
    opening = "asset_factory.factory.intake.files.open_regular"
    monkeypatch.setattr(opening, Mock(side_effect=MemoryError))
    assert _rejected(path).code == "too_large"


def test_a_flat_mesh_cannot_be_scaled_to_a_height(tmp_path):
    rug = laid(tmp_path / "rug.obj", f"{OBJ}f 1 2 3\n")
    assert len(load_mesh(rug, CONFIG).mesh.faces) == 1
    assert _rejected(rug, IntakeConfig(height=0.5)).code == "zero_size"


HERE = ("../secret.png", "/etc/hostname", "C:\\a.png", "a/../../b.png")


@pytest.mark.parametrize("reference", [*HERE, "https://example.com/a.png", "file:///etc/hostname"])
def test_a_reference_that_leaves_the_folder_is_external(reference, tmp_path):
    inside = tmp_path / "inside"
    inside.mkdir()
    laid(tmp_path / "secret.png", png())
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
    inside = tmp_path / "inside"
    for folder in (tmp_path, inside):
        laid(folder / "wood.png", png())
    path = laid(inside / "picture.dae", DAE.format("wood.png"))
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
    laid(tmp_path / "images" / "wood.png", png())
    path.with_name("wood.png").unlink()
    path.with_name("cube.mtl").write_text("newmtl red wood\nmap_Kd ../images/wood.png\n")
    assert load_visual(path, tmp_path, CONFIG).mesh.materials[0].texture is not None


@pytest.mark.parametrize("field", [{"height": 0.0}, {"height": float("nan")}])
def test_a_setting_that_cannot_be_is_a_config_error(field, tmp_path):
    with pytest.raises(ConfigError):
        load_mesh(write_stl(tmp_path), IntakeConfig(**field))
