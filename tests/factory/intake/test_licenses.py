"""Which licenses a configuration lets in, and who states that of an input."""

import re

import pytest
from fuzz_cases import MJCF, URDF, cube_files
from mesh_cube import write_glb, write_obj
from refusing import refusal

from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.intake.licenses import require_allowed
from asset_factory.factory.intake.load import load


@pytest.mark.parametrize(
    ("license", "allowed", "is_allowed"),
    [
        ("CC-BY-4.0", (), True),
        (None, (), True),
        ("CC-BY-4.0", ("cc-by-4.0",), True),
        (" CC-BY-4.0\n", ("CC-BY-4.0",), True),
        ("CC-BY-NC-4.0", ("CC-BY-4.0", "CC0-*"), False),
        ("CC0-1.0", ("CC-BY-4.0", "cc0-*"), True),
        ("CC-BY-4.0 and more", ("CC-BY-4.0",), False),
        (None, ("CC-BY-4.0",), False),
        (None, ("*",), False),
        (None, ("CC-BY-4.0", "Unknown"), True),
        ("  ", ("unknown",), True),
        ("CC-BY-4.0", ("unknown",), False),
        ("CC0-1.0; CC-BY-4.0", ("CC0-*", "CC-BY-4.0"), True),
        ("CC0-1.0; Proprietary", ("CC0-*", "CC-BY-4.0"), False),
        (";", ("CC0-*",), False),
        ("Custom [v2]", ("Custom [v2]",), True),
    ],
)
def test_licenses_are_matched_by_name_or_pattern_in_any_case(license, allowed, is_allowed):
    if is_allowed:
        require_allowed("cube.glb", license, allowed)
        return
    found = refusal(require_allowed, "cube.glb", license, allowed)
    assert found.code == "license_disallowed"
    assert " ".join((license or "").split()) in found.message
    assert all(name in found.message for name in allowed)


def inputs(folder):
    for name, data in {**cube_files(), "box.urdf": URDF.encode()}.items():
        (folder / name).write_bytes(data)
    inline = MJCF.replace('<include file="assets.xml"/>', "")
    inline = inline.replace('type="mesh" mesh="cube" material="wood"', 'size="1"')
    (folder / "robot.xml").write_text(inline)
    return {"mesh": write_obj(folder), "urdf": folder / "box.urdf", "mjcf": folder / "robot.xml"}


@pytest.mark.parametrize("form", ["mesh", "urdf", "mjcf"])
def test_a_sidecar_states_the_license_of_every_kind_of_input(form, tmp_path):
    path = inputs(tmp_path)[form]
    strict = IntakeConfig(allowed_licenses=("CC-BY-4.0",))
    assert "nobody says under which license it stands" in refusal(load, path, strict).message
    path.with_suffix(".toml").write_text('license = "CC-BY-NC-4.0"\n')
    found = refusal(load, path, strict)
    assert found.code == "license_disallowed"
    assert re.search(r"'CC-BY-NC-4\.0', and the .* allows only CC-BY-4\.0", found.message)
    provenance = load(path, IntakeConfig(allowed_licenses=("CC-BY-*",))).provenance
    assert (provenance.license, provenance.input) == ("CC-BY-NC-4.0", path.name)
    assert str(tmp_path) not in str(provenance)


def test_a_file_or_the_meshes_of_a_description_speak_where_no_sidecar_does(tmp_path):
    described = inputs(tmp_path)["urdf"]
    mesh = write_glb(tmp_path)
    described.write_text(URDF.replace("cube.obj", "cube.glb"))
    config = IntakeConfig(allowed_licenses=("cc0-1.0",))
    for path in (described, mesh):
        assert load(path, config).provenance.license == "CC0-1.0"
        assert "CC0-1.0" in refusal(load, path, IntakeConfig(allowed_licenses=("MIT",))).message
        path.with_suffix(".toml").write_text('license = "proprietary"\n')
        assert "proprietary" in refusal(load, path, config).message
