"""Every worked example in CONTRIBUTING.md is run: its line goes into its table, and works."""

import re
import sys
from types import ModuleType

import numpy as np
import pytest
import trimesh
from export_samples import PROVENANCE
from export_samples import cabinet as small_asset
from manifold3d import Manifold
from openable_samples import cabinet, write_registry
from repository import ROOT
from small_cabinet import write_urdf

from asset_factory.envs.tasks import catalog as tasks
from asset_factory.factory.articulate import catalog as articulators
from asset_factory.factory.cli import commands as cli
from asset_factory.factory.config import BuildConfig, DecomposeConfig, IntakeConfig, RepairConfig
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.export import export_bundle
from asset_factory.factory.export import formats as export_formats
from asset_factory.factory.intake.discover import find_inputs
from asset_factory.factory.intake.formats import catalog as formats
from asset_factory.factory.intake.intake import Intake, Provenance
from asset_factory.factory.intake.loading import load_mesh
from asset_factory.factory.manufacture.decompose import methods
from asset_factory.factory.manufacture.plan import Plan, Spare
from asset_factory.factory.mesh import Mesh
from asset_factory.factory.registry import Registry
from asset_factory.factory.verify import repair
from asset_factory.factory.verify.validate import Verdict
from asset_factory.sim_checks import Finding, Report, Severity
from asset_factory.sim_checks.checks import catalog as checks
from asset_factory.sim_checks.config import CheckConfig
from asset_factory.sim_checks.judge import examine_here
from asset_factory.sim_checks.simulators import catalog as simulators

PAGE = ROOT / "CONTRIBUTING.md"
SECTION = re.compile(r"^### (.+?)\n(.*?)(?=^### |\Z)", re.MULTILINE | re.DOTALL)
EXAMPLES = {
    heading: re.search(r"```python\n(.*?)```", text, re.DOTALL)
    for heading, text in SECTION.findall(PAGE.read_text(encoding="utf-8"))
}


def example(heading, monkeypatch, **names):
    """The line of a section's example, which becomes the module that it says it is."""
    found = EXAMPLES[heading]
    assert found is not None, f"no example under {heading!r}"
    path = found[1].splitlines()[0].removeprefix("# ").removesuffix(".py")
    module = ModuleType("asset_factory." + path.replace("/", "."))
    vars(module).update(names)
    monkeypatch.setitem(sys.modules, module.__name__, module)
    exec(compile(found[1], str(PAGE), "exec"), vars(module))  # noqa: S102 - our own page
    return module.LINE


def listed(heading, monkeypatch, module, table, **names):
    """The example's line, in its place at the end of a module's table."""
    line = example(heading, monkeypatch, **names)
    lines = getattr(module, table)
    more = (*lines, line) if isinstance(lines, tuple) else {**lines, line.name: line}
    monkeypatch.setattr(module, table, more)
    return line


def test_a_mesh_format(tmp_path, monkeypatch):
    listed("A mesh format", monkeypatch, formats, "FORMATS", MeshFormat=formats.MeshFormat)
    corners = trimesh.creation.box((0.6, 0.4, 0.8)).triangles
    (tmp_path / "in").mkdir()
    path = tmp_path / "in" / "box.tri"
    path.write_text(" ".join(str(number) for number in corners.ravel()))
    assert find_inputs([tmp_path]) == (path,)
    assert len(load_mesh(path, IntakeConfig()).mesh.faces) == len(corners)
    path.write_text("not a number")
    with pytest.raises(InputRejected, match=r"box\.tri: cannot be read|could not convert"):
        load_mesh(path, IntakeConfig())


def articulated(heading, name, monkeypatch):
    """The one joint that the example's articulator finds on a box called like it."""
    entry = articulators.ArticulatorEntry
    line = listed(heading, monkeypatch, articulators, "ARTICULATORS", ArticulatorEntry=entry)
    shape = trimesh.creation.box((0.6, 0.4, 0.8)).subdivide().subdivide().subdivide()
    mesh = Mesh.from_triangles(shape.vertices, shape.faces)
    intake = Intake(name, mesh, np.arange(len(mesh.faces)), np.eye(4), Provenance(name, "0"))
    chosen = articulators.choose(intake, BuildConfig(articulator=line.name))
    (joint,) = chosen.articulate(mesh).movable_joints
    return joint


def test_an_articulator(monkeypatch):
    assert articulated("An articulator", "it", monkeypatch).name == "lid_hinge"


def test_a_proposer(monkeypatch):
    joint = articulated("A proposer", "my_chest", monkeypatch)
    assert joint.name == "lid_0_hinge"
    assert joint.origin[1:] == pytest.approx([0.2, 0.24], abs=0.01)


def test_a_decomposition(monkeypatch):
    line = example("A decomposition", monkeypatch)
    monkeypatch.setattr(methods, "METHODS", (line, *methods.METHODS))
    split = methods.split_solid(Manifold.sphere(0.5), 0.005, DecomposeConfig())
    assert len(split.hulls) == 2


def test_a_repair(monkeypatch):
    listed("A repair", monkeypatch, repair, "REPAIRS")
    jammed = Finding("jammed", Severity.ERROR, "it jams", joint="button")
    verdict = Verdict(Report("asset.urdf", findings=(jammed,)))
    spare = Spare(frozenset({"button"}))
    told = (RepairConfig(), spare, small_asset())
    plan = repair.next_plan(verdict, Plan(), *told)
    assert plan.frozen == {"button"}
    assert [each.sentence for each in plan.repairs] == ["froze button: it jams"]
    assert repair.next_plan(verdict, plan, *told) is None


def test_an_export_format(monkeypatch, tmp_path):
    tools = {"Format": export_formats.Format, "as_text": export_formats.as_text}
    listed("An export format", monkeypatch, export_formats, "FORMATS", **tools)
    asset = small_asset()
    export_bundle(asset, PROVENANCE, tmp_path, formats=("joints",))
    rows = (tmp_path / "joints.csv").read_text().splitlines()
    assert len(rows) == len(asset.articulation.joints)


def test_a_check(monkeypatch, tmp_path):
    listed("A check", monkeypatch, checks, "CHECKS", StaticCheck=checks.StaticCheck)
    examined = examine_here(write_urdf(tmp_path), CheckConfig())
    assert examined.measurements["few_links"] == {"links": 3}
    assert "many_links" in {finding.code for finding in examined.findings}


def test_a_simulator(monkeypatch, tmp_path):
    listed("A simulator", monkeypatch, simulators, "SIMULATORS")
    assert simulators.installed("stricter")
    world = simulators.simulator("stricter").open(write_urdf(tmp_path), CheckConfig().motion)
    try:
        assert world.joints
    finally:
        world.close()


def test_a_task(monkeypatch, tmp_path):
    pytest.importorskip("mani_skill")
    import gymnasium

    line = tasks.Task("HalfOpen-v1", "half_open", "HalfOpenEnv")
    monkeypatch.setattr(tasks, "TASKS", (*tasks.TASKS, line))
    assert line == example("A task", monkeypatch, Task=tasks.Task)
    tasks.register_tasks()
    modes = {"obs_mode": "state", "sim_backend": "physx_cpu", "render_backend": "none"}
    registry = write_registry(tmp_path, cabinet())
    environment = gymnasium.make(line.id, registry=registry, num_envs=1, **modes)
    try:
        observation, _ = environment.reset(seed=0)
        assert np.isfinite(np.asarray(observation)).all()
    finally:
        environment.close()
        gymnasium.registry.pop(line.id)


def test_a_command(monkeypatch, tmp_path, capsys):
    listed("A command", monkeypatch, cli, "COMMANDS", Command=cli.Command)
    Registry(tmp_path / "new", create=True)
    assert cli.run(["count", "--output", str(tmp_path / "new")]) == 0
    assert capsys.readouterr().out == "0\n"
