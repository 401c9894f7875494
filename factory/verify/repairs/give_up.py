"""A guessed part that lies in another one is no part of its own: the less sure of the two goes."""

from __future__ import annotations

from dataclasses import replace

from ...manufacture.plan import Plan
from .evidence import RepairEvidence


def give_up_guesses(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """The less sure of any two overlapping parts; nothing if some two have no guess among them."""
    if "rest_penetration" not in evidence.codes:
        return None
    if not evidence.codes <= {"rest_penetration", "sweep_penetration"}:
        return None
    guesses = evidence.spare.guesses
    order = list(guesses)
    given_up = set(plan.given_up)
    steps = list(plan.steps)

    for finding in evidence.hard:
        if finding.code != "rest_penetration":
            continue
        doubtful = sorted((part for part in finding.parts if part in guesses), key=order.index)
        if not doubtful:
            return None
        part = doubtful[0]
        if guesses[part] not in given_up:
            given_up.add(guesses[part])
            others = " and ".join(other for other in finding.parts if other != part)
            steps.append(f"gave up {guesses[part]}: {part} lies in {others or 'another'}")

    if given_up == plan.given_up:
        return None
    gone = {part for part, joint in guesses.items() if joint in given_up}
    return replace(
        plan,
        separate=frozenset(pair for pair in plan.separate if gone.isdisjoint(pair)),
        exclude=frozenset(pair for pair in plan.exclude if gone.isdisjoint(pair)),
        given_up=frozenset(given_up),
        steps=tuple(steps),
    )
