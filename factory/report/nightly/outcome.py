"""What a night's exit code says, and the sentences behind it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from ...errors import Exit
from ..summary import JobState
from .figures import Changes
from .formats import counted
from .night import Night, share

DAMAGED = 4
YIELD_FELL = 5
SEVERE = (DAMAGED, YIELD_FELL)
ALL_INPUTS = "all"
SHARED_INPUTS = "shared"


@dataclass(frozen=True)
class FailureRules:
    """What makes the exit code differ from 0; configs/nightly.toml explains each setting."""

    unjudged: bool = True
    damage: bool = True
    yield_drop: float = 0.05
    over: str = ALL_INPUTS


@dataclass(frozen=True)
class Concern:
    """A sentence that somebody should read, and the exit code that it makes, if any."""

    sentence: str
    exit_code: int = Exit.OK


def exit_code(concerns: Iterable[Concern]) -> int:
    """The exit code of a night: that of the first of its concerns that makes one."""
    return next((item.exit_code for item in concerns if item.exit_code != Exit.OK), Exit.OK)


def concerns(
    night: Night,
    before: Night | None,
    changes: Changes,
    failure: FailureRules,
    not_allowed: int = 0,
) -> Iterator[Concern]:
    """What somebody should look at, the worst first; nothing when all is well.

    ``not_allowed`` counts registered assets under a license that is not allowed.
    """
    if night.state == JobState.INTERRUPTED:
        sentence = "The night was interrupted; the next run goes on with it."
        yield Concern(sentence, Exit.INTERRUPTED)
    if night.damaged:
        assets = counted(night.damaged, "registered asset")
        sentence = f"Damaged: {assets}; the files are not what was registered."
        yield Concern(sentence, DAMAGED if failure.damage else Exit.OK)
    fall = _fall(night, before, changes, failure.over)
    # Rounded: a fall of exactly what is allowed is allowed, whatever binary fractions say.
    if before and round(fall, 9) > failure.yield_drop:
        over = " of the inputs that both nights had" if failure.over == SHARED_INPUTS else ""
        fell = f"fell by {100 * fall:.1f} points against night {before.name}"
        allowed = f"{100 * failure.yield_drop:g} are allowed"
        yield Concern(f"The yield{over} {fell}; {allowed}.", YIELD_FELL)
    if night.unjudged:
        sentence = f"{counted(night.unjudged, 'input')} could not be judged."
        yield Concern(sentence, Exit.UNJUDGED if failure.unjudged else Exit.OK)
    if ours := sum(change.same_content for change in changes.failing):
        inputs = counted(ours, "unchanged input")
        yield Concern(f"{inputs} passed the night before and not now.")
    if not_allowed:
        yield Concern(f"License not allowed: {counted(not_allowed, 'registered asset')}.")
    if night.waiting:
        inputs = counted(night.waiting, "input")
        yield Concern(f"Not begun: {inputs}; the next night takes them up.")


def _fall(night: Night, before: Night | None, changes: Changes, over: str) -> float:
    """By how much the share that passed fell; 0 where one of the nights has none."""
    old = before.yielded if before else None
    new = night.yielded
    if over == SHARED_INPUTS:
        old = share(changes.passed_before, changes.shared)
        new = share(changes.passed_now, changes.shared)
    return 0.0 if old is None or new is None else old - new
