"""What is built installs and runs elsewhere; what is imported stays light."""

import json
import os
import re
import sys
import sysconfig
import tarfile
import venv
import zipfile

import pytest
from command_line import ran
from repository import ROOT

GEOMETRY = {"fcl", "scipy", "trimesh"}
SIMULATORS = {"coacd", "gymnasium", "mani_skill", "mujoco", "pybullet", "sapien"}
HEAVY = GEOMETRY | SIMULATORS | {"jinja2", "torch"}
HELP = """import asset_factory.factory.cli.commands as cli
try:
    cli.run(['--help'])
except SystemExit:
    pass"""


def modules_after(code):
    script = f"import sys, json\n{code}\nprint(json.dumps(sorted(sys.modules)))"
    return set(json.loads(ran(sys.executable, "-c", script).splitlines()[-1]))


@pytest.mark.parametrize(
    ("code", "banned"),
    [
        ("import asset_factory.factory, asset_factory.sim_checks", HEAVY),
        ("import asset_factory.factory.cli", HEAVY | {"numpy", "tyro"}),
        (HELP, HEAVY),
        ("import asset_factory.factory.models.particulate.loading", HEAVY),
        ("import asset_factory.factory.intake.discover", HEAVY - {"scipy"}),
        ("import asset_factory.sim_checks.judge", HEAVY - GEOMETRY),
        ("import asset_factory.factory.build, asset_factory.factory.jobs", HEAVY - GEOMETRY),
    ],
)
def test_what_needs_nothing_heavy_loads_nothing_heavy(code, banned):
    assert modules_after(code).isdisjoint(banned)


def test_importing_the_tasks_names_them_and_loads_no_simulator():
    names = {"OpenDrawer-v1", "OpenDoor-v1", "OpenJoint-v1", "CloseJoint-v1", "SetJoint-v1"}
    code = f"import asset_factory.envs, gymnasium\nassert {names} <= set(gymnasium.registry)"
    assert modules_after(code).isdisjoint({"torch", "sapien", "mani_skill"})


@pytest.fixture(scope="module")
def distributions(tmp_path_factory):
    target = tmp_path_factory.mktemp("dist")
    ran(sys.executable, "-m", "build", "--no-isolation", "--outdir", target, ROOT)
    return target


def test_the_wheel_holds_real_files_and_nothing_else(distributions):
    (wheel,) = distributions.glob("*.whl")
    names = {name for name in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in name}
    assert {
        "asset_factory/py.typed",
        "asset_factory/factory/build.py",
        "asset_factory/factory/report/nightly/templates/night.html.j2",
        "asset_factory/sim_checks/report.py",
        "asset_factory/envs/__init__.py",
        "asset_factory/configs/presets/strict.toml",
        "asset_factory/configs/categories.toml",
        "asset_factory/configs/weights/trust.safetensors",
        "asset_factory/configs/weights/trust.md",
    } <= names
    assert all(name.startswith("asset_factory/") for name in names)
    assert not any("/tests/" in name or name.endswith(".pyc") for name in names)


def test_the_description_holds_away_from_the_repository(distributions):
    (wheel,) = distributions.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        (name,) = (each for each in archive.namelist() if each.endswith("dist-info/METADATA"))
        told = archive.read(name).decode()
    source = re.search(r"^Project-URL: Source, (\S+)$", told, re.MULTILINE)[1]
    targets = re.findall(r"\]\(([^)]+)\)", told)
    assert all(target.startswith("https://") for target in targets)
    files = [re.sub(r".*/main/", "", each).split("#")[0] for each in targets if source in each]
    assert "docs/pictures/made.png" in files
    assert [each for each in files if not (ROOT / each).exists()] == []
    for needed in ("Author", "Classifier", "License-Expression", "Requires-Python"):
        assert f"\n{needed}: " in told


def test_the_source_distribution_has_no_links(distributions):
    (sdist,) = distributions.glob("*.tar.gz")
    with tarfile.open(sdist) as archive:
        assert not [member.name for member in archive if member.issym() or member.islnk()]


def test_the_wheel_runs_in_a_fresh_environment(distributions, tmp_path):
    (wheel,) = distributions.glob("*.whl")
    venv.create(tmp_path / "venv", with_pip=False)
    python = tmp_path / "venv" / "bin" / "python"
    install = (sys.executable, "-m", "pip", "--python", python, "install", "--no-deps", wheel)
    ran(*install, env={**os.environ, "PIP_DISABLE_PIP_VERSION_CHECK": "1"})
    # Its dependencies are lent from here: what is tested is the wheel, not the network.
    lent = {"PYTHONPATH": sysconfig.get_path("purelib"), "PATH": os.environ["PATH"]}
    there = {"env": lent, "cwd": tmp_path}
    command = python.with_name("factory")
    assert "build" in ran(command, "--help", **there)
    # Not part of the test: the editable checkout must not be what answers.
    where = "import asset_factory; print(asset_factory.__file__)"
    assert str(tmp_path) in ran(python, "-c", where, **there)
    (tmp_path / "broken.stl").write_bytes(b"not a mesh")
    ran(command, "build", "--input", "broken.stl", "--output", "out", **there)
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert (summary["inputs"], summary["rejected"]) == (1, 1)
    assert summary["assets"][0]["reason"] == "unreadable"
