"""Questions that simulators answer differently: each answer, its number, the likely reason."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ..report import PASS, Disagreement, Finding
from .disagreement_reasons import EngineEvidence, likely_reason
from .result import DECIMALS

NOT_FINITE = "not_finite"
#: Codes of a joint that an engine did not bring to upper.
NOT_OPENED = frozenset({"jammed", NOT_FINITE})
#: Findings that mean that an engine holds another asset than the file's, or none.
LOADING_CODES = frozenset(
    {
        "load_failed",
        "simulator_crashed",
        "simulator_timeout",
        "link_missing",
        "shape_dropped",
        "mass_mismatch",
        "inertia_mismatch",
        "center_mismatch",
        "joint_missing",
        "joint_kind",
        "limit_mismatch",
        "axis_mismatch",
        "mimic_mismatch",
    }
)


@dataclass(frozen=True)
class _Question:
    """One question about a joint.

    Attributes:
        name: as in the report.
        code: of the finding that answers it with no.
        among: the list of ``motion`` measurements that answers it.
        number: from a measurement to the number behind the verdict, as a share of the range.
        needs_open: whether only an engine that opened the joint was asked.
    """

    name: str
    code: str
    among: str
    number: Callable[[Mapping[str, Any]], float]
    needs_open: bool = False


def _beyond(motion: Mapping[str, Any]) -> float:
    return float(motion["overshoot"] / motion["range"]) if motion["range"] > 0.0 else 0.0


QUESTIONS = (
    _Question("opens", "jammed", "joints", lambda motion: motion["reached"]),
    _Question("returns", "not_returned", "joints", lambda motion: motion["returned"], True),
    _Question("rests", "pushed_at_rest", "rest", lambda rest: rest["share"]),
    _Question("leaves_others", "others_moved", "joints", lambda motion: motion["others_moved"]),
    _Question("keeps_limits", "limit_overshoot", "joints", _beyond),
)


def disagreements(
    findings: Sequence[Finding], measurements: Mapping[str, Any], simulators: Sequence[str]
) -> tuple[Disagreement, ...]:
    """Return every question that at least two simulators answered, and not alike.

    Findings and measurements are given as in a report. First comes ``loads``, then ``link_poses``,
    then joint by joint ``opens``, ``returns``, ``rests``, ``leaves_others``, ``keeps_limits``.
    """
    evidence = EngineEvidence(findings, measurements, simulators)
    disputes = (case for case in _cases(evidence) if len(set(case.verdicts.values())) > 1)
    return tuple(replace(case, reason=likely_reason(case, evidence)) for case in disputes)


def _cases(evidence: EngineEvidence) -> Iterator[Disagreement]:
    yield _loads(evidence)
    yield _link_poses(evidence)
    for joint in _joints(evidence):
        for question in QUESTIONS:
            yield _asked(question, joint, evidence)


def _loads(evidence: EngineEvidence) -> Disagreement:
    answers = {name: evidence.answer(name, LOADING_CODES) for name in evidence.simulators}
    verdicts = {n: a for n, a in answers.items() if a != PASS or evidence.said(n, "loading")}
    return Disagreement("loads", None, verdicts, dict.fromkeys(verdicts), None, "")


def _link_poses(evidence: EngineEvidence) -> Disagreement:
    said = {name: evidence.said(name, "loading") for name in evidence.simulators}
    worst = {name: numbers.get("worst_position_m") for name, numbers in said.items()}
    values = {name: round(value, DECIMALS) for name, value in worst.items() if value is not None}
    verdicts = {name: evidence.answer(name, frozenset({"pose_mismatch"})) for name in values}
    return Disagreement("link_poses", None, verdicts, values, "m", "")


def _joints(evidence: EngineEvidence) -> Iterator[str]:
    """Yield every joint that an engine moved or left alone, once, in the order of their lists."""
    motions = (evidence.said(name, "motion") for name in evidence.simulators)
    lists = (motion.get(among, ()) for motion in motions for among in ("joints", "rest"))
    yield from dict.fromkeys(entry["joint"] for entries in lists for entry in entries)


def _asked(question: _Question, joint: str, evidence: EngineEvidence) -> Disagreement:
    verdicts: dict[str, str] = {}
    values: dict[str, float | None] = {}
    for name in evidence.simulators:
        entries = evidence.said(name, "motion").get(question.among, ())
        entry = next((entry for entry in entries if entry["joint"] == joint), None)
        stayed = question.needs_open and evidence.answer(name, NOT_OPENED, joint) != PASS
        if entry is None or stayed:
            continue
        verdicts[name] = NOT_FINITE
        values[name] = None
        if entry["finite"]:
            verdicts[name] = evidence.answer(name, frozenset({question.code}), joint)
            values[name] = round(question.number(entry), DECIMALS)
    return Disagreement(question.name, joint, verdicts, values, "of range", "")
