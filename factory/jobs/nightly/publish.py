"""A morning's files, each written whole."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ...report.nightly.listing import nights_page
from ...report.nightly.page import night_page
from ...runtime.store import write_json, write_whole
from .folder import MESSAGE, PAGE, SUMMARY, TABLE
from .message import message
from .morning import Morning, summary_data
from .night import Night
from .table import write_table


def publish(folder: Path, morning: Morning) -> None:
    """Write table, page, message and, as the last, the summary: a night with a summary has all of them."""
    write_table(folder / TABLE, morning.tries)
    _write(folder / PAGE, night_page(morning))
    _write(folder / MESSAGE, message(morning) + "\n")
    write_json(folder / SUMMARY, summary_data(morning))


def publish_list(nights: Path, stored: Sequence[Night], last: Morning) -> None:
    """Write the page that lists all nights, and the last one's message where scripts find it."""
    _write(nights / PAGE, nights_page(stored))
    _write(nights / MESSAGE, message(last) + "\n")


def _write(path: Path, content: str) -> None:
    write_whole(path, content.encode("utf-8"))
