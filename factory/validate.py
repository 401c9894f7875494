"""The only door to the judge: Bundle -> Verdict."""

from __future__ import annotations

from dataclasses import dataclass

from asset_factory.sim_checks import Finding, Report
from asset_factory.sim_checks.config import CheckConfig
from asset_factory.sim_checks.run import run_checks

from .export.bundle import Bundle

#: MuJoCo reads URDF only in part (it fuses the root and drops visuals), so it is given the MJCF.
MJCF_SIMULATORS = frozenset({"mujoco"})


@dataclass(frozen=True)
class Verdict:
    """What became of a bundle.

    Attributes:
        report: all findings, the judge's and the factory's own.
    """

    report: Report

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


def inspect(bundle: Bundle, config: CheckConfig, own_findings: tuple[Finding, ...] = ()) -> Verdict:
    """Judge a bundle's URDF without any simulator: all that repairs go by. Arguments as for :func:`validate`."""
    return validate(bundle, (), config, own_findings)


def validate(
    bundle: Bundle, simulators: tuple[str, ...], config: CheckConfig, own_findings: tuple[Finding, ...] = ()
) -> Verdict:
    """Judge a bundle's URDF, and its MJCF in the simulators that read that.

    Args:
        bundle: as exported.
        simulators: names; each judges the file that is meant for it.
        config: thresholds.
        own_findings: what the factory itself found wrong, listed first.
    """
    urdf_simulators = tuple(name for name in simulators if name not in MJCF_SIMULATORS)
    mjcf_simulators = tuple(name for name in simulators if name in MJCF_SIMULATORS)
    report = run_checks(bundle.urdf, urdf_simulators, config)
    measurements = {"asset.urdf": dict(report.measurements)}
    findings = [*own_findings, *report.findings]
    if mjcf_simulators:
        second = run_checks(bundle.mjcf, mjcf_simulators, config)
        measurements["asset.xml"] = dict(second.measurements)
        findings += [finding for finding in second.findings if finding not in findings]
    return Verdict(Report(bundle.urdf.name, simulators, tuple(findings), measurements))
