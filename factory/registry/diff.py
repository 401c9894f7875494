"""What differs between two registries, or between one and its past."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields

from asset_factory.sim_checks import Status

from .entry import Entry

#: Two builds of one asset with other library versions may still be the same asset.
IGNORED = ("key",)


@dataclass(frozen=True)
class EntryChange:
    """One asset, before and after; ``columns`` are those that differ."""

    id: str
    columns: tuple[str, ...]
    before: Entry
    after: Entry


@dataclass(frozen=True)
class Diff:
    """What happened to whom; each group by id.

    Attributes:
        new: only after.
        gone: only before.
        newly_passed: passed after, not before.
        newly_failed: passed before, not after; ``after.reason`` and ``after.message`` say why.
        changed: passed or failed both times, with something else about it.
        same: how many did not change.
    """

    new: tuple[Entry, ...] = ()
    gone: tuple[Entry, ...] = ()
    newly_passed: tuple[EntryChange, ...] = ()
    newly_failed: tuple[EntryChange, ...] = ()
    changed: tuple[EntryChange, ...] = ()
    same: int = 0


def diff(before: Iterable[Entry], after: Iterable[Entry]) -> Diff:
    """Compare two lists of entries by id."""
    old, new = ({entry.id: entry for entry in entries} for entries in (before, after))
    both = [_change(old[each], new[each]) for each in sorted(old.keys() & new.keys())]
    differing = [change for change in both if change.columns]
    passed = [
        (change, change.before.status is Status.PASSED, change.after.status is Status.PASSED)
        for change in differing
    ]
    return Diff(
        new=tuple(new[asset_id] for asset_id in sorted(new.keys() - old.keys())),
        gone=tuple(old[asset_id] for asset_id in sorted(old.keys() - new.keys())),
        newly_passed=tuple(change for change, was, now in passed if now and not was),
        newly_failed=tuple(change for change, was, now in passed if was and not now),
        changed=tuple(change for change, was, now in passed if was == now),
        same=len(both) - len(differing),
    )


def _change(before: Entry, after: Entry) -> EntryChange:
    names = (each.name for each in fields(Entry) if each.name not in IGNORED)
    columns = tuple(name for name in names if getattr(before, name) != getattr(after, name))
    return EntryChange(after.id, columns, before, after)
