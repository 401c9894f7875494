"""What differs between two nights, input by input."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .attempt import Attempt


@dataclass(frozen=True)
class Change:
    """An input whose verdict is another one than the night before.

    Attributes:
        before, now: its attempts.
        same_content: whether the file is still the same, so that the change is ours.
    """

    before: Attempt
    now: Attempt

    @property
    def same_content(self) -> bool:
        """Whether the input is still the same file: ids end in its digest."""
        return self.before.id == self.now.id


@dataclass(frozen=True)
class Changes:
    """Two nights compared, over the inputs that both had.

    Attributes:
        failing: passed then and not now.
        passing: the other way round.
        other: failed both times, for another reason.
        shared: inputs of both nights.
        passed_before, passed_now: how many of those passed.
        fresh: inputs of the later night only.
        gone: inputs of the earlier night only.
    """

    failing: tuple[Change, ...] = ()
    passing: tuple[Change, ...] = ()
    other: tuple[Change, ...] = ()
    shared: int = 0
    passed_before: int = 0
    passed_now: int = 0
    fresh: tuple[Attempt, ...] = ()
    gone: tuple[Attempt, ...] = ()


def compare(before: Sequence[Attempt], now: Sequence[Attempt]) -> Changes:
    """Compare two nights.

    Inputs are matched by their path; those that were moved since, by their id.
    """
    pairs = _matched(before, now)
    changed = [Change(old, new) for old, new in pairs]
    met_before = {old.input for old, _ in pairs}
    met_now = {new.input for _, new in pairs}
    return Changes(
        failing=tuple(c for c in changed if c.before.passed and not c.now.passed),
        passing=tuple(c for c in changed if c.now.passed and not c.before.passed),
        other=tuple(
            c
            for c in changed
            if not c.before.passed and not c.now.passed and c.before.reason != c.now.reason
        ),
        shared=len(pairs),
        passed_before=sum(old.passed for old, _ in pairs),
        passed_now=sum(new.passed for _, new in pairs),
        fresh=tuple(a for a in now if a.input not in met_now),
        gone=tuple(a for a in before if a.input not in met_before),
    )


def _matched(before: Sequence[Attempt], now: Sequence[Attempt]) -> list[tuple[Attempt, Attempt]]:
    by_path = {attempt.input: attempt for attempt in before}
    current = {attempt.input for attempt in now}
    moved = {attempt.id: attempt for attempt in before if attempt.input not in current}
    pairs = []
    for attempt in now:
        old = by_path.get(attempt.input) or moved.pop(attempt.id, None)
        if old is not None:
            pairs.append((old, attempt))
    return pairs
