"""Assets of an export, checked and published."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from asset_factory.sim_checks import Status

from ...errors import RegistryError
from ...runtime.layout import ASSETS, REJECTED
from ...runtime.store import folder_digests
from ..entry import Entry
from ..export.contents import SUMS_NAME
from ..folders import folders_of, read_record
from ..registry import Registry
from ..report_file import BuildReport, file_digests, read_report
from .unpacking import MOST_BYTES, read_sums, unpack

_NAMED = 5


@dataclass(frozen=True)
class TakenIn:
    """Ids that an import published, and ids that were there already, byte for byte."""

    published: tuple[str, ...]
    same: tuple[str, ...]


@dataclass(frozen=True)
class _Arrival:
    entry: Entry
    folder: Path
    told: BuildReport


def import_export(
    registry: Registry,
    source: Path,
    *,
    replace: bool = False,
    trusted: bool = False,
    most_bytes: int = MOST_BYTES,
) -> TakenIn:
    """Take an export's assets into a registry.

    All of it is unpacked beside the registry and checked before any of it is published; each asset
    is then published as a built one is. If that is interrupted, assets are there or not, and the
    same import goes on.

    Args:
        registry: where to.
        source: a folder or archive that :func:`..export.write_export` wrote.
        replace: let its assets take the place of others with the same ids.
        trusted: believe what it says they were made from, so that builds of the same inputs are
            answered with them.
        most_bytes: size of all its files together [bytes].

    Raises:
        RegistryError: it is no export, something in it is not what its digests say, or other assets
            have its ids.
    """
    with registry.staging_folder() as staging:
        content = staging / "content"
        content.mkdir()
        unpack(source, content, most_bytes)
        _require_digests(source, content)
        found = (each for name in (ASSETS, REJECTED) for each in (content / name).glob("*"))
        folders = sorted(found, key=lambda folder: folder.name)
        arrivals = [_arrival(source, folder, trusted=trusted) for folder in folders]
        fresh = [arrival for arrival in arrivals if not _is_there(registry, arrival)]
        if not replace:
            _require_no_others(registry, source, fresh)
        for arrival in fresh:
            registry.add(arrival.entry, arrival.told, arrival.folder)
        for arrival in arrivals:
            _take_note(registry, arrival.entry)
    published = {arrival.entry.id for arrival in fresh}
    ids = (arrival.entry.id for arrival in arrivals)
    return TakenIn(tuple(sorted(published)), tuple(each for each in ids if each not in published))


def _require_digests(source: Path, content: Path) -> None:
    sums = read_sums(content / SUMS_NAME)
    found = folder_digests(content, without=(SUMS_NAME,))
    wrong = sorted(name for name in sums.keys() | found.keys() if sums.get(name) != found.get(name))
    if wrong:
        absent = "is not listed" if wrong[0] in found else "is missing"
        state = "is altered" if wrong[0] in sums.keys() & found.keys() else absent
        more = f", and {len(wrong) - 1} more files are wrong" if len(wrong) > 1 else ""
        raise RegistryError(f"{source}: {wrong[0]!r} {state} (SHA-256){more}; nothing was imported")


def _arrival(source: Path, folder: Path, *, trusted: bool) -> _Arrival:
    """Return an asset that is what it says. Raises RegistryError otherwise."""
    try:
        entry = read_record(folder).entry
        stored = read_report(folder)
        registered = stored.files
        told = stored.told
    except (RegistryError, ValueError) as error:
        raise RegistryError(f"{source}: {error}; nothing was imported") from error
    passed = entry.status is Status.PASSED
    faults = {
        "its files are not those of its report": registered != file_digests(folder),
        "has passed, its report says otherwise": passed and not stored.passed,
    }
    for fault, there in faults.items():
        if there:
            raise RegistryError(f"{source}: {entry.id}: {fault}; nothing was imported")
    # Anybody can write down any key; a build that asks for it would be told that its input has
    # passed.
    return _Arrival(entry if trusted else dataclasses.replace(entry, key=""), folder, told)


def _is_there(registry: Registry, arrival: _Arrival) -> bool:
    mine = registry.folder(arrival.entry)
    if registry.find(arrival.entry.id) is None:
        return False
    try:
        same = read_report(mine).told == arrival.told
        return same and file_digests(mine) == file_digests(arrival.folder)
    except (RegistryError, OSError):
        return False


def _require_no_others(registry: Registry, source: Path, arrivals: Sequence[_Arrival]) -> None:
    ids = [arrival.entry.id for arrival in arrivals]
    others = [each for each in ids if folders_of(registry.root, each)]
    if others:
        more = f" and {len(others) - _NAMED} more" if len(others) > _NAMED else ""
        named = ", ".join(others[:_NAMED]) + more
        others_there = f"the registry has other assets of the same ids: {named}"
        raise RegistryError(f"{source}: {others_there}; --replace takes these")


def _take_note(registry: Registry, theirs: Entry) -> None:
    """Add an arrival's tags; take over whether a robot opened it where nobody here knows."""
    mine = registry.entry(theirs.id)
    noted = dataclasses.replace(
        mine, tags=(*mine.tags, *theirs.tags), solved=mine.solved or theirs.solved
    )
    if noted != mine:
        registry.note(theirs.id, tags=noted.tags, solved=noted.solved)
