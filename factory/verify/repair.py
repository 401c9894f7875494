"""Verdict -> what to try next, or nothing. A pure function: same verdict, same plan."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from asset_factory.sim_checks import Finding

from ..config import RepairConfig
from ..manufacture.plan import Pair, Plan, Spare
from .validate import Verdict


def next_plan(verdict: Verdict, plan: Plan, config: RepairConfig, spare: Spare) -> Plan | None:
    """What to change so that the asset becomes better, if anything can.

    In this order: hulls that touch or nearly so are cut apart (also where the judge tolerates it:
    engines do not); what still overlaps at a hinge's knuckle is excluded from contact; a guessed
    part that lies in another is no part of its own; a joint that runs into something ends before; a
    part whose joint is blocked and dispensable, such as a button modelled over a closed panel,
    stays where it is.

    Args:
        verdict: of the round just judged.
        plan: which that round was made by.
        config: how far repairs may go.
        spare: what the object is still worth having without.

    Returns:
        The plan for another round, or ``None`` when nothing is left that could help.
    """
    near = frozenset(_near(verdict, config.near_mm)) - plan.separate
    if near:
        step = f"cut the hulls apart of {_listed(near)}"
        return replace(plan, separate=plan.separate | near, steps=(*plan.steps, step))
    hinges = frozenset(
        _pair(f) for f in verdict.report.findings if f.code == "hinge_overlap" and len(f.parts) == 2
    )
    if hinges - plan.exclude:
        step = (
            "excluded from contact in MuJoCo, as other engines do: "
            f"{_listed(hinges - plan.exclude)}"
        )
        return replace(plan, exclude=plan.exclude | hinges, steps=(*plan.steps, step))
    codes = {finding.code for finding in verdict.report.hard}
    if "rest_penetration" in codes and codes <= {"rest_penetration", "sweep_penetration"}:
        return _without_wrong_guesses(verdict, plan, spare.guesses)
    return (
        _with_joints_that_move(verdict, plan, config, spare.joints)
        if codes == {"sweep_penetration"}
        else None
    )


def _near(verdict: Verdict, near_mm: float) -> Iterator[Pair]:
    for judged in verdict.report.measurements.values():
        penetration: Mapping[str, Any] = judged.get("penetration", {})
        contacts = list(penetration.get("rest", ())) + list(penetration.get("zero") or ())
        for joint in penetration.get("joints", ()):
            contacts += joint["pairs"]
        for contact in contacts:
            if contact["depth_mm"] > -near_mm:
                yield _ordered(*contact["links"])


def _without_wrong_guesses(verdict: Verdict, plan: Plan, guesses: Mapping[str, str]) -> Plan | None:
    """The less sure of two overlapping parts given up; ``None`` if some two have no guess."""
    order = list(guesses)
    given_up, steps = set(plan.given_up), list(plan.steps)
    for finding in verdict.report.hard:
        if finding.code != "rest_penetration":
            continue
        doubtful = sorted((part for part in finding.parts if part in guesses), key=order.index)
        if not doubtful:
            return None
        if guesses[doubtful[0]] not in given_up:
            given_up.add(guesses[doubtful[0]])
            others = [part for part in finding.parts if part != doubtful[0]]
            steps.append(
                f"gave up {guesses[doubtful[0]]}: "
                f"{doubtful[0]} lies in {' and '.join(others) or 'another'}"
            )
    if given_up == plan.given_up:
        return None
    gone = {part for part, joint in guesses.items() if joint in given_up}
    separate, exclude = (
        frozenset(p for p in pairs if gone.isdisjoint(p)) for pairs in (plan.separate, plan.exclude)
    )
    return replace(
        plan, separate=separate, exclude=exclude, given_up=frozenset(given_up), steps=tuple(steps)
    )


def _with_joints_that_move(
    verdict: Verdict, plan: Plan, config: RepairConfig, spare: frozenset[str]
) -> Plan | None:
    """Every blocked joint shortened or frozen; ``None`` if one can be neither."""
    upper, frozen, steps = dict(plan.upper), set(plan.frozen), list(plan.steps)
    for joint in _blocked(verdict):
        name, clear, unit = joint["joint"], joint["clear_until"], joint["unit"]
        share = (clear - joint["lower"]) / (joint["upper"] - joint["lower"])
        if name not in plan.upper and share >= config.least_range_share:
            upper[name] = clear
            steps.append(
                f"ended {name} at {clear:.4g} instead of {joint['upper']:.4g} {unit}: "
                "it runs into something there"
            )
        elif name in spare:
            frozen.add(name)
            steps.append(f"froze {name}: it runs into something after {share:.0%} of its range")
        else:
            return None
    changed = replace(plan, upper=upper, frozen=frozenset(frozen), steps=tuple(steps))
    return changed if changed != plan else None


def _blocked(verdict: Verdict) -> Iterator[Mapping[str, Any]]:
    for judged in verdict.report.measurements.values():
        for joint in judged.get("penetration", {}).get("joints", ()):
            if joint["clear_until"] is not None:
                yield joint


def _pair(finding: Finding) -> Pair:
    return _ordered(*finding.parts)


def _ordered(one: str, other: str) -> Pair:
    return (min(one, other), max(one, other))


def _listed(pairs: frozenset[Pair]) -> str:
    return ", ".join(f"{a} and {b}" for a, b in sorted(pairs))
