"""What a night's exit code says, and the sentences behind it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from ...errors import Exit
from ..summary import JobState
from .figures import SourceRules, SourceYield
from .formats import counted, percent
from .night import Night, share
from .report import NightlyReport

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
    source: SourceRules = field(default_factory=SourceRules)


@dataclass(frozen=True)
class Concern:
    """A sentence that somebody should read, and the exit code that it makes, if any."""

    sentence: str
    exit_code: int = Exit.OK


def exit_code(concerns: Iterable[Concern]) -> int:
    """Return the exit code of a night: that of the first of its concerns that makes one."""
    return next((item.exit_code for item in concerns if item.exit_code != Exit.OK), Exit.OK)


def concerns(report: NightlyReport, failure: FailureRules) -> Iterator[Concern]:
    """Yield what somebody should look at, the worst first; nothing when all is well."""
    night = report.night
    before = report.before
    if night.state == JobState.INTERRUPTED:
        sentence = "The night was interrupted; the next run goes on with it."
        yield Concern(sentence, Exit.INTERRUPTED)
    if night.damaged:
        lasting = failure.damage and night.damaged > night.mended
        yield Concern(_damage(night), DAMAGED if lasting else Exit.OK)
    fall = _fall(report, failure.over)
    # Rounded: a fall of exactly what is allowed is allowed, whatever binary fractions say.
    if before and round(fall, 9) > failure.yield_drop:
        over = " of the inputs that both nights had" if failure.over == SHARED_INPUTS else ""
        fell = f"fell by {100 * fall:.1f} points against night {before.name}"
        allowed = f"{100 * failure.yield_drop:g} are allowed"
        yield Concern(f"The yield{over} {fell}; {allowed}.", YIELD_FELL)
    for source in report.sources:
        if source.fell:
            yield Concern(_drift(source, failure.source), YIELD_FELL)
    if anew := night.unjudged - night.crashed:
        sentence = f"{counted(anew, 'input')} could not be validated."
        yield Concern(sentence, Exit.UNJUDGED if failure.unjudged else Exit.OK)
    if night.crashed:
        inputs = counted(night.crashed, "input")
        yield Concern(f"Known to crash: {inputs}; another version of anything tries them again.")
    if ours := sum(change.same_content for change in report.changes.failing):
        inputs = counted(ours, "unchanged input")
        yield Concern(f"{inputs} passed the night before and not now.")
    if report.not_allowed:
        assets = counted(len(report.not_allowed), "registered asset")
        yield Concern(f"License not allowed: {assets}.")
    if night.waiting:
        inputs = counted(night.waiting, "input")
        yield Concern(f"Not begun: {inputs}; the next night takes them up.")


def _damage(night: Night) -> str:
    became = {"made whole again": night.mended, "withdrawn": night.withdrawn}
    told = ", ".join(f"{number:,} {what}" for what, number in became.items() if number)
    assets = counted(night.damaged, "registered asset")
    return f"Damaged: {assets}; the files were not what was registered{': ' * bool(told)}{told}."


def _drift(source: SourceYield, rules: SourceRules) -> str:
    usual = f"{percent(source.usual)} is usual over {counted(source.nights, 'night')}"
    allowed = f"{100 * rules.drop:g} points less are allowed"
    return f"The yield of {source.source} is {percent(source.yielded)}; {usual}, {allowed}."


def _fall(report: NightlyReport, over: str) -> float:
    """Return by how much the share that passed fell; 0 where one of the nights has none."""
    changes = report.changes
    old = report.before.yielded if report.before else None
    new = report.night.yielded
    if over == SHARED_INPUTS:
        old = share(changes.passed_before, changes.shared)
        new = share(changes.passed_now, changes.shared)
    return 0.0 if old is None or new is None else old - new
