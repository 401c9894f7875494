"""The only door to the judge: Bundle -> Verdict."""

from __future__ import annotations

from dataclasses import dataclass

from asset_factory.sim_checks import Finding, Report
from asset_factory.sim_checks.checks.disagreement import disagreements
from asset_factory.sim_checks.judge import Examination, Judge

from .export.bundle import Bundle

#: MuJoCo reads URDF only in part (it fuses the root and drops visuals), so it is given the MJCF.
MJCF_SIMULATORS = frozenset({"mujoco"})


@dataclass(frozen=True)
class Verdict:
    """What became of a bundle.

    Attributes:
        report: all findings, the judge's and the factory's own.
        examined: of the bundle's URDF, what needed no simulator.
    """

    report: Report
    examined: Examination | None = None

    @property
    def status(self) -> str:
        """``passed``, ``rejected`` or ``unjudged``."""
        if self.report.passed:
            return "passed"
        return "rejected" if self.report.judged else "unjudged"

    @property
    def reason(self) -> Finding | None:
        """The first finding that rejects; ``None`` if it passed."""
        return self.report.hard[0] if self.report.hard else None


def inspect(bundle: Bundle, judge: Judge, own_findings: tuple[Finding, ...] = ()) -> Verdict:
    """Judge a bundle's URDF without any simulator: all that repairs go by. Arguments as for :func:`validate`."""
    return validate(bundle, (), judge, own_findings)


def validate(
    bundle: Bundle,
    simulators: tuple[str, ...],
    judge: Judge,
    own_findings: tuple[Finding, ...] = (),
    inspected: Verdict | None = None,
) -> Verdict:
    """Judge a bundle's URDF, and its MJCF in the simulators that read that.

    Args:
        bundle: as exported.
        simulators: names; each judges the file that is meant for it.
        judge: with the thresholds.
        own_findings: what the factory itself found wrong, listed first.
        inspected: of this same bundle, by :func:`inspect`: what needs no simulator is then not measured again.
    """
    urdf_simulators = tuple(name for name in simulators if name not in MJCF_SIMULATORS)
    mjcf_simulators = tuple(name for name in simulators if name in MJCF_SIMULATORS)
    examined = inspected.examined if inspected is not None else None
    examined = examined or judge.examine(bundle.urdf)
    report = judge.check(bundle.urdf, urdf_simulators, examined)
    measurements = {"asset.urdf": dict(report.measurements)}
    findings = [*own_findings, *report.findings]
    differences, took_part = report.disagreements, set(report.simulators)
    if mjcf_simulators:
        second = judge.check(bundle.mjcf, mjcf_simulators)
        measurements["asset.xml"] = dict(second.measurements)
        findings += [finding for finding in second.findings if finding not in findings]
        took_part |= set(second.simulators)
        # Each file has its own report, but the engines judged one asset. The MJCF knows which pairs are excluded.
        differences = disagreements(findings, {**report.measurements, **second.measurements}, simulators)
    witnesses = tuple(name for name in simulators if name in took_part)
    return Verdict(Report(bundle.urdf.name, witnesses, tuple(findings), measurements, differences), examined)
