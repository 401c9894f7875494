"""The folder of nights: its files, and how nights are named."""

from __future__ import annotations

import json
import re
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from ...errors import ConfigError
from ...runtime.store import write_json, write_whole
from .night import Night, night_from
from .render import night_page, nights_page
from .report import NightlyReport, message, summary
from .table import write_table

SUMMARY = "summary.json"  # figures; what the trend is made of
TABLE = "attempts.parquet"  # a row per try of an input
PAGE = "index.html"  # of a night, and of all nights
MESSAGE = "message.txt"  # one line for a chat
LOG = "night.log"  # what happened when
JOURNAL = "attempts.jsonl"  # attempts so far; only while the night is not finished
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}")


def require_libraries() -> None:
    """Raise ConfigError where a library is missing: before the night, not after it."""
    for library in ("jinja2", "pyarrow"):
        if find_spec(library) is None:
            hint = "pip install 'asset-factory[nightly]'"
            raise ConfigError(f"the nightly report needs {library}: {hint}")


def nights_of(output: Path) -> Path:
    """Return where the nights of a registry lie."""
    return output / "nights"


def names(nights: Path) -> tuple[str, ...]:
    """Return the names of all nights there are, finished or not, sorted."""
    folders = nights.iterdir() if nights.is_dir() else ()
    return tuple(
        sorted(path.name for path in folders if path.is_dir() and _NAME.fullmatch(path.name))
    )


def unfinished(nights: Path) -> tuple[str, ...]:
    """Return the names of the nights that were interrupted and could go on."""
    return tuple(name for name in names(nights) if (nights / name / JOURNAL).is_file())


def chosen_name(nights: Path, wanted: str | None) -> str:
    """Choose the night to run: as asked for, else an unfinished one, else the next number.

    Raises:
        ConfigError: a name that cannot be a folder's, or of a night that is finished.
    """
    going_on = unfinished(nights)
    if wanted is None:
        return going_on[-1] if going_on else next_name(nights)
    if not _NAME.fullmatch(wanted):
        want = "want letters, digits, '.', '_' and '-', at most 64"
        raise ConfigError(f"--name: is {wanted!r}, {want}")
    if wanted in names(nights) and wanted not in going_on:
        advice = "take another name, or none for the next number"
        raise ConfigError(f"--name: night {wanted!r} is finished; {advice}")
    return wanted


def next_name(nights: Path) -> str:
    """Return the number after the highest there is."""
    numbers = [int(name) for name in names(nights) if name.isdecimal()]
    return f"{max(numbers, default=0) + 1:04d}"


def read_night(folder: Path) -> Night | None:
    """Return the figures of one night; ``None`` where there are none to be read."""
    try:
        # The folder's own name counts: people rename folders, and links must still lead there.
        return night_from({**_summary(folder)["night"], "name": folder.name})
    except (OSError, ValueError, KeyError, TypeError):
        return None


def read_sources(folder: Path) -> dict[str, tuple[int, int]]:
    """Read how many inputs of each source passed, of how many; empty where none says."""
    try:
        told = _summary(folder)["sources"]
        return {str(row["source"]): (int(row["passed"]), int(row["tried"])) for row in told}
    except (OSError, ValueError, KeyError, TypeError):
        return {}


def _summary(folder: Path) -> Any:
    return json.loads((folder / SUMMARY).read_text(encoding="utf-8"))


def stored_nights(nights: Path) -> tuple[Night, ...]:
    """Return all nights with a summary that can be read, by when they started."""
    stored = (read_night(nights / name) for name in names(nights))
    known = (night for night in stored if night is not None)
    return tuple(sorted(known, key=lambda night: (night.started, night.name)))


def publish(folder: Path, report: NightlyReport) -> None:
    """Write the files of a night, each whole; with a summary, the last, it has all of them.

    Then the page of all nights, and the message where scripts find it.
    """
    told = f"{message(report)}\n".encode()
    write_table(folder / TABLE, report.tried)
    write_whole(folder / PAGE, night_page(report).encode())
    write_whole(folder / MESSAGE, told)
    write_json(folder / SUMMARY, summary(report))
    write_whole(folder.parent / PAGE, nights_page(stored_nights(folder.parent)).encode())
    write_whole(folder.parent / MESSAGE, told)
