"""One input has one current asset: a corrected sidecar leaves no twin that tasks draw."""

import json
import shutil

import trimesh
from job_samples import job

from asset_factory.envs.assets import read_registry
from asset_factory.factory.cli.commands import run
from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.aside import superseded


def built(folder, height, output, size=1.0):
    """The id of the box in a folder, once it is built at a height, and what it replaced."""
    folder.mkdir(exist_ok=True)
    trimesh.creation.box((1.0, 1.0, size)).export(folder / "box.obj")
    (folder / "box.toml").write_text(f"height = {height}\n")
    (result,) = job((folder / "box.obj",), output).run()
    assert result.entry.status == "passed"
    return result.entry.id, result.replaced


def test_a_corrected_sidecar_supersedes_and_one_put_back_comes_back(tmp_path, capsys):
    out = tmp_path / "out"
    wrong, _ = built(tmp_path / "in", 1.0, out)
    Registry(out).note(wrong, tags=("kept",))
    right, replaced = built(tmp_path / "in", 2.0, out)
    assert wrong != right
    assert replaced == (wrong,)
    assert [entry.id for entry in Registry(out).entries()] == [right]
    assert list(read_registry(out)) == [right]
    assert [entry.id for entry in superseded(out)] == [wrong]
    assert run(["list", "--output", str(out), "--superseded", "--json"]) == 0
    assert [row["id"] for row in json.loads(capsys.readouterr().out)] == [wrong]

    again, replaced = built(tmp_path / "in", 1.0, out)
    assert (again, replaced) == (wrong, (right,))
    assert Registry(out).entry(wrong).tags == ("kept",)


def test_the_same_file_elsewhere_stays_what_it_was(tmp_path):
    out = tmp_path / "out"
    first, _ = built(tmp_path / "one", 1.0, out)
    assert built(tmp_path / "two", 1.0, out) == (first, ())
    second, replaced = built(tmp_path / "two", 2.0, out)
    assert replaced == ()
    assert {entry.id for entry in Registry(out).entries()} == {first, second}
    # Once nobody has it any more, it goes with the next correction.
    shutil.rmtree(tmp_path / "one")
    (tmp_path / "two" / "box.obj").rename(tmp_path / "two" / "gone.obj")
    assert built(tmp_path / "two", 3.0, out)[1] == (second,)


def test_another_mesh_in_its_place_is_another_input(tmp_path):
    out = tmp_path / "out"
    first, _ = built(tmp_path / "in", 1.0, out)
    second, replaced = built(tmp_path / "in", 1.0, out, size=2.0)
    assert {entry.id for entry in Registry(out).entries()} == {first, second}
    assert replaced == ()
