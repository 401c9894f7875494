"""The GitHub Action and the pre-commit hook, run here as their runners run them."""

import json
import os
import re
import shlex
import subprocess
import sys

import pytest
import yaml
from box_world import write_drawer
from repository import ROOT


@pytest.fixture
def repository(tmp_path):
    """A folder of assets, one sound and one not, where ``factory`` is this checkout's."""
    for name, length in (("sound", "1"), ("broken", "2")):
        path = write_drawer(tmp_path / "assets" / f"{name}.urdf", 0.004)
        joint = path.read_text().replace('axis xyz="1 0 0"', f'axis xyz="{length} 0 0"')
        path.write_text(joint.replace("<joint", "\n\n\n<joint"))
    program = tmp_path / "bin" / "factory"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\nexec {sys.executable} -m asset_factory.factory.cli "$@"\n')
    program.chmod(0o755)
    return tmp_path


def run(repository, command, **env):
    path = f"{repository / 'bin'}:{os.environ['PATH']}"
    return subprocess.run(
        command,
        cwd=repository,
        env={**os.environ, "PATH": path, **env},
        capture_output=True,
        text=True,
        check=False,
    )


def act(repository, **inputs):
    """Run the step of the Action that checks, its inputs filled in as GitHub does."""
    action = yaml.safe_load((ROOT / "action.yml").read_text())
    values = {name: each["default"] for name, each in action["inputs"].items()} | inputs
    (step,) = (each for each in action["runs"]["steps"] if each.get("name") == "Check")
    env = {
        name: re.sub(r"\$\{\{ inputs\.(\w+) \}\}", lambda found: values[found[1]], value)
        for name, value in step["env"].items()
    }
    summary = str(repository / "summary.md")
    bash = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]]
    return run(repository, bash, GITHUB_STEP_SUMMARY=summary, **env)


def test_the_action_annotates_and_fails_for_what_is_new_alone(repository):
    done = act(repository, path="assets", sim="")
    assert done.returncode == 1, done.stderr
    assert done.stdout.startswith("::error file=assets/broken.urdf,line=4,title=axis_not_unit::")
    assert "| error | [axis_not_unit](" in (repository / "summary.md").read_text()
    sarif = json.loads((repository / "factory-check.sarif").read_text())
    assert "axis_not_unit" in [each["ruleId"] for each in sarif["runs"][0]["results"]]
    known = ["factory", "check", "assets", "--sim", "", "--write-baseline", "known.json"]
    assert run(repository, known).returncode == 0
    assert act(repository, path="assets", sim="", baseline="known.json").returncode == 0


def test_the_hook_takes_the_files_it_names(repository):
    (hook,) = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())
    staged = ["assets/broken.urdf", "assets/sound.urdf", "package.xml", "notes.txt"]
    files = [each for each in staged if re.search(hook["files"], each)]
    assert files == staged[:2]
    entry = [*shlex.split(hook["entry"])[:-1], ""]
    done = run(repository, [*entry, *files])
    assert done.returncode == 1, done.stderr
    assert "axis_not_unit" in done.stdout
    assert run(repository, [*entry, "assets/sound.urdf"]).returncode == 0
