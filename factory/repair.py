"""Verdict -> what to try next, or nothing. A pure function: same verdict, same plan."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from asset_factory.sim_checks import Finding

from .config import RepairConfig
from .validate import Verdict

Pair = tuple[str, str]


@dataclass(frozen=True)
class Plan:
    """How the next round is made differently from the plain one.

    Attributes:
        separate: pairs of part names whose hulls are cut apart, where the meshes themselves allow it.
        exclude: pairs that MuJoCo is told not to collide: the knuckles of hinges, which other engines ignore.
        upper: joint name -> shortened upper limit [rad] or [m].
        error_m: part name -> finer concavity for its decomposition [m].
        steps: what was decided, one sentence each, oldest first.
    """

    separate: frozenset[Pair] = frozenset()
    exclude: frozenset[Pair] = frozenset()
    upper: Mapping[str, float] = field(default_factory=dict)
    error_m: Mapping[str, float] = field(default_factory=dict)
    steps: tuple[str, ...] = ()


def next_plan(verdict: Verdict, plan: Plan, config: RepairConfig) -> Plan | None:
    """What to change so that the asset becomes better, if anything can.

    In this order: hulls that touch or nearly so are cut apart (also where the judge tolerates it: engines do not);
    what still overlaps at a hinge's knuckle is excluded from contact; a joint that runs into something ends before.

    Args:
        verdict: of the round just judged.
        plan: which that round was made by.
        config: how far repairs may go.

    Returns:
        The plan for another round, or ``None`` when nothing is left that could help.
    """
    near = frozenset(_near(verdict, config.near_mm)) - plan.separate
    if near:
        step = f"cut the hulls apart of {_listed(near)}"
        return replace(plan, separate=plan.separate | near, steps=(*plan.steps, step))
    hinges = frozenset(_pair(f) for f in verdict.report.findings if f.code == "hinge_overlap" and len(f.parts) == 2)
    if hinges - plan.exclude:
        step = f"excluded from contact in MuJoCo, as other engines do: {_listed(hinges - plan.exclude)}"
        return replace(plan, exclude=plan.exclude | hinges, steps=(*plan.steps, step))
    codes = {finding.code for finding in verdict.report.hard}
    return _shortened(verdict, plan, config) if codes == {"sweep_penetration"} else None


def _near(verdict: Verdict, near_mm: float) -> Iterator[Pair]:
    for judged in verdict.report.measurements.values():
        penetration: Mapping[str, Any] = judged.get("penetration", {})
        contacts = list(penetration.get("rest", ())) + list(penetration.get("zero") or ())
        for joint in penetration.get("joints", ()):
            contacts += joint["pairs"]
        for contact in contacts:
            if contact["depth_mm"] > -near_mm:
                yield _ordered(*contact["links"])


def _shortened(verdict: Verdict, plan: Plan, config: RepairConfig) -> Plan | None:
    upper, steps = dict(plan.upper), list(plan.steps)
    for judged in verdict.report.measurements.values():
        for joint in judged.get("penetration", {}).get("joints", ()):
            clear = joint.get("clear_until")
            if clear is None or joint["upper"] <= clear:
                continue
            size = joint["upper"] - joint["lower"]
            kept = clear - joint["lower"]
            name = joint["joint"]
            if name in plan.upper or kept < config.least_range_share * size:
                return None
            upper[name] = clear
            was = f"{joint['upper']:.4g} {joint['unit']}"
            steps.append(f"ended {name} at {clear:.4g} instead of {was}: it runs into something there")
    return replace(plan, upper=upper, steps=tuple(steps)) if upper != dict(plan.upper) else None


def _pair(finding: Finding) -> Pair:
    return _ordered(*finding.parts)


def _ordered(one: str, other: str) -> Pair:
    return (min(one, other), max(one, other))


def _listed(pairs: frozenset[Pair]) -> str:
    return ", ".join(f"{a} and {b}" for a, b in sorted(pairs))
