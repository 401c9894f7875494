"""What counts as an input, and what it seems to be made of: nothing outside its folder."""

import os

import pytest
from input_files import write_inputs
from laid import laid
from ros_packages import write_meshes, write_package

from asset_factory.factory.intake.companions import companions
from asset_factory.factory.intake.discover import find_inputs, links_out

ROBOT = '<robot><mesh filename="{}"/></robot>'
SCENE = "<?xml version='1.0'?><!-- x --><mujoco><mesh file='link.stl'/></mujoco>"
CIRCLE = {
    "scene.xml": '<mujoco><include file="a.xml"/></mujoco>',
    "a.xml": '<x><include file="scene.xml"/><include file="b.xml"/></x>',
    "b.xml": '<x><mesh file="door.stl"/></x>',
}
OVEN = {"r.urdf": ROBOT.format("package://r/meshes/oven.obj")}
#: Documents and other files of a folder, and those of them that are inputs, in order.
FOLDERS = {
    "sorted": ({}, "b/y.OBJ a/x.glb z.ply a/readme.txt a/x.mtl", "z.ply a/x.glb b/y.OBJ"),
    "a folder of a URDF's meshes": (OVEN, "meshes/oven.obj meshes/spare/other.obj", "r.urdf"),
    "an MJCF's mesh under any suffix": ({"s.xml": SCENE}, "link.obj link.stl", "s.xml"),
    "a mesh beside that is named": (
        {"r.urdf": ROBOT.format("a.obj")},
        "a.obj b.glb",
        "b.glb r.urdf",
    ),
    "a description of nothing": ({"a.urdf": "<robot/>"}, "b.glb", "a.urdf b.glb"),
    "documents that include each other": (CIRCLE, "door.stl chair.stl", "chair.stl scene.xml"),
    "other XML": ({"notes.xml": "<notes/>"}, "plain.stl", "plain.stl"),
    # It names no mesh, so the one beside it is an input too.
    "an early root": ({"a.xml": f"<!--{'x' * 3000}--><mujoco>"}, "b.glb", "a.xml b.glb"),
    "a root too late": ({"a.xml": f"<!--{'x' * 3_000_000}--><mujoco/>"}, "b.glb", "b.glb"),
    "layers of USD": ({}, "oven/oven.usda oven/payload.usda", "oven/oven.usda"),
    "a registry": ({"out/assets/cup-0/asset.urdf": "<robot/>"}, "out/registry.db c.glb", "c.glb"),
    "hidden files": ({}, "a.glb .b.glb .git/c.glb", "a.glb"),
}


@pytest.mark.parametrize("name", FOLDERS)
def test_a_folder_is_searched_for_inputs(name, tmp_path):
    documents, others, found = FOLDERS[name]
    for file, text in {**documents, **dict.fromkeys(others.split(), "x")}.items():
        laid(tmp_path / file, text)
    assert find_inputs([tmp_path]) == tuple(tmp_path / file for file in found.split())


def test_what_is_named_is_an_input_once_whatever_it_is(tmp_path):
    mesh = laid(tmp_path / "door.obj")
    laid(tmp_path / "robot.urdf", ROBOT.format("door.obj"))
    asset = laid(tmp_path / "out" / "assets" / "cup-0000000000" / "asset.urdf", "<robot/>")
    laid(tmp_path / "out" / "registry.db")
    other = laid(tmp_path / "notes.xml", "<notes/>")
    assert find_inputs([mesh, other, mesh, tmp_path / "out" / "assets"]) == (mesh, other, asset)


def test_links_out_of_the_folder_are_named_and_passed_over(tmp_path):
    outside = laid(tmp_path / "outside.glb")
    inside = laid(tmp_path / "in" / "a.glb")
    os.symlink(outside, tmp_path / "in" / "b.glb")
    os.symlink(tmp_path, tmp_path / "in" / "up")
    assert find_inputs([tmp_path / "in"]) == (inside,)
    os.symlink(inside, tmp_path / "in" / "again.glb")
    assert links_out([tmp_path / "in"]) == (tmp_path / "in" / "b.glb", tmp_path / "in" / "up")


@pytest.mark.parametrize("before", ["../meshes/", "package://cabinet/meshes/"])
def test_meshes_beside_the_folder_of_a_description_belong_to_it(tmp_path, before):
    path = write_package(tmp_path / "pkg", "cabinet", before)
    write_meshes(tmp_path / "alone")
    laid(path.with_name("parts.xacro"), "<robot/>")
    main = laid(path.with_name("main.urdf.xacro"), "<robot/>")
    alone = [tmp_path / "alone" / f"{name}.obj" for name in ("drawer", "shell")]
    assert find_inputs([tmp_path]) == (*alone, path, main)


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
        laid(folder / name, text)
    entry = next(iter(files))
    assert companions(folder / entry) == {entry, *brought}
