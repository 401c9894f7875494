"""Engines are never told of files outside a description's folder, however hidden the reference."""

import os
import sys

import pytest
import trimesh
from PIL import Image

from asset_factory.sim_checks.description import DescriptionError
from asset_factory.sim_checks.read.read import read_here

pytest.importorskip("mujoco")
BODY = "<worldbody><body><geom size='0.1'/></body></worldbody>"
MODEL = f"<mujoco>{{}}{BODY}</mujoco>"
SEEN = "<visual><geometry>{}</geometry>{}</visual>"
BOX_URDF = f'<robot name="r"><link name="base">{SEEN}</link>{{}}</robot>'
PLAIN = BOX_URDF.format('<mesh filename="box.obj"/>', "", "")
MESH = "<mesh name='m' file='box.obj'/>"
TEXTURE = "<texture name='t' type='2d' file='{}'/>"
PAINT = '<material name="m"><texture filename="{}pixel.png"/></material>'
UNIT = '<box size="1 1 1"/>'


@pytest.fixture
def folder(tmp_path):
    """The asset's folder, with good files in it and the same outside."""
    inner = tmp_path / "asset"
    (inner / "meshes").mkdir(parents=True)
    for place in (tmp_path, inner, inner / "meshes"):
        trimesh.creation.box().export(place / "box.obj")
        (place / "part.xml").write_text(MODEL.format(""))
        (place / "more.xml").write_text("<mujoco><asset/></mujoco>")
        Image.new("L", (4, 4)).save(place / "pixel.png")
    return inner


def code_of(folder, text, name="asset.xml"):
    (folder / name).write_text(text)
    try:
        read_here(folder / name)
    except DescriptionError as error:
        return error.code
    return None


@pytest.mark.parametrize(
    "element",
    [
        "<asset><mesh name='m' file='{}box.obj'/></asset>",
        "<asset><texture name='t' type='2d' file='{}pixel.png'/></asset>",
        "<asset><texture name='t' type='cube' fileright='{}pixel.png'/></asset>",
        "<asset><hfield name='h' file='{}pixel.png' size='1 1 1 1'/></asset>",
        "<asset><model name='m' file='{}part.xml'/></asset>",
        "<deformable><skin name='s' file='{}skin.skn'/></deformable>",
        "<include file='{}more.xml'/>",
        f"<compiler meshdir='{{}}'/><asset>{MESH}</asset>",
        f"<compiler assetdir='{{}}'/><asset>{TEXTURE.format('pixel.png')}</asset>",
        f"<compiler texturedir='{{}}'/><asset>{TEXTURE.format('pixel.png')}</asset>",
        f"<compiler meshdir='{{}}' strippath='true'/><asset>{MESH.replace('box', 'a/box')}</asset>",
    ],
)
def test_every_element_that_names_a_file_is_looked_at(folder, element):
    for away in ("../", "meshes/../../", f"{folder.parent}/", "..\\", f"file://{folder.parent}/"):
        assert code_of(folder, MODEL.format(element.format(away))) == "outside_folder"
    inner = MODEL.format(element.format("../"))
    (folder / "inner.xml").write_text(inner)
    assert code_of(folder, MODEL.format("<include file='inner.xml'/>")) == "outside_folder"
    attached = "<asset><model name='a' file='inner.xml'/></asset>"
    assert code_of(folder, MODEL.format(attached)) == "outside_folder"


@pytest.mark.parametrize(
    "element",
    [
        f"<asset>{MESH}{TEXTURE.format('pixel.png')}</asset>",
        "<asset><model name='m' file='meshes/part.xml'/></asset><include file='meshes/more.xml'/>",
        f"<compiler meshdir='meshes'/><asset>{MESH}</asset>",
        f"<compiler texturedir='meshes'/><asset>{TEXTURE.format('../pixel.png')}</asset>",
        f"<compiler assetdir='nowhere' meshdir='./meshes/'/><asset>{MESH}</asset>",
        "<compiler strippath='true'/><asset><mesh name='m' file='C:\\Users\\me\\box.obj'/></asset>",
    ],
)
def test_what_lies_in_the_folder_is_read(folder, element):
    assert code_of(folder, MODEL.format(element)) is None


def test_a_link_that_leads_out_is_followed_before_it_is_judged(folder):
    (folder / "linked.obj").symlink_to(folder.parent / "box.obj")
    (folder / "linked.xml").symlink_to(folder.parent / "more.xml")
    for element in ("<asset><mesh file='linked.obj'/></asset>", "<include file='linked.xml'/>"):
        assert code_of(folder, MODEL.format(element)) == "outside_folder"
    (folder / "around.obj").symlink_to("around.obj")
    assert code_of(folder, MODEL.format("<asset><mesh file='around.obj'/></asset>")) is not None


def test_documents_nested_without_end_are_refused(folder):
    assert code_of(folder, MODEL.format("<include file='asset.xml'/>")) == "nested_too_deep"
    (folder / "a.xml").write_text("<mujoco><include file='b.xml'/></mujoco>")
    (folder / "b.xml").write_text("<mujoco><asset><model name='a' file='a.xml'/></asset></mujoco>")
    assert code_of(folder, MODEL.format("<include file='a.xml'/>")) == "nested_too_deep"
    for index in range(20):
        include = f"<include file='n{index + 1}.xml'/>"
        (folder / f"n{index}.xml").write_text(f"<mujoco>{include}</mujoco>")
    (folder / "n20.xml").write_text("<mujoco><asset/></mujoco>")
    assert code_of(folder, MODEL.format("<include file='n0.xml'/>")) == "nested_too_deep"
    assert code_of(folder, MODEL.format("<include file='n10.xml'/>")) is None


@pytest.mark.parametrize(
    "parts",
    [
        ('<mesh filename="{}box.obj"/>', "", ""),
        (UNIT, PAINT, ""),
        (UNIT, "", PAINT),
        (UNIT, "", '<gazebo><sensor><mesh filename="{}box.obj"/></sensor></gazebo>'),
    ],
)
def test_every_file_that_a_urdf_names_is_looked_at(folder, parts):
    text = BOX_URDF.format(*parts)
    for away in ("../", f"{folder.parent}/", f"file://{folder.parent}/", "https://example.org/"):
        assert code_of(folder, text.format(away), "asset.urdf") == "outside_folder"
    for near in ("", "meshes/", "package://some/meshes/", "model://some/meshes/"):
        assert code_of(folder, text.format(near), "asset.urdf") is None


def test_a_plugin_s_library_is_no_file_of_the_asset(folder):
    plugin = '<gazebo><plugin name="p" filename="/opt/lib/libx.so"/></gazebo>'
    text = BOX_URDF.format('<mesh filename="box.obj"/>', "", plugin)
    assert code_of(folder, text, "asset.urdf") is None


def test_a_planning_file_beside_it_that_leads_out_is_refused(folder):
    (folder.parent / "asset.srdf").write_text("<robot/>")
    (folder / "asset.srdf").symlink_to(folder.parent / "asset.srdf")
    assert code_of(folder, PLAIN, "asset.urdf") == "outside_folder"


def test_what_a_mesh_file_names_is_looked_at_too(folder):
    mesh = (folder / "box.obj").read_text()
    for line, code in (("mtllib ../all.mtl", "outside_folder"), ("mtllib all.mtl", None)):
        (folder / "box.obj").write_text(f"{line}\n{mesh}")
        assert code_of(folder, PLAIN, "asset.urdf") == code
    for picture, code in (("-clamp on ../pixel.png", "outside_folder"), ("pixel.png", None)):
        (folder / "all.mtl").write_text(f"newmtl a\nmap_Kd {picture}\n")
        assert code_of(folder, PLAIN, "asset.urdf") == code


@pytest.mark.parametrize("element", ["init_from", "c:init_from", "ref"])
def test_the_pictures_of_a_collada_file_are_looked_at_too(folder, element):
    pytest.importorskip("collada", reason="pycollada is not installed")
    text = BOX_URDF.format('<mesh filename="box.dae"/>', "", "")
    plain = trimesh.exchange.dae.export_collada(trimesh.creation.box()).decode()
    for picture, code in (
        ("../pixel.png", "outside_folder"),
        ("meshes/../../pixel.png", "outside_folder"),
        (f"file://{folder.parent}/pixel.png", "outside_folder"),
        ("pixel.png", None),
        ("meshes/pixel.png", None),
    ):
        image = f"<image id='i' xmlns:c='c'><{element}>{picture}</{element}></image>"
        images = f"<library_images>{image}</library_images></COLLADA>"
        (folder / "box.dae").write_text(plain.replace("</COLLADA>", images))
        assert code_of(folder, text, "asset.urdf") == code


def test_a_reader_of_meshes_opens_no_file_beside_it(folder, monkeypatch):
    (folder / "box.obj").write_text("mtllib all.mtl\n" + (folder / "box.obj").read_text())
    (folder / "all.mtl").write_text("newmtl a\nmap_Kd pixel.png\n")
    opened = []
    listening = True

    def hear(event, words):
        if listening and event == "open":
            opened.append(os.fsdecode(words[0]) if isinstance(words[0], str | bytes) else "")

    sys.addaudithook(hear)
    assert code_of(folder, PLAIN, "asset.urdf") is None
    listening = False
    assert any(name.endswith("box.obj") for name in opened)
    assert not any(name.endswith("pixel.png") for name in opened)
