"""What the commands print and how they exit."""

import io
import json
import re
import shlex
import sys
import tarfile
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from command_line import ran
from registry_samples import BAD_REPORT, REJECTED, named, publish, three_entries
from shown_registry import HOSTILE, make_registry

from asset_factory.factory.cli import console
from asset_factory.factory.cli.build import Build, idle_retries
from asset_factory.factory.cli.commands import run as factory
from asset_factory.factory.registry import Registry
from asset_factory.factory.runtime.store import Store
from asset_factory.factory.runtime.terminal import Terminal


@pytest.fixture
def root(tmp_path):
    return three_entries(tmp_path / "out").root


@pytest.fixture
def run(capsys):
    def ask(*arguments):
        return factory([str(item) for item in arguments]), capsys.readouterr().out

    return ask


def test_a_list_goes_on_after_its_limit(root, run):
    _, out = run("list", "--output", root, "--limit", 1)
    assert "the first 1; --after cabinet-1 goes on" in out
    _, out = run("list", "--output", root, "--limit", 2, "--after", "cabinet-1")
    assert "--after" not in out


@pytest.mark.parametrize(
    ("where", "ids"),
    [
        ("", ["cabinet-1", "chest-1", "fridge-1"]),
        ('category != "fridge" and parts >= 1', ["cabinet-1", "chest-1"]),
        ("status != passed", ["chest-1"]),
        ("status = passed and category=fridge", ["fridge-1"]),
        ("joints > 0 and gpu-ready = yes", ["cabinet-1", "fridge-1"]),
        ("hulls > 100000", []),
    ],
)
def test_conditions_choose(where, ids, root, run):
    code, out = run("list", "--output", root, "--json", *(["--where", where] if where else []))
    assert (code, [row["id"] for row in json.loads(out)]) == (0, ids)


def test_a_value_that_no_asset_has_is_told(root, capsys):
    assert factory(["list", "--output", str(root), "--where", "category = frige"]) == 0
    printed = capsys.readouterr()
    assert "no asset has category 'frige'; did you mean 'fridge'?" in printed.err
    assert printed.out == "no assets with category = frige\n"


def test_removing_takes_what_is_named_and_asks(root, monkeypatch, capsys):
    remove = ["remove", "--output", str(root)]
    assert factory([*remove, "fridge-1"]) == 2
    assert "--yes does it" in capsys.readouterr().err
    monkeypatch.setattr("sys.stdin", Answering("n\n"))
    assert factory([*remove, "fridge-1"]) == 0
    assert Registry(root).find("fridge-1") is not None
    monkeypatch.setattr("sys.stdin", Answering("y\n"))
    assert factory([*remove, "fridge-1"]) == 0
    assert factory([*remove, "--where", "status = rejected", "--yes"]) == 0
    assert [entry.id for entry in Registry(root).entries()] == ["cabinet-1"]
    assert not (root / "assets" / "fridge-1").exists()
    assert not (root / "rejected" / "chest-1").exists()
    assert factory([*remove, "--where", "hulls > 9999", "--yes"]) == 2


class Answering(io.StringIO):
    """Somebody who answers."""

    def isatty(self):
        return True


@pytest.mark.parametrize("asset_id", ["filing_cabinet-657fead206", f"{'long_' * 16}-657fead206"])
def test_ids_are_whole_in_a_list_of_80_columns(capsys, monkeypatch, asset_id):
    monkeypatch.setattr(console, "terminal", lambda: Terminal(width=80))
    rejected = named(asset_id, category="cabinet", reason="no_movable_joint", status="rejected")
    console.print_entries([(named(asset_id, category="dishwasher"), None), (rejected, None)])
    lines = [line for line in capsys.readouterr().out.splitlines() if line[0] != " "]
    assert [line.split()[0] for line in lines] == ["id", asset_id, asset_id]


def test_a_report_that_is_none_is_told_in_a_line(root, capsys):
    (root / "assets" / "fridge-1" / "report.json").write_text('{"passed": true}')
    assert factory(["show", "fridge-1", "--output", str(root)]) == 2
    assert "report.json: is none of a build" in capsys.readouterr().err


def test_show_tells_size_joints_files_and_how_to_load_it(tmp_path, run):
    root = make_registry(tmp_path / "out").root
    log = root / "logs" / "builds.jsonl"
    log.parent.mkdir(exist_ok=True)
    stages = [{"stage": "load", "seconds": 0.25}, {"stage": "judge", "seconds": 4.0}]
    log.write_text(json.dumps({"id": "cabinet-1", "input": "x.glb", "stages": stages}))
    _, out = run("show", "cab", "--output", root)
    assert "seconds of its last build: load 0.25, judge 4\n" in out
    assert "0.6 x 0.45 x 0.8 m" in out
    assert re.search(r"^ *hinge +revolute +part_1 +0 deg +92 deg ", out, re.MULTILINE)
    assert re.search(r"^ *slide +prismatic +part_2 +0 mm +300 mm ", out, re.MULTILINE)
    assert "asset.json, asset.urdf, asset.xml, meshes/ (" in out
    assert f"registry={str(root)!r}, asset='cabinet-1')" in out
    (loading,) = re.findall(r"in MuJoCo:\n(.*\n.*)\n", out)
    loaded = {}
    exec(loading, loaded)  # noqa: S102 - the lines that people are told to run
    assert loaded["model"].njnt == 2
    shown = json.loads(run("show", "cab", "--output", root, "--json")[1])
    assert shown["changes"] == [{"kind": "hulls_cut_apart", "pairs": [[HOSTILE, "base"]]}]
    assert (shown["report"]["passed"], shown["manifest"]["name"]) == (True, "cabinet")
    (packing,) = re.findall(r"in a shell, as an archive to hand on:\n(.*)\n", out)
    ran(*shlex.split(packing), cwd=tmp_path)
    with tarfile.open(tmp_path / "cabinet-1.tar.gz") as archive:
        assert {"cabinet-1/asset.urdf", "cabinet-1/asset.json"} <= set(archive.getnames())


def test_the_lines_for_isaac_put_an_asset_on_its_stage(tmp_path, run, monkeypatch):
    usd = pytest.importorskip("pxr.Usd", reason="usd-core is not installed")
    root = make_registry(tmp_path / "out").root
    written = usd.Stage.CreateNew(str(root / "assets" / "cabinet-1" / "asset.usd"))
    written.SetDefaultPrim(written.DefinePrim("/cabinet"))
    written.DefinePrim("/cabinet/door")
    written.Save()
    stage = usd.Stage.CreateInMemory()
    isaac = SimpleNamespace(get_context=lambda: SimpleNamespace(get_stage=lambda: stage))
    monkeypatch.setitem(sys.modules, "omni", SimpleNamespace(usd=isaac))
    monkeypatch.setitem(sys.modules, "omni.usd", isaac)
    _, out = run("show", "cab", "--output", root)
    (loading,) = re.findall(r"in Isaac Sim, .*:\n(.*\n.*\n.*)\n", out)
    exec(loading, {})  # noqa: S102 - the lines that people are told to run
    assert stage.GetPrimAtPath("/World/asset/door").IsValid()


def test_a_beginning_names_the_only_asset_that_has_it(root, run, capsys):
    assert "fridge-1: " in run("show", "f", "--output", root)[1]
    told = run("registry", "tag", "fri", "cold", "--output", root)[1]
    assert told == "fridge-1: blue, cold\n"
    assert run("registry", "verify", "cab", "--output", root)[0] == 0
    publish(Registry(root), entry=named("fridge-10"))
    assert "fridge-1: " in run("show", "fridge-1", "--output", root)[1]
    for wrong in ("fridge", "", "x"):
        assert factory(["show", wrong, "--output", str(root)]) == 2
        assert "no asset" in capsys.readouterr().err


def test_verify_exits_with_1_for_damage(root, run):
    told = "3 entries: 0 are not as they were published\n"
    assert run("registry", "verify", "--output", root) == (0, told)
    (root / "assets" / "cabinet-1" / "asset.urdf").unlink()
    code, out = run("registry", "verify", "--output", root, "--json")
    assert (code, json.loads(out)[0]["kind"]) == (1, "missing")
    assert run("registry", "verify", "fridge-1", "--output", root)[0] == 0


def test_rebuild_and_gc(root, run):
    (root / "registry.db").unlink()
    told = (0, "3 entries; 0 folders could not be read\n")
    assert run("registry", "rebuild", "--output", root) == told
    Store(root / ".cache").save("stage-0", {"zeros": np.zeros(10)})
    _, told = run("gc", "--output", root, "--older-than", 30)
    assert "freed 0 bytes" in told
    assert re.search(r"the cache holds 1 results, \d+ bytes; --keep-gb 1 makes it smaller", told)


def test_out_and_in_and_the_difference(root, run, tmp_path):
    target = tmp_path / "x.tar.gz"
    other = tmp_path / "other"
    _, out = run("registry", "export", target, "--output", root)
    assert out.startswith(f"{target}: ")
    _, out = run("registry", "import", target, "--output", other)
    assert out.startswith("2 assets imported")
    code, out = run("registry", "diff", root, other, "--strict")
    assert code == 1
    assert "gone: chest-1: rejected, rest_penetration: 5 mm deep" in out
    Registry(other).add(replace(REJECTED, id="fridge-1"), BAD_REPORT)
    _, out = run("registry", "diff", root, other)
    assert "newly failed: fridge-1: rest_penetration: 5 mm deep" in out


def test_tags_and_splits(root, run):
    for asked, told in (
        (("tag", "cabinet-1", "b", "a"), "cabinet-1: a, b\n"),
        (("untag", "cabinet-1", "b"), "cabinet-1: a\n"),
        (("untag", "cabinet-1"), "cabinet-1: no tags\n"),
    ):
        assert run("registry", *asked, "--output", root) == (0, told)
    _, out = run("registry", "split", "--output", root)
    assert sorted(line.split("\t")[1] for line in out.splitlines()) == ["cabinet-1", "fridge-1"]


def test_reasons_to_be_retried_that_nothing_has_are_named_with_those_there_are(root):
    reason = Registry(root).entry("chest-1").reason
    said = list(idle_retries(Build((), root, retry_rejected=("nonsense", "any"))))
    assert said == [f"--retry-rejected: nothing was rejected for 'nonsense'; there are {reason}"]
    assert list(idle_retries(Build((), root, retry_rejected=(reason,)))) == []
