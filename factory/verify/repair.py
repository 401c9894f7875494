"""Verdict -> what to try next, or nothing. A pure function: same verdict, same plan."""

from __future__ import annotations

from collections.abc import Callable

from ..asset import Asset
from ..config import RepairConfig
from ..manufacture.plan import Plan, Spare
from .repairs.evidence import RepairEvidence
from .repairs.find_limits import find_limits
from .repairs.geometry import (
    build_fronts,
    exclude_knuckles,
    fit_closely,
    hollow_out,
    separate_hulls,
)
from .repairs.give_up import give_up_guesses
from .repairs.mend import mend_joints, pull_in, rehang_doors, square_axes
from .repairs.shorten import freeze_small, shorten_or_freeze
from .validate import Verdict

Repairer = Callable[[RepairEvidence, Plan], Plan | None]

#: Every repair, in the order in which they are tried; a round does the first that has something to
#: change.
REPAIRS: tuple[Repairer, ...] = (
    square_axes,
    separate_hulls,
    exclude_knuckles,
    fit_closely,
    rehang_doors,
    find_limits,
    mend_joints,
    pull_in,
    build_fronts,
    hollow_out,
    give_up_guesses,
    shorten_or_freeze,
    freeze_small,
)
#: Those that change collision geometry only; all others change joints or parts.
GEOMETRY = (separate_hulls, exclude_knuckles, fit_closely, build_fronts, hollow_out)


def next_plan(
    verdict: Verdict, plan: Plan, config: RepairConfig, spare: Spare, asset: Asset
) -> Plan | None:
    """Return what to change so that the asset becomes better; ``None`` where nothing could help.

    Verdict and asset are of the round just validated, which the plan made.
    """
    evidence = RepairEvidence(verdict, config, spare, asset)
    for repair in REPAIRS:
        allowed = config.kinds == "all" or (config.kinds == "geometry" and repair in GEOMETRY)
        if allowed and (changed := repair(evidence, plan)) is not None:
            return changed
    return None
