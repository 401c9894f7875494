"""``factory edit`` finds the mesh of what it is given, or says what is missing."""

import json
from pathlib import Path

import pytest
from shown_registry import make_registry

from asset_factory.factory.cli.commands import parse
from asset_factory.factory.cli.edit import _said
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


def test_a_build_is_given_what_was_typed():
    typed = ["--root", "a", "--root", "b", "--allow-outside", "--height", "0.5", "--up=-x"]
    _, edit = parse(["edit", "chest.glb", *typed, "--vlm-url", "http://here/v1"])
    _, build = parse(["build", "--input", "x", "--output", "y", *_said(edit.loading)])
    assert build.loading == edit.loading
    assert edit.loading.roots.root == (Path("a"), Path("b"))
