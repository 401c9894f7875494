"""Verdict -> what to try next, or nothing. A pure function: same verdict, same plan."""

from __future__ import annotations

from collections.abc import Callable

from ..config import RepairConfig
from ..manufacture.plan import Plan, Spare
from .repairs.build_fronts import build_fronts
from .repairs.evidence import RepairEvidence
from .repairs.exclude import exclude_knuckles
from .repairs.give_up import give_up_guesses
from .repairs.separate import separate_hulls
from .repairs.shorten import shorten_or_freeze
from .validate import Verdict

Repair = Callable[[RepairEvidence, Plan], Plan | None]

#: Every repair, in the order in which they are tried; a round does the first that has something to
#: change.
REPAIRS: tuple[Repair, ...] = (
    separate_hulls,
    exclude_knuckles,
    build_fronts,
    give_up_guesses,
    shorten_or_freeze,
)


def next_plan(verdict: Verdict, plan: Plan, config: RepairConfig, spare: Spare) -> Plan | None:
    """What to change so that the asset becomes better, if anything can.

    Args:
        verdict: of the round just judged.
        plan: which that round was made by.
        config: how far repairs may go.
        spare: what the object is still worth having without.

    Returns:
        The plan for another round, or ``None`` when nothing is left that could help.
    """
    evidence = RepairEvidence(verdict, config, spare)
    for repair in REPAIRS:
        changed = repair(evidence, plan)
        if changed is not None:
            return changed
    return None
