"""The way to the judge: no inspection is repeated, and two files of one asset make one report."""

from unittest.mock import patch

from export_samples import PROVENANCE, box, boxes_asset, cabinet

from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.export.bundle import export_bundle
from asset_factory.factory.runtime.stages import Stages
from asset_factory.factory.runtime.store import Store
from asset_factory.factory.verify.validate import inspect, validate
from asset_factory.sim_checks import Finding, Report, Severity
from asset_factory.sim_checks.judge import Examination, Judge


def test_what_was_inspected_is_not_measured_again(tmp_path):
    bundle = export_bundle(cabinet(), PROVENANCE, tmp_path / "bundle")
    stages = Stages(BuildConfig(simulators=("mujoco",)))
    with Judge() as judge, patch.object(judge, "examine", wraps=judge.examine) as examined:
        inspected = inspect(bundle, judge, (), stages)
        verdict = validate(bundle, judge, (), inspected, stages)
    assert [call.args[0].name for call in examined.call_args_list] == ["asset.urdf", "asset.xml"]
    assert verdict.report.measurements.keys() == {"asset.urdf", "asset.xml"}


def test_simulators_that_judged_different_files_of_one_asset_can_disagree(tmp_path):
    # A drawer 5 mm within the side of its own body.
    body = box([0.0, 0.0, 0.4], [0.6, 0.4, 0.8])
    drawer = box([0.395, 0.0, 0.4], [0.2, 0.4, 0.8])
    slide = Joint("slide", JointKind.PRISMATIC, 0, 1, [0, -1, 0], [0.395, 0.0, 0.4], 0.0, 0.3)
    bundle = export_bundle(boxes_asset([body, drawer], (slide,)), PROVENANCE, tmp_path / "bundle")
    stages = Stages(BuildConfig(simulators=("sapien", "mujoco")))
    with Judge() as judge:
        report = validate(bundle, judge, (), inspect(bundle, judge, (), stages), stages).report
    (found,) = [item for item in report.disagreements if item.question == "opens"]
    assert found.verdicts == {"sapien": "pass", "mujoco": "jammed"}
    assert "overlap by 5.00 mm" in found.reason
    assert "PhysX never collides" in found.reason


class Hurried:
    """A judge that runs out of time whenever it is asked for the first time."""

    def __init__(self):
        self.examined = self.checked = 0

    def examine(self, path):
        self.examined += 1
        late = Finding("check_timeout", Severity.ERROR, "no answer in 120 s")
        return Examination((late,) if self.examined == 1 else ())

    def check(self, path, simulators, examined):
        self.checked += 1
        late = Finding("simulator_timeout", Severity.ERROR, "no answer in 120 s", "sapien")
        first = simulators and self.checked == 1
        return Report(path.name, simulators, (*examined.findings, *((late,) if first else ())))


def test_what_ran_out_of_time_is_asked_again_and_what_was_said_is_not(tmp_path):
    bundle = export_bundle(cabinet(), PROVENANCE, tmp_path / "bundle")
    stages = Stages(BuildConfig(simulators=("sapien",)), Store(tmp_path / "cache"))
    hurried = Hurried()
    inspected = [inspect(bundle, hurried, (), stages) for _ in range(3)]
    assert [verdict.report.status for verdict in inspected] == ["unjudged", "passed", "passed"]
    assert hurried.examined == 2
    hurried.checked = 0
    asked = (bundle, hurried, (), inspected[-1], stages)
    assert [validate(*asked).report.status for _ in range(3)] == ["unjudged", "passed", "passed"]
    assert hurried.checked == 2
