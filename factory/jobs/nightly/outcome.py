"""What a night's exit code says, and the sentences behind it."""

from __future__ import annotations

from ...errors import Exit
from .changes import Changes
from .night import INTERRUPTED, Night, share
from .settings import SHARED_INPUTS, Failure

DAMAGED, YIELD_FELL = 4, 5


def exit_code(night: Night, before: Night | None, changes: Changes, failure: Failure) -> int:
    """The exit code of a night, the worst news first.

    An interrupted night says only that. Damage to what is registered goes before a yield that fell,
    and that before inputs that could not be judged.
    """
    if night.state == INTERRUPTED:
        return Exit.INTERRUPTED
    if failure.damage and night.damaged:
        return DAMAGED
    fell = yield_fall(night, before, changes, failure.over)
    # Shares are rounded so that a fall of exactly the allowed amount is allowed, whatever binary
    # fractions say.
    if fell is not None and round(fell, 9) > failure.yield_drop:
        return YIELD_FELL
    if failure.unjudged and night.unjudged:
        return Exit.UNJUDGED
    return Exit.OK


def yield_fall(night: Night, before: Night | None, changes: Changes, over: str) -> float | None:
    """By how much the share that passed is lower than the night before; ``None`` where one of them has none."""
    if over == SHARED_INPUTS:
        old, new = (
            share(changes.passed_before, changes.shared),
            share(changes.passed_now, changes.shared),
        )
    else:
        old, new = (before.yielded if before else None), night.yielded
    return None if old is None or new is None else old - new


def sentences(
    night: Night, before: Night | None, changes: Changes, failure: Failure, not_allowed: int = 0
) -> tuple[str, ...]:
    """What somebody should look at this morning, the worst first; empty when all is well.

    Args:
        night: to tell of.
        before: the night before; ``None`` for the first one.
        changes: between the two.
        failure: what the exit code is about.
        not_allowed: registered assets under a licence that is not allowed.
    """
    found = []
    if night.state == INTERRUPTED:
        found.append("The night was interrupted; the next run goes on with it.")
    if night.damaged:
        found.append(
            f"Damaged: {count(night.damaged, 'registered asset')}; the files are not what was registered."
        )
    fell = yield_fall(night, before, changes, failure.over)
    if fell is not None and before is not None and round(fell, 9) > failure.yield_drop:
        over = " of the inputs that both nights had" if failure.over == SHARED_INPUTS else ""
        points, allowed = f"{100 * fell:.1f}", f"{100 * failure.yield_drop:g}"
        found.append(
            f"The yield{over} fell by {points} points against night {before.name}; {allowed} are allowed."
        )
    if night.unjudged:
        found.append(f"{count(night.unjudged, 'input')} could not be judged.")
    ours = sum(change.same_content for change in changes.failing)
    if ours:
        found.append(f"{count(ours, 'unchanged input')} passed the night before and not now.")
    if not_allowed:
        found.append(f"Licence not allowed: {count(not_allowed, 'registered asset')}.")
    if night.waiting:
        found.append(f"Not begun: {count(night.waiting, 'input')}; the next night takes them up.")
    return tuple(found)


def count(number: int, noun: str) -> str:
    """``1 asset``, ``1,200 assets``."""
    return f"{number:,} {noun}{'' if number == 1 else 's'}"
