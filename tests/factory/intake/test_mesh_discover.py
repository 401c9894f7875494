"""What counts as an input, and what it seems to be made of: nothing outside its folder."""

import os

import pytest
from input_files import write_inputs
from ros_packages import write_meshes, write_package

from asset_factory.factory.intake.companions import companions
from asset_factory.factory.intake.discover import find_inputs, links_out


def _touch(path, content="x"):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(content)
    return path


def test_folders_are_searched_in_sorted_order_and_a_file_named_twice_is_one_input(tmp_path):
    b = _touch(tmp_path / "b" / "y.OBJ")
    a = _touch(tmp_path / "a" / "x.glb")
    z = _touch(tmp_path / "z.ply")
    _touch(tmp_path / "a" / "readme.txt")
    _touch(tmp_path / "a" / "x.mtl")
    assert find_inputs([tmp_path]) == (z, a, b)
    assert find_inputs([b, tmp_path / "b", b]) == (b,)


def test_meshes_of_a_description_are_not_inputs_of_their_own(tmp_path):
    robot = '<robot><mesh filename="package://r/meshes/link.obj"/></robot>'
    urdf = _touch(tmp_path / "robot" / "robot.urdf", robot)
    _touch(tmp_path / "robot" / "meshes" / "spare" / "other.obj")
    mesh = _touch(tmp_path / "robot" / "meshes" / "link.obj")
    scene = "<?xml version='1.0'?><!-- x --><mujoco><mesh file='link.stl'/></mujoco>"
    mjcf = _touch(tmp_path / "scene" / "scene.xml", scene)
    _touch(tmp_path / "scene" / "link.obj")
    _touch(tmp_path / "scene" / "link.stl")
    other = _touch(tmp_path / "notes" / "notes.xml", "<notes/>")
    plain = _touch(tmp_path / "notes" / "plain.stl")
    assert find_inputs([tmp_path]) == (plain, urdf, mjcf)
    assert find_inputs([mesh, other]) == (mesh, other)


def test_meshes_beside_a_description_that_it_does_not_name_are_inputs(tmp_path):
    urdf = _touch(tmp_path / "robot.urdf", '<robot><mesh filename="door.obj"/></robot>')
    _touch(tmp_path / "door.obj")
    others = [_touch(tmp_path / f"{name}.glb") for name in ("chair", "table")]
    assert set(find_inputs([tmp_path])) == {*others, urdf}
    empty = _touch(tmp_path / "empty" / "a.urdf", "<robot/>")
    mesh = _touch(tmp_path / "empty" / "b.glb")
    assert find_inputs([tmp_path / "empty"]) == (empty, mesh)


def test_the_root_layer_of_a_usd_asset_is_an_input_and_its_other_layers_are_not(tmp_path):
    main = _touch(tmp_path / "oven" / "oven.usda")
    _touch(tmp_path / "oven" / "payload.usda")
    assert find_inputs([tmp_path]) == (main,)


def test_links_out_of_the_folder_are_named_and_passed_over_as_hidden_files_are(tmp_path):
    outside = _touch(tmp_path / "outside.glb")
    inside = _touch(tmp_path / "in" / "a.glb")
    os.symlink(outside, tmp_path / "in" / "b.glb")
    os.symlink(tmp_path, tmp_path / "in" / "up")
    _touch(tmp_path / "in" / ".hidden.glb")
    _touch(tmp_path / "in" / ".git" / "c.glb")
    assert find_inputs([tmp_path / "in"]) == (inside,)
    os.symlink(inside, tmp_path / "in" / "again.glb")
    assert links_out([tmp_path / "in"]) == (tmp_path / "in" / "b.glb", tmp_path / "in" / "up")


def test_a_registry_among_the_inputs_is_passed_over(tmp_path):
    asset = _touch(tmp_path / "out" / "assets" / "cup-0000000000" / "asset.urdf", "<robot/>")
    _touch(tmp_path / "out" / "registry.db")
    mesh = _touch(tmp_path / "cup.glb")
    assert find_inputs((tmp_path,)) == (mesh,)
    # Unless somebody asks for it.
    assert find_inputs((tmp_path / "out" / "assets",)) == (asset,)


@pytest.mark.parametrize("before", ["../meshes/", "package://cabinet/meshes/"])
def test_meshes_beside_the_folder_of_a_description_belong_to_it(tmp_path, before):
    path = write_package(tmp_path / "pkg", "cabinet", before)
    write_meshes(tmp_path / "alone")
    macros = path.with_name("parts.xacro")
    macros.write_text("<robot/>")
    (main := path.with_name("main.urdf.xacro")).write_text("<robot/>")
    alone = [tmp_path / "alone" / f"{name}.obj" for name in ("drawer", "shell")]
    assert find_inputs([tmp_path]) == (*alone, path, main)


def test_the_root_of_an_xml_file_is_looked_for_at_its_beginning_only(tmp_path):
    mesh = _touch(tmp_path / "cube.glb")
    late = _touch(tmp_path / "a.xml", f"<!--{'x' * 3_000_000}--><mujoco/>")
    assert find_inputs([tmp_path]) == (mesh,)
    # It names no mesh, so the one beside it is an input too.
    late.write_text(f"<!--{'x' * 3000}--><mujoco>")
    assert find_inputs([tmp_path]) == (late, mesh)


MJCF = '<mujoco><compiler meshdir="assets"/><asset><mesh file="a.stl"/></asset></mujoco>'


def test_a_description_brings_its_meshes_and_their_textures_and_a_mesh_no_other(tmp_path):
    inputs = write_inputs(tmp_path / "meshes")
    parts = {f"parts/{name}" for name in ("body.mtl", "body.obj", "body.png", "lid.stl")}
    assert companions(inputs / "cart" / "cart.urdf") == {"cart.urdf", *parts}
    assert companions(inputs / "box_0.stl") == {"box_0.stl"}
    assert "red paint.png" in companions(inputs / "painted" / "painted.obj")


@pytest.mark.parametrize(
    ("files", "brought"),
    [
        ({"a.xml": MJCF, "assets/a.stl": ""}, {"assets/a.stl"}),
        # Layers name others in no readable way.
        ({"a.usd": "", "layers/geometry.usdc": "", "paint.png": ""}, {"layers/geometry.usdc"}),
        (
            {"a.stl": "", "a.toml": 'annotation = "a.pred.npz"', "a.pred.npz": ""},
            {"a.toml", "a.pred.npz"},
        ),
        # A name ends with its suffix.
        *(
            ({"a.obj": f"# b{suffix}us b{suffix}_old\n", f"b{suffix}": ""}, set())
            for suffix in (".mtl", ".png", ".bin")
        ),
        *(
            ({"a.obj": f"mtllib {name}\n", "../secret.mtl": "newmtl secret"}, set())
            for name in ("../secret.mtl", "/etc/passwd.mtl", "a/../../secret.mtl")
        ),
    ],
)
def test_what_an_input_names_in_its_folder_comes_with_it(tmp_path, files, brought):
    folder = tmp_path / "in"
    for name, text in files.items():
        _touch(folder / name, text)
    entry = next(iter(files))
    assert companions(folder / entry) == {entry, *brought}
