"""The only way to the validator: Bundle -> Verdict."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING

from asset_factory.sim_checks import Finding, Report
from asset_factory.sim_checks.checks.disagreement import disagreements
from asset_factory.sim_checks.description import Description, DescriptionError
from asset_factory.sim_checks.judge import Examination, Judge
from asset_factory.sim_checks.report import UNJUDGED_CODES
from asset_factory.sim_checks.simulators.catalog import installed_version

from ..runtime.keys import Stage
from ..runtime.stages import Stages
from ..runtime.store import folder_digests

if TYPE_CHECKING:
    # A bundle's folder and files are all that is asked of it: how it is written changes no verdict.
    from ..export.bundle import Bundle

JUDGE = "asset_factory.sim_checks"
COLLISION_LIBRARIES = ("numpy", "scipy", "trimesh", "python-fcl")
INSPECT = Stage(
    "inspect", code=(JUDGE, __name__), settings=("checks",), libraries=COLLISION_LIBRARIES
)
VALIDATE = Stage(
    "validate",
    code=(JUDGE, __name__),
    settings=("simulators", "checks"),
    also=lambda config: [[name, installed_version(name)] for name in config.simulators],
)
#: MuJoCo reads URDF only in part (it fuses the root and drops visuals), so it is given the MJCF.
MJCF_SIMULATORS = frozenset({"mujoco"})


@dataclass(frozen=True)
class Verdict:
    """What became of a bundle.

    Attributes:
        report: all findings, the validator's and the factory's own.
        examined: of the bundle's URDF, without simulators.
        key: of the validated bundle, where it was remembered.
    """

    report: Report
    examined: Examination = field(default_factory=Examination)
    key: str = ""

    @property
    def reason(self) -> Finding | None:
        """Return the first finding that rejects; ``None`` if it passed."""
        return self.report.errors[0] if self.report.errors else None


def inspect(
    bundle: Bundle, judge: Judge, own_findings: tuple[Finding, ...], stages: Stages
) -> Verdict:
    """Validate a bundle's URDF without simulators, as repairs need. Arguments: :func:`validate`."""
    key = INSPECT.key(stages.config, folder_digests(bundle.folder))
    done: list[Examination] = []

    def examine() -> Examination:
        done.append(judge.examine(bundle.urdf))
        # The bundle holds the description.
        return replace(done[0], description=None)

    kept = stages.recall("inspect", Examination, key, examine, _is_final)
    examined = done[0] if done else kept
    return Verdict(_reported(bundle, (), judge, own_findings, examined), examined, key)


def validate(
    bundle: Bundle,
    judge: Judge,
    own_findings: tuple[Finding, ...],
    inspected: Verdict,
    stages: Stages,
) -> Verdict:
    """Validate a bundle's URDF, and its MJCF in the simulators that read that.

    Args:
        bundle: as exported.
        judge: the validator, with the thresholds.
        own_findings: what the factory itself found wrong, listed first.
        inspected: of this same bundle, by :func:`inspect`: what needs no simulator is not measured
            again.
        stages: where verdicts are remembered; each simulator of its settings loads the file that
            is meant for it.
    """
    examined = inspected.examined
    make = partial(_reported, bundle, stages.config.simulators, judge, own_findings, examined)
    key = VALIDATE.key(stages.config, inspected.key, [asdict(finding) for finding in own_findings])
    report = stages.recall("validate", Report, key, make, _is_final)
    return Verdict(report, examined, key)


def _reported(
    bundle: Bundle,
    simulators: tuple[str, ...],
    judge: Judge,
    own_findings: tuple[Finding, ...],
    examined: Examination,
) -> Report:
    urdf_simulators = tuple(name for name in simulators if name not in MJCF_SIMULATORS)
    mjcf_simulators = tuple(name for name in simulators if name in MJCF_SIMULATORS)
    if urdf_simulators and examined.description is None:
        examined = replace(examined, description=_read_again(bundle))
    report = judge.check(bundle.urdf, urdf_simulators, examined)
    measurements = {"asset.urdf": dict(report.measurements)}
    findings = [*own_findings, *report.findings]
    differences = report.disagreements
    took_part = set(report.simulators)
    if mjcf_simulators:
        second = judge.check(bundle.mjcf, mjcf_simulators)
        measurements["asset.xml"] = dict(second.measurements)
        findings += [finding for finding in second.findings if finding not in findings]
        took_part |= set(second.simulators)
        # Each file has its own report, but the engines ran one asset. The MJCF knows which pairs
        # are excluded.
        differences = disagreements(
            findings, {**report.measurements, **second.measurements}, simulators
        )
    witnesses = tuple(name for name in simulators if name in took_part)
    return Report(bundle.urdf.name, witnesses, tuple(findings), measurements, differences)


def _read_again(bundle: Bundle) -> Description | None:
    """Read the URDF where its examination came from the cache; ``None`` if it cannot be read."""
    from asset_factory.sim_checks.read.read import read_here

    try:
        return read_here(bundle.urdf)
    except DescriptionError:
        return None


def _is_final(said: Examination | Report) -> bool:
    """Return whether the validator came to the end; else another try may say more."""
    return UNJUDGED_CODES.isdisjoint(finding.code for finding in said.findings)
