"""What people see of a registry's upkeep in a terminal."""

from collections import Counter
from collections.abc import Sequence

from rich.table import Table

from ..registry.cleaning import Freed
from ..registry.diff import Diff, EntryChange
from ..registry.entry import Entry
from ..registry.rebuild import Rebuilt
from ..registry.verify import Problem
from ..runtime.terminal import Terminal, one_line, say

#: Lines of one kind that are shown before the rest is only counted.
SHOWN = 50
_UNITS = ("B", "kB", "MB", "GB", "TB")


def size(number: float) -> str:
    """Return a number of bytes as people say it."""
    unit = 0
    while number >= 1000 and unit < len(_UNITS) - 1:
        number = number / 1000
        unit = unit + 1
    return f"{number:.3g} {_UNITS[unit]}"


def print_rebuilt(rebuilt: Rebuilt) -> None:
    """Print how many rows there are now, and which folders have none."""
    _lines("unreadable", rebuilt.unreadable)
    say(f"{rebuilt.entries} entries; {len(rebuilt.unreadable)} folders could not be read")


def print_problems(problems: Sequence[Problem], assets: int) -> None:
    """Print what is not as it was published."""
    for kind, _ in Counter(problem.kind for problem in problems).most_common():
        _lines(kind, [problem.message for problem in problems if problem.kind == kind])
    wrong = {problem.id for problem in problems}
    say(f"{assets} entries: {len(wrong)} are not as they were published")


def print_freed(freed: Freed) -> None:
    """Print what was removed."""
    table = Table("what", "files", "size")
    for name in ("staging", "unfinished", "cache"):
        removed = getattr(freed, name)
        table.add_row(name, str(removed.files), size(removed.bytes))
    Terminal().print(table)
    say(f"freed {size(freed.bytes)}")


def print_diff(diff: Diff) -> None:
    """Print which assets are new, gone, better, worse or otherwise changed."""
    _lines("new", [_verdict(entry) for entry in diff.new])
    _lines("gone", [_verdict(entry) for entry in diff.gone])
    _lines(
        "newly passed",
        [f"{change.after.id}: was {_why(change.before)}" for change in diff.newly_passed],
    )
    _lines(
        "newly failed", [f"{change.after.id}: {_why(change.after)}" for change in diff.newly_failed]
    )
    _lines("changed", [f"{change.after.id}: {_columns(change)}" for change in diff.changed])
    groups = ("new", "gone", "newly_passed", "newly_failed", "changed")
    counts = [f"{len(getattr(diff, name))} {name.replace('_', ' ')}" for name in groups]
    say(", ".join([*counts, f"{diff.same} the same"]))


def _lines(kind: str, sentences: Sequence[str]) -> None:
    for sentence in sentences[:SHOWN]:
        say(one_line(f"{kind}: {sentence}"))
    if len(sentences) > SHOWN:
        say(f"{kind}: and {len(sentences) - SHOWN} more; --json has all")


def _verdict(entry: Entry) -> str:
    return f"{entry.id}: {entry.status}" + (f", {_why(entry)}" if entry.reason else "")


def _why(entry: Entry) -> str:
    return f"{entry.reason or entry.status}" + (f": {entry.message}" if entry.message else "")


def _columns(change: EntryChange) -> str:
    return ", ".join(
        f"{name} {_shown(getattr(change.before, name))} -> {_shown(getattr(change.after, name))}"
        for name in change.columns
    )


def _shown(value: object) -> str:
    text = ",".join(map(str, value)) if isinstance(value, tuple) else str(value)
    return text or "none"
