"""Everything that the penetration check measured, as a report holds it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..measurements import (
    MeasuredCombination,
    MeasuredContact,
    MeasuredJoint,
    MeasuredNeighbour,
    MeasuredPair,
    MeasuredPenetration,
)
from .penetration_study import Contact, JointSweep, PairSweep, PenetrationStudy


def mm(metres: float) -> float:
    """Round to a tenth of a micrometre [mm], so that a last bit does not change a report."""
    return round(metres * 1000.0, 4) + 0.0


def _contact(contact: Contact) -> dict[str, Any]:
    """Return the fields of a :class:`MeasuredContact`."""
    point = contact.point
    return {
        "links": contact.links,
        "shapes": contact.shapes,
        "depth_mm": mm(contact.depth),
        "point_m": None if point is None else tuple(round(x, 6) + 0.0 for x in point),
        "kind": str(contact.kind),
        "visual_mm": None if contact.visual is None else mm(contact.visual),
        "cause": None if contact.cause is None else str(contact.cause),
    }


def _pair(pair: PairSweep) -> dict[str, Any]:
    """Return the fields of a :class:`MeasuredPair`."""
    return {
        **_contact(pair.contact),
        "excess_mm": mm(pair.excess),
        "bound_mm": mm(pair.bound),
        "at": round(pair.at, 6),
    }


def _measured_joint(sweep: JointSweep) -> MeasuredJoint:
    gaps = [-pair.excess for pair in sweep.pairs if pair.contact.depth < 0.0]
    touching = any(pair.contact.depth >= 0.0 for pair in sweep.pairs)
    visual = min(
        (pair.contact.visual for pair in sweep.pairs if pair.contact.visual is not None),
        default=None,
    )
    alternative = sweep.alternative
    return MeasuredJoint(
        joint=sweep.joint.name,
        lower=round(sweep.lower, 6),
        upper=round(sweep.upper, 6),
        unit=sweep.joint.unit,
        excess_mm=mm(max(0.0, sweep.excess)),
        clearance_mm=0.0 if touching else mm(min(gaps)) if gaps else None,
        visual_clearance_mm=None if visual is None else mm(max(0.0, visual)),
        clear_until=None if sweep.clear_until is None else round(sweep.clear_until, 6),
        looks=sweep.looks,
        pairs=tuple(MeasuredPair(**_pair(pair)) for pair in sweep.pairs),
        needs_open=sweep.needs_open,
        waits_for=sweep.waits_for,
        with_those_open=None if alternative is None else _measured_joint(alternative),
    )


def measured(study: PenetrationStudy) -> MeasuredPenetration:
    """Return a study's figures as the report states them."""

    def contacts(found: Iterable[Contact]) -> tuple[MeasuredContact, ...]:
        return tuple(MeasuredContact(**_contact(each)) for each in found)

    return MeasuredPenetration(
        diagonal_m=round(study.diagonal, 6),
        hulls=study.hulls,
        parts=study.parts,
        rest=contacts(study.rest),
        zero=None if study.zero is None else contacts(study.zero),
        joints=tuple(_measured_joint(sweep) for sweep in study.sweeps),
        neighbours=tuple(
            MeasuredNeighbour(
                **_pair(item.pair),
                joint=item.joint.name,
                open=item.other.name,
                unit=item.joint.unit,
                open_at=round(item.other_at, 6),
            )
            for item in study.neighbours.met
        ),
        combinations=tuple(
            MeasuredCombination(
                **_contact(item.contact),
                excess_mm=mm(item.excess),
                values={name: round(value, 6) for name, value in item.values.items()},
            )
            for item in study.combinations
        ),
    )
