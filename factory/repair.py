"""Verdict -> what to try next, or nothing. A pure function: same verdict, same plan."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from asset_factory.sim_checks import Finding

from .config import RepairConfig
from .validate import Verdict


@dataclass(frozen=True)
class Plan:
    """How the next round is made differently from the plain one.

    Attributes:
        trim: pairs of part names whose hulls are cut apart where the meshes themselves are apart.
        error_m: part name -> finer concavity for its decomposition [m].
        upper: joint name -> shortened upper limit [rad] or [m].
        steps: what was decided, one sentence each, oldest first.
    """

    trim: frozenset[tuple[str, str]] = frozenset()
    error_m: Mapping[str, float] = field(default_factory=dict)
    upper: Mapping[str, float] = field(default_factory=dict)
    steps: tuple[str, ...] = ()


def next_plan(verdict: Verdict, plan: Plan, config: RepairConfig, error_m: float) -> Plan | None:
    """What to change so that the findings which reject might go away.

    Penetrating hulls are first cut apart (the cut refuses where the meshes really overlap), then decomposed
    more finely, and last the joint's range ends before the collision, if enough of it is left.

    Args:
        verdict: of the round just judged.
        plan: which that round was made by.
        config: how far repairs may go.
        error_m: concavity of the plain decomposition [m].

    Returns:
        The plan for another round, or ``None`` when nothing is left that could help.
    """
    if verdict.status != "rejected":
        return None
    following = plan
    for finding in verdict.report.hard:
        repaired = _repair(finding, following, plan, config, error_m)
        if repaired is None:
            return None
        following = repaired
    return following if following != plan else None


def _repair(finding: Finding, following: Plan, made_by: Plan, config: RepairConfig, error_m: float) -> Plan | None:
    if finding.code not in ("rest_penetration", "sweep_penetration") or len(finding.parts) != 2:
        return None
    pair = (min(finding.parts), max(finding.parts))
    if pair not in made_by.trim:
        step = f"hulls of {pair[0]!r} and {pair[1]!r} cut apart after: {finding.message}"
        return _once(following, replace(following, trim=following.trim | {pair}), step)
    if finding.code == "sweep_penetration" and finding.joint and finding.joint not in made_by.upper:
        return _shorten(finding, following, config)
    finest = error_m * config.finest_share
    wanted = {part: max(finest, made_by.error_m.get(part, error_m) / 2.0) for part in pair}
    if all(made_by.error_m.get(part, error_m) <= finest for part in pair):
        return None
    step = f"{pair[0]!r} and {pair[1]!r} decomposed more finely after: {finding.message}"
    return _once(following, replace(following, error_m={**following.error_m, **wanted}), step)


def _shorten(finding: Finding, following: Plan, config: RepairConfig) -> Plan | None:
    return None


def _once(before: Plan, after: Plan, step: str) -> Plan:
    changed = replace(after, steps=before.steps) != before
    return replace(after, steps=(*before.steps, step)) if changed else before
