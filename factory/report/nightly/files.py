"""The folder of nights: its files, how nights are named, and their pages from templates."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from asset_factory.sim_checks import Status

from ...errors import ConfigError
from ...intake.licenses import is_allowed
from ...runtime.store import write_json, write_whole
from ..pages import BASE_CSS, trusted
from ..pages import environment as templates
from ..summary import JobState
from . import figures, formats
from .night import Night, night_from, share
from .outcome import SEVERE
from .report import NightlyReport, message, summary
from .table import write_table

if TYPE_CHECKING:
    from jinja2 import Environment


SUMMARY = "summary.json"  # figures; what the trend is made of
TABLE = "attempts.parquet"  # a row per try of an input
PAGE = "index.html"  # of a night, and of all nights
MESSAGE = "message.txt"  # one line for a chat
LOG = "night.log"  # what happened when
JOURNAL = "attempts.jsonl"  # attempts so far; only while the night is not finished
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}")


def names(nights: Path) -> tuple[str, ...]:
    """Return the names of all nights there are, finished or not, sorted."""
    folders = nights.iterdir() if nights.is_dir() else ()
    named = (path.name for path in folders if path.is_dir())
    return tuple(sorted(name for name in named if _NAME.fullmatch(name)))


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


def night_page(report: NightlyReport) -> str:
    """Return the page of a night, as HTML: the same report gives the same bytes."""
    names = ("reasons", "stage_times", "slowest", "licenses")
    told = {name: getattr(figures, name)(report.attempts) for name in names}
    return environment().get_template("night.html.j2").render(report=report, **told)


def nights_page(nights: Sequence[Night]) -> str:
    """Render the page that lists all nights, the last one first; ``nights`` in their order."""
    rows = [_row(night, before) for night, before in zip(nights, (None, *nights), strict=False)]
    return environment().get_template("nights.html.j2").render(nights=nights, rows=rows[::-1])


def _row(night: Night, before: Night | None) -> dict[str, Any]:
    """Return what the list of nights says of one of them."""
    return {
        **asdict(night),
        "took": formats.clock_span(night.seconds),
        "yield": formats.percent(night.yielded),
        "change": formats.points(before.yielded if before else None, night.yielded),
        "anew": night.attempted - night.known,
        "damaged": None if night.verified is None else night.damaged,
    }


@cache
def environment() -> Environment:
    """Return where the templates are found, and what they may call upon; all output is escaped."""
    made = templates(__package__, is_allowed=is_allowed, share=share)
    names = ("clock_span", "counted", "percent", "points", "readable", "span", "figure")
    made.filters |= {name: getattr(formats, name) for name in names}
    made.globals |= {"FINISHED": JobState.FINISHED, "PASSED": Status.PASSED}
    night_css = Path(__file__).parent / "templates" / "night.css"
    css = "".join(file.read_text(encoding="utf-8") for file in (BASE_CSS, night_css))
    # One file that runs no script.
    made.globals |= {"alone": {"css": trusted(css), "digest": trusted("'none'")}}
    made.globals |= {"UNJUDGED": Status.UNJUDGED, "STATUSES": tuple(Status), "SEVERE": SEVERE}
    return made
