"""Pieces of HTML. What is called ``cell`` or ``body`` is HTML already; everything else is text, and escaped here."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from urllib.parse import quote

from ...jobs.nightly.attempt import Attempt
from .style import DOCUMENT, STYLE

#: Rows seen at once, and rows that can be unfolded; more are in the table beside the page.
SHOWN, MOST = 20, 500
_LONGEST = 600


@dataclass(frozen=True)
class Column:
    """A column of a table.

    Attributes:
        head: its heading.
        kind: ``text``, ``short`` (never broken), ``number``, ``name`` or ``sentence``.
    """

    head: str
    kind: str = "text"


def document(title: str, body: str) -> str:
    """A whole page."""
    return DOCUMENT.substitute(title=text(title), style=STYLE, body=body)


def text(value: object, longest: int = _LONGEST) -> str:
    """Any text, as HTML. Characters that turn or break lines are shown, not obeyed; too long a text is cut."""
    told = "".join(c if c.isprintable() else "�" for c in str(value))
    return escape(told if len(told) <= longest else told[: longest - 1] + "…")


def tag(name: str, body: str, kind: str = "") -> str:
    """``<name class="kind">body</name>``."""
    return f'<{name} class="{kind}">{body}</{name}>' if kind else f"<{name}>{body}</{name}>"


def link(target: str, label: str) -> str:
    """A link; ``target`` is a relative path, not yet quoted."""
    return f'<a href="{escape(quote(target))}">{text(label)}</a>'


def status(name: str) -> str:
    """A verdict, in its colour."""
    return tag("span", text(name), name if name in ("passed", "rejected", "unjudged") else "")


def asset(attempt: Attempt, root: str = "../..") -> str:
    """An attempt's id, leading to its folder, and its report. ``root`` leads from the page to the registry."""
    folder = f"{root}/{'assets' if attempt.passed else 'rejected'}/{attempt.id}"
    return f"{link(folder + '/', attempt.id)} {tag('span', link(folder + '/report.json', 'report'), 'dim')}"


def table(
    columns: Sequence[Column], rows: Sequence[Sequence[str]], shown: int = SHOWN, most: int = MOST
) -> str:
    """A table; rows beyond ``shown`` are folded away, rows beyond ``most`` only counted.

    Args:
        columns: left to right.
        rows: of cells.
        shown: rows seen at once.
        most: rows there are at all, folded away or not.
    """
    if not rows:
        return ""
    parts = [_table(columns, rows[:shown])]
    if len(rows) > shown:
        rest = rows[shown:most]
        more = f"{len(rows) - shown:,} more"
        parts.append(
            f"<details><summary>{more}</summary>{_table(columns, rest)}{_beyond(len(rows) - most)}</details>"
        )
    return "".join(parts)


def _beyond(missing: int) -> str:
    return f'<p class="dim">And {missing:,} more, in attempts.parquet.</p>' if missing > 0 else ""


def _table(columns: Sequence[Column], rows: Sequence[Sequence[str]]) -> str:
    heads = "".join(_cell("th", text(c.head), c.kind) for c in columns)
    lines = [
        "".join(_cell("td", body, c.kind) for c, body in zip(columns, row, strict=True))
        for row in rows
    ]
    body = "\n".join(f"<tr>{line}</tr>" for line in lines)
    return f'<div class="scroll"><table><thead><tr>{heads}</tr></thead><tbody>\n{body}\n</tbody></table></div>'


def _cell(name: str, body: str, kind: str) -> str:
    return tag(name, body, "" if kind == "text" else kind)
