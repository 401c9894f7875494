"""Everything that the penetration check measured, as a report holds it."""

from __future__ import annotations

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


def unit_of(kind: str) -> str:
    """Return the unit of a joint's values."""
    return "m" if kind == "prismatic" else "rad"


def mm(metres: float) -> float:
    """Round to a tenth of a micrometre [mm], so that a last bit does not change a report."""
    return round(metres * 1000.0, 4) + 0.0


def _contact(contact: Contact) -> dict[str, Any]:
    """Return the fields of a :class:`MeasuredContact`."""
    return {
        "links": contact.links,
        "shapes": contact.shapes,
        "depth_mm": mm(contact.depth),
        "point_m": None
        if contact.point is None
        else tuple(round(x, 6) + 0.0 for x in contact.point),
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
        joint=sweep.joint,
        lower=round(sweep.lower, 6),
        upper=round(sweep.upper, 6),
        unit=unit_of(sweep.kind),
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
    zero = study.zero
    return MeasuredPenetration(
        diagonal_m=round(study.diagonal, 6),
        hulls=study.hulls,
        parts=study.parts,
        rest=tuple(MeasuredContact(**_contact(contact)) for contact in study.rest),
        zero=None
        if zero is None
        else tuple(MeasuredContact(**_contact(contact)) for contact in zero),
        joints=tuple(_measured_joint(sweep) for sweep in study.sweeps),
        neighbours=tuple(
            MeasuredNeighbour(
                **_pair(item.pair),
                joint=item.joint.name,
                open=item.other.name,
                unit=unit_of(item.joint.kind),
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
