"""The folder of nights: their names, their order, and which of them is not finished.

::

    nights/index.html            all nights
    nights/message.txt           one line about the last one
    nights/0007/summary.json     figures; what the trend is made of
    nights/0007/attempts.parquet a row per input
    nights/0007/index.html       the page
    nights/0007/message.txt      one line for a chat
    nights/0007/night.log        what happened when
    nights/0007/attempts.jsonl   rows so far; only while the night is not finished
"""

from __future__ import annotations

import json
import re
from pathlib import Path

from ...errors import ConfigError
from .night import Night, night_from

SUMMARY, TABLE, PAGE, MESSAGE = "summary.json", "attempts.parquet", "index.html", "message.txt"
LOG, JOURNAL = "night.log", "attempts.jsonl"
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}")
_DIGITS = 4


def nights_of(output: Path) -> Path:
    """Where the nights of a registry lie."""
    return output / "nights"


def names(nights: Path) -> tuple[str, ...]:
    """Names of all nights there are, finished or not, sorted."""
    if not nights.is_dir():
        return ()
    return tuple(
        sorted(
            path.name for path in nights.iterdir() if path.is_dir() and _NAME.fullmatch(path.name)
        )
    )


def unfinished(nights: Path) -> tuple[str, ...]:
    """Names of the nights that were interrupted and could go on."""
    return tuple(name for name in names(nights) if (nights / name / JOURNAL).is_file())


def chosen_name(nights: Path, wanted: str | None) -> str:
    """The name of the night to run: the one asked for, else one that goes on, else the next number.

    Raises:
        ConfigError: a name that is no folder's, or of a night that is finished.
    """
    going_on = unfinished(nights)
    if wanted is None:
        return going_on[-1] if going_on else next_name(nights)
    if not _NAME.fullmatch(wanted):
        raise ConfigError(
            f"--name: is {wanted!r}, want letters, digits, '.', '_' and '-', at most 64"
        )
    if wanted in names(nights) and wanted not in going_on:
        raise ConfigError(
            f"--name: night {wanted!r} is finished; take another name, or none for the next number"
        )
    return wanted


def next_name(nights: Path) -> str:
    """The number after the highest there is."""
    numbers = [int(name) for name in names(nights) if name.isdecimal()]
    return f"{max(numbers, default=0) + 1:0{_DIGITS}d}"


def stored_nights(nights: Path) -> tuple[Night, ...]:
    """All nights with a summary, by when they started. A summary that cannot be read is passed over."""
    stored = [night for name in names(nights) if (night := read_night(nights / name)) is not None]
    return tuple(sorted(stored, key=lambda night: (night.started, night.name)))


def read_night(folder: Path) -> Night | None:
    """The figures of one night; ``None`` where there are none to be read."""
    try:
        data = json.loads((folder / SUMMARY).read_text(encoding="utf-8"))
        # The folder's own name counts: people rename folders, and links must still lead there.
        return night_from({**data["night"], "name": folder.name})
    except (OSError, ValueError, KeyError, TypeError):
        return None
