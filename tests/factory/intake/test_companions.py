"""What an input seems to refer to: all that its reader asks for, and nothing outside its folder."""

import pytest
from input_files import write_inputs

from asset_factory.factory.intake.companions import companions


@pytest.fixture(scope="module")
def inputs(tmp_path_factory):
    return write_inputs(tmp_path_factory.mktemp("here") / "meshes")


def test_a_description_brings_its_meshes_and_their_textures(inputs):
    parts = {f"parts/{name}" for name in ("body.mtl", "body.obj", "body.png", "lid.stl")}
    assert companions(inputs / "cart" / "cart.urdf") == {"cart.urdf", *parts}


def test_names_with_spaces(inputs):
    assert "red paint.png" in companions(inputs / "painted" / "painted.obj")


@pytest.mark.parametrize("suffix", [".mtl", ".png", ".bin"])
def test_a_name_ends_with_its_suffix(tmp_path, suffix):
    (tmp_path / f"other{suffix}").touch()
    (tmp_path / "box.obj").write_text(f"# other{suffix}us other{suffix}_old\n")
    assert companions(tmp_path / "box.obj") == {"box.obj"}


def test_one_mesh_does_not_bring_another(inputs):
    assert companions(inputs / "box_0.stl") == {"box_0.stl"}


def test_folders_of_an_mjcf(tmp_path):
    (tmp_path / "assets").mkdir()
    (tmp_path / "assets" / "a.stl").touch()
    text = '<mujoco><compiler meshdir="assets"/><asset><mesh file="a.stl"/></asset></mujoco>'
    (tmp_path / "a.xml").write_text(text)
    assert companions(tmp_path / "a.xml") == {"a.xml", "assets/a.stl"}


def test_layers_name_others_in_no_readable_way(tmp_path):
    (tmp_path / "layers").mkdir()
    for name in ("chair.usd", "layers/geometry.usdc", "paint.png"):
        (tmp_path / name).touch()
    assert companions(tmp_path / "chair.usd") == {"chair.usd", "layers/geometry.usdc"}


@pytest.mark.parametrize("name", ["../secret.mtl", "/etc/passwd.mtl", "a/../../secret.mtl"])
def test_what_lies_outside_stays_there(tmp_path, name):
    folder = tmp_path / "in"
    folder.mkdir()
    (tmp_path / "secret.mtl").write_text("newmtl secret")
    (folder / "a.obj").write_text(f"mtllib {name}\n")
    assert companions(folder / "a.obj") == {"a.obj"}


def test_a_sidecar_and_what_it_names(tmp_path):
    for name in ("a.stl", "a.pred.npz"):
        (tmp_path / name).touch()
    (tmp_path / "a.toml").write_text('annotation = "a.pred.npz"')
    assert companions(tmp_path / "a.stl") == {"a.stl", "a.toml", "a.pred.npz"}
