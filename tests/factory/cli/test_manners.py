"""How the command line behaves: pipes that close, interruptions, narrow terminals, a doctor."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from asset_factory import __version__
from asset_factory.factory.cli import flags as flags_module
from asset_factory.factory.cli.commands import parse, run
from asset_factory.factory.cli.edit import _said
from asset_factory.factory.report import machine
from asset_factory.factory.report.machine import Ability, Health, Library, abilities
from asset_factory.learn.commands.evaluation_printing import COLUMNS, _fitting
from asset_factory.sim_checks.simulators.catalog import SIMULATORS


def test_a_reader_that_has_seen_enough_gets_no_traceback():
    lines = "from asset_factory.factory.cli import commands\n"
    lines += "commands.run = lambda arguments: print('x\\n' * 100_000) or 0\n"
    lines += "commands.main()\n"
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen([sys.executable, "-c", lines], **pipes) as process:
        process.stdout.readline()
        process.stdout.close()
        assert process.stderr.read() == b""
        assert process.wait() == 141


def test_a_build_is_given_what_was_typed():
    typed = ["--root", "a", "--root", "b", "--allow-outside", "--height", "0.5", "--up=-x"]
    _, edit = parse(["edit", "chest.glb", *typed, "--vlm-url", "http://here/v1"])
    _, build = parse(["build", "--input", "x", "--output", "y", *_said(edit.loading)])
    assert build.loading == edit.loading
    assert edit.loading.roots.root == (Path("a"), Path("b"))


def test_the_help_is_short_and_begins_with_the_first_hour(capsys):
    for typed, code in (([], 2), (["--help"], 0)):
        with pytest.raises(SystemExit) as left:
            run(typed)
        assert left.value.code == code
        told = capsys.readouterr().out.splitlines()
        assert len(told) < 40
        assert [line for line in told if line.endswith("...")] == []
        first = [line.split()[0] for line in told[told.index("") :] if line.startswith("  ")]
        assert first[3:11] == ["build", "check", "view", "edit", "list", "show", "solve", "demos"]
        assert set(first[11:]) >= {"doctor", "remove", "gc", "train"}
    with pytest.raises(SystemExit):
        run(["--version"])
    assert capsys.readouterr().out == f"asset-factory {__version__}\n"


@pytest.mark.parametrize("command", [["build", "--output", "out", "--input"], ["check"]])
def test_an_engine_that_is_missing_is_refused_at_the_start(command, monkeypatch, capsys):
    monkeypatch.setattr(flags_module, "installed", lambda name: name != "pybullet")
    assert run([*command, __file__, "--sim", "all"]) == 2
    told = capsys.readouterr().err
    assert "pybullet is not installed: pip install 'asset-factory[pybullet]'" in told


def test_shells_can_complete_commands_and_flags(capsys):
    with pytest.raises(SystemExit) as left:
        run(["--tyro-print-completion", "bash"])
    assert not left.value.code
    told = capsys.readouterr().out
    assert "nightly" in told
    assert "--retry-rejected" in told


def test_a_narrow_terminal_gets_fewer_columns_and_a_wide_one_all():
    columns = COLUMNS["physical"]
    assert _fitting(columns, 240) == columns
    assert 0 < len(_fitting(columns, 80)) < len(_fitting(columns, 120)) < len(columns)


@pytest.fixture
def bare(monkeypatch):
    """A machine without libraries or simulators to be tried."""
    monkeypatch.setattr(machine, "LIBRARIES", ())
    monkeypatch.setattr(machine, "SIMULATORS", {})


@pytest.mark.usefixtures("bare")
def test_the_doctor_says_what_is_missing_and_what_is_broken(monkeypatch, tmp_path):
    broken = Library("broken", "nothing", "json", _raises, "build", "another machine")
    missing = Library("missing", "nothing", "no_such_module", _raises, "build")
    fine = Library("fine", "nothing", "json", _fine, "build")
    monkeypatch.setattr(machine, "LIBRARIES", (broken, missing, fine))
    found = {each.name: each for each in abilities(tmp_path / "not" / "there")}
    assert found["disk"].health is Health.WORKS
    assert (found["broken"].health, found["broken"].remedy) == (Health.BROKEN, "another machine")
    assert "it does not" in found["broken"].detail
    assert found["missing"].remedy == "pip install 'asset-factory[build]'"
    assert (found["fine"].health, found["fine"].detail) == (Health.WORKS, "as it should")


@pytest.mark.usefixtures("bare")
@pytest.mark.parametrize("name", SIMULATORS)
def test_the_doctors_trial_is_one_that_engines_pass(name, monkeypatch, tmp_path):
    monkeypatch.setattr(machine, "SIMULATORS", {name: SIMULATORS[name]})
    found = {each.name: each for each in abilities(tmp_path)}
    assert found[name].health in (Health.WORKS, Health.MISSING), found[name]


@pytest.mark.usefixtures("bare")
def test_the_doctor_prints_json_and_tells_whether_a_build_can_run(capsys, tmp_path):
    assert run(["doctor", "--output", str(tmp_path), "--json"]) == 1
    assert [each["name"] for each in json.loads(capsys.readouterr().out)] == ["machine", "disk"]


def test_the_doctor_tells_each_as_soon_as_it_is_tried(monkeypatch, capsys):
    told = []

    def slowly(_):
        for name in ("first", "second"):
            told.append(capsys.readouterr().out)
            yield Ability(name, "a test", Health.MISSING, "not installed", "pip install it")

    monkeypatch.setattr(machine, "abilities", slowly)
    assert run(["doctor"]) == 1
    assert "Every engine" in told[0]
    assert "first" in told[1]
    assert "pip install it" in told[1]


def test_a_quiet_build_says_nothing(capsys, tmp_path):
    (tmp_path / "brick.stl").write_text("solid nothing\nendsolid nothing\n")
    build = ["build", "--input", str(tmp_path / "brick.stl"), "--output", str(tmp_path / "out")]
    assert run([*build, "--sim", "mujoco", "--quiet"]) == 0
    assert capsys.readouterr() == ("", "")


def _raises():
    raise RuntimeError("it does not")


def _fine():
    return "as it should"
