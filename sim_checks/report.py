"""What a validation says: findings, each a code, a number and a sentence."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from enum import StrEnum
from typing import Any

from .reasons import UNJUDGED


class Severity(StrEnum):
    """Whether a finding decides the verdict; the gravest first."""

    ERROR = "error"
    """The asset must not be used: it is rejected."""
    WARNING = "warning"
    """Worth mending; the asset may pass with it."""
    NOTE = "note"
    """Told of how it was validated; the file needs no change."""

    @classmethod
    def _missing_(cls, value: object) -> Severity | None:
        """Return the severity that a report of version 1 means."""
        return {"hard": cls.ERROR, "soft": cls.WARNING}.get(str(value))


#: Version of a report's JSON form, which ``docs/report.schema.json`` describes.
VERSION = 2


class Status(StrEnum):
    """What became of a file or an input."""

    PASSED = "passed"
    REJECTED = "rejected"
    UNJUDGED = "unjudged"
    """The validation, not the asset, failed to finish."""


#: Codes of findings that mean "no verdict".
UNJUDGED_CODES = frozenset(UNJUDGED)


#: Causes of a finding of no verdict that say nothing of the asset: somebody made an end of the
#: process, or it had no answer by the time limit of what hangs.
KILLED = "killed"
OUT_OF_TIME = "out_of_time"


@dataclass(frozen=True)
class Finding:
    """One thing found.

    Attributes:
        code: stable reason code, e.g. ``rest_penetration``.
        severity: ``error`` rejects, ``warning`` and ``note`` do not.
        message: one sentence with the number in it: what, where, what would be right.
        simulator: who found it, for findings that belong to one simulator.
        joint: name of the joint concerned.
        parts: names of the links concerned.
        joints: names of the joints concerned, of a finding about several.
        value, unit, limit: the measured number, its unit and the threshold it was held against.
        cause: the likely reason where one can be told from another, e.g. ``hull_inflation``.
    """

    code: str
    severity: Severity
    message: str
    simulator: str | None = None
    joint: str | None = None
    parts: tuple[str, ...] = ()
    value: float | None = None
    unit: str | None = None
    limit: float | None = None
    cause: str | None = None
    joints: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "severity", Severity(self.severity))
        object.__setattr__(self, "parts", tuple(self.parts))
        object.__setattr__(self, "joints", tuple(self.joints))

    @property
    def named_joints(self) -> tuple[str, ...]:
        """Return the names of the joints concerned, of one or of several."""
        return self.joints or ((self.joint,) if self.joint else ())

    @property
    def stopped(self) -> bool:
        """Return whether another try may say something else: a clock or somebody ended this one."""
        return self.cause in (KILLED, OUT_OF_TIME)


#: The verdict of an engine that found nothing wrong.
PASS = "pass"  # noqa: S105 - a verdict
#: What each question asks.
ASKED = {
    "loads": "whether the file loads",
    "link_poses": "where links are",
    "opens": "whether {joint} opens",
    "returns": "whether {joint} closes again",
    "rests": "whether {joint} stays where it is",
    "leaves_others": "whether {joint} leaves other joints alone",
    "keeps_limits": "whether {joint} keeps its limits",
}


@dataclass(frozen=True)
class Disagreement:
    """Simulators that say different things of the same question.

    Attributes:
        question: a stable word, e.g. ``opens``, ``returns``, ``loads``, ``rests``.
        joint: the joint concerned; ``None`` if it is about the whole file.
        verdicts: simulator -> ``pass`` or the code of its finding.
        values: simulator -> the number behind it; ``None`` where it has none.
        unit: of the values.
        reason: the likely reason, a sentence.
    """

    question: str
    joint: str | None
    verdicts: Mapping[str, str]
    values: Mapping[str, float | None]
    unit: str | None
    reason: str

    @property
    def passing(self) -> frozenset[str]:
        """Return the engines that found nothing wrong."""
        return frozenset(name for name, verdict in self.verdicts.items() if verdict == PASS)

    @property
    def failing(self) -> frozenset[str]:
        """Return the others."""
        return frozenset(self.verdicts) - self.passing

    @property
    def asked(self) -> str:
        """Return the question in words."""
        return ASKED.get(self.question, self.question).format(joint=repr(self.joint))


@dataclass(frozen=True)
class Report:
    """The verdict on one description file.

    Attributes:
        description: the validated file, as given or relative to its bundle.
        simulators: who took part, in order.
        findings: in a fixed order, the same for the same input.
        measurements: every number taken, whether or not it became a finding; JSON data only.
        disagreements: where the simulators' verdicts differ.
    """

    description: str
    simulators: tuple[str, ...] = ()
    findings: tuple[Finding, ...] = ()
    measurements: Mapping[str, Any] = field(default_factory=dict)
    disagreements: tuple[Disagreement, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "simulators", tuple(self.simulators))
        object.__setattr__(self, "findings", tuple(self.findings))
        object.__setattr__(self, "disagreements", tuple(self.disagreements))

    @property
    def passed(self) -> bool:
        """Tell whether there is no error and validation finished."""
        return not self.errors

    @property
    def errors(self) -> tuple[Finding, ...]:
        """Return the findings that reject."""
        return tuple(f for f in self.findings if f.severity is Severity.ERROR)

    @property
    def status(self) -> Status:
        """Return ``unjudged`` where a check crashed or timed out and nothing else rejects."""
        if self.passed:
            return Status.PASSED
        judged = any(f.code not in UNJUDGED_CODES for f in self.errors)
        return Status.REJECTED if judged else Status.UNJUDGED

    def to_dict(self) -> dict[str, Any]:
        """Return JSON data: ``version``, ``passed``, ``findings`` and the rest."""
        return {
            "version": VERSION,
            "passed": self.passed,
            "description": self.description,
            "simulators": list(self.simulators),
            "findings": [_as_data(finding) for finding in self.findings],
            "disagreements": [_as_data(each) for each in self.disagreements],
            "measurements": dict(self.measurements),
        }

    def to_json(self) -> str:
        """Return reproducible JSON text: fixed key order, no time, no machine."""
        return json.dumps(self.to_dict(), indent=2, allow_nan=False) + "\n"

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Report:
        """Return the inverse of :meth:`to_dict`."""
        findings = tuple(Finding(**f) for f in data["findings"])
        disagreements = tuple(Disagreement(**d) for d in data.get("disagreements", ()))
        told = (tuple(data["simulators"]), findings, data["measurements"], disagreements)
        return cls(data["description"], *told)


def _as_data(record: Finding | Disagreement) -> dict[str, Any]:
    """Return a record as JSON holds it: lists, and strings that are no enumeration's."""
    plain = {tuple: list, Severity: str}
    data = asdict(record)
    return {key: plain[type(v)](v) if type(v) in plain else v for key, v in data.items()}
