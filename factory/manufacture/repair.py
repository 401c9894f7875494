"""What one repair changed of an object, as a type; its sentence is written here alone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from ..runtime.packing import from_json

Pair = tuple[str, str]


_AFTER = "; it ran into something after {free_share:.0%}"


class RepairKind(StrEnum):
    """What a repair does; the values are stored in reports.

    Attributes:
        label: the kind in a few words, for a filter.
        sentence: a template over the fields of a repair.
    """

    label: str
    sentence: str

    def __new__(cls, value: str, label: str, sentence: str) -> RepairKind:
        """Return the kind of one stored value."""
        kind = str.__new__(cls, value)
        kind._value_ = value
        kind.label = label
        kind.sentence = sentence
        return kind

    HULLS_CUT_APART = "hulls_cut_apart", "hulls cut apart", "cut the hulls apart of {pairs}"
    CONTACT_EXCLUDED = (
        *("contact_excluded", "contact excluded"),
        "excluded from contact in MuJoCo, as other engines do: {pairs}",
    )
    HULLS_NOT_JOINED = (
        *("hulls_not_joined", "hulls not joined"),
        "left the hulls of {parts} as many as they were: joined ones failed",
    )
    GUESSED_HINGE_MOVED = (
        *("guessed_hinge_moved", "hinge moved"),
        "moved {joints} to the door's front edge: it ran into something",
    )
    AXIS_STRAIGHTENED = (
        *("axis_straightened", "axis straightened"),
        "mended {joints}: its axis was {before:.1f} degrees off a principal direction" + _AFTER,
    )
    AXIS_SQUARED = (
        *("axis_squared", "axis straightened"),
        "mended {joints}: its axis was {before:.1f} degrees off every edge of its box",
    )
    HINGE_TO_FRONT_EDGE = (
        *("hinge_to_front_edge", "hinge moved"),
        "mended {joints}: its hinge was {before:.1f} mm off its panel's front edge" + _AFTER,
    )
    HINGE_TO_BACK_EDGE = (
        *("hinge_to_back_edge", "hinge moved"),
        "mended {joints}: its hinge was {before:.1f} mm off its panel's back edge" + _AFTER,
    )
    HINGE_TO_LINE = (
        *("hinge_to_line", "hinge moved"),
        "mended {joints}: its hinge was {before:.1f} mm off that of its neighbour" + _AFTER,
    )
    OPENING_REVERSED = (
        *("opening_reversed", "opening reversed"),
        "mended {joints}: it opened inwards and is turned round" + _AFTER,
    )
    REVERSED_TOO = (
        *("reversed_too", "opening reversed"),
        "mended {joints}: it opened inwards and is turned round as its neighbour opens" + _AFTER,
    )
    CLOSED_END_PULLED_IN = (
        *("closed_end_pulled_in", "closed end pulled in"),
        "began {joints} at {after:.4g} instead of {before:.4g} {unit}: "
        "closed further it lies in something",
    )
    FRONTS_BUILT = "fronts_built", "fronts built", "built fronts and body anew: {parts}"
    FRONTS_BUILT_AT_ONCE = (
        *("fronts_built_at_once", "fronts built"),
        "built fronts and body anew, of {before:.0f} faces: {parts}",
    )
    LEFT_HOLLOW = (
        *("left_hollow", "left hollow"),
        "left what is open in {parts} open: its hulls filled it",
    )
    OVERLAPPING_GIVEN_UP = (
        *("overlapping_given_up", "joint given up"),
        "gave up {joints}: {part} lies in {others}",
    )
    JOINT_GIVEN_UP = "joint_given_up", "joint given up", "gave up {joints}: {why}"
    RANGE_SHORTENED = (
        *("range_shortened", "range shortened"),
        "ended {joints} at {after:.4g} instead of {before:.4g} {unit}: "
        "it runs into something there",
    )
    LIMITS_FOUND = (
        *("limits_found", "limits found"),
        "found limits of {joints}, which had none: free from {before:.4g} to {after:.4g} {unit}",
    )
    JOINT_FROZEN = "joint_frozen", "joint frozen", "froze {joints}: {why}"
    OTHER = "other", "other", "{why}"


#: Reports that hold sentences alone: a repair's kind by the first words of its sentence.
_OLDER: Mapping[str, RepairKind] = {
    "cut the": RepairKind.HULLS_CUT_APART,
    "excluded from": RepairKind.CONTACT_EXCLUDED,
    "left the": RepairKind.HULLS_NOT_JOINED,
    "left what": RepairKind.LEFT_HOLLOW,
    "built fronts": RepairKind.FRONTS_BUILT,
    "began ": RepairKind.CLOSED_END_PULLED_IN,
    "moved ": RepairKind.GUESSED_HINGE_MOVED,
    "gave up": RepairKind.JOINT_GIVEN_UP,
    "ended ": RepairKind.RANGE_SHORTENED,
    "froze ": RepairKind.JOINT_FROZEN,
}


@dataclass(frozen=True)
class Repair:
    """One change that a repair made.

    Attributes:
        kind: of the change.
        parts: names of the parts that it is about; of overlapping ones, the one given up first.
        pairs: names of two parts each, sorted.
        joints: names of the joints that it is about, sorted.
        before, after: the number that was changed, or how far off it was, in ``unit``; ``None``
            where no number was.
        unit: of both; ``faces``, ``deg``, ``mm``, ``rad`` or ``m``.
        free_share: of its range, how far the joint went before it ran into something.
        code: of the finding that led to it.
        why: that finding's message.
        told: its sentence, of a repair that a report holds as a sentence alone.
    """

    kind: RepairKind
    parts: tuple[str, ...] = ()
    pairs: tuple[Pair, ...] = ()
    joints: tuple[str, ...] = ()
    before: float | None = None
    after: float | None = None
    unit: str = ""
    free_share: float | None = None
    code: str = ""
    why: str = ""
    told: str = ""

    @property
    def sentence(self) -> str:
        """Return the change and its reason, for people."""
        if self.told:
            return self.told
        blocked = "it runs into something"
        if self.free_share is not None:
            blocked += f" after {self.free_share:.0%} of its range"
        words = {
            "parts": ", ".join(self.parts),
            "pairs": ", ".join(f"{a} and {b}" for a, b in self.pairs),
            "joints": ", ".join(self.joints),
            "part": self.parts[0] if self.parts else "",
            "others": " and ".join(self.parts[1:]) or "another",
            "why": self.why or blocked,
        }
        return self.kind.sentence.format(**{**vars(self), **words})

    def to_dict(self) -> dict[str, Any]:
        """Return JSON data, without empty fields."""
        return {
            name: list(value) if isinstance(value, tuple) else value
            for name, value in vars(self).items()
            if value not in ((), "", None)
        }

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Repair:
        """Return what :meth:`to_dict` wrote. Raises ValueError at anything else."""
        return from_json(cls, data)


def older_repair(sentence: str) -> Repair:
    """Return a repair of which a report holds the sentence alone."""
    kinds = (kind for words, kind in _OLDER.items() if sentence.startswith(words))
    return Repair(next(kinds, RepairKind.OTHER), told=sentence)
