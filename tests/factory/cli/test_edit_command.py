"""``factory edit`` finds the mesh of what it is given, or says what is missing."""

import json

import pytest
from shown_registry import make_registry

from asset_factory.factory.cli.commands import run
from asset_factory.factory.edit.subject import subject_of
from asset_factory.factory.errors import ConfigError, RegistryError


@pytest.fixture
def registry(tmp_path):
    return make_registry(tmp_path / "out")


def test_the_input_of_an_asset_is_found_by_the_log(registry, tmp_path):
    (tmp_path / "chest.glb").touch()
    lines = [{"id": "hitting-2", "input": name} for name in ("old.glb", "chest.glb")]
    log = registry.root / "logs" / "builds.jsonl"
    log.parent.mkdir()
    log.write_text("\n".join(["hitting-2 {", '["hitting-2"]', *map(json.dumps, lines)]))
    folder = registry.rejected / "hitting-2"
    for given, output in ((folder, None), (folder.relative_to("/").name, registry.root)):
        found = subject_of(type(folder)(given), output, tmp_path / "usual")
        assert found.mesh.resolve() == (tmp_path / "chest.glb").resolve()
        assert (found.output.resolve(), found.asset) == (registry.root.resolve(), folder)
    (tmp_path / "chest.glb").unlink()
    with pytest.raises(ConfigError, match=r"chest\.glb: hitting-2 was made of it"):
        subject_of(folder, None, tmp_path)
    log.unlink()
    with pytest.raises(RegistryError, match="its log does not say"):
        subject_of(folder, None, tmp_path)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nothing.glb"], "no such file or asset"),
        (["robot.urdf"], "parts are stated of a mesh"),
        (["broken.glb"], "broken.glb: unreadable"),
        (["broken.glb", "--port", "70000"], "--port"),
        (["broken.glb", "--sim", "unity"], "--sim"),
    ],
)
def test_edit_says_what_is_wrong(tmp_path, capsys, monkeypatch, arguments, said):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "robot.urdf").touch()
    (tmp_path / "broken.glb").write_bytes(b"glTF?")
    assert run(["edit", *arguments]) == 2
    assert said in capsys.readouterr().err
