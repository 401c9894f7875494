"""What an input seems to refer to: all that its reader asks for, and nothing outside its folder."""

import pytest
from input_files import write_inputs

from asset_factory.factory.intake.companions import companions

MJCF = '<mujoco><compiler meshdir="assets"/><asset><mesh file="a.stl"/></asset></mujoco>'


@pytest.fixture(scope="module")
def inputs(tmp_path_factory):
    return write_inputs(tmp_path_factory.mktemp("here") / "meshes")


def test_a_description_brings_its_meshes_and_their_textures_and_a_mesh_no_other(inputs):
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
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    entry = next(iter(files))
    assert companions(folder / entry) == {entry, *brought}
