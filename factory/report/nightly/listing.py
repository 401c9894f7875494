"""The page that lists all nights."""

from __future__ import annotations

from collections.abc import Sequence

from ...jobs.nightly.night import Night
from ...jobs.nightly.words import clock_span, percent, points, readable
from .charts import trend
from .markup import Column, document, link, table, tag, text

MOST_NIGHTS = 5000


def nights_page(nights: Sequence[Night]) -> str:
    """All nights, the last one first, as HTML.

    Args:
        nights: in their order.
    """
    columns = (
        Column("night", "short"),
        Column("started", "short"),
        Column("took", "number"),
        Column("yield", "number"),
        Column("change", "number"),
        Column("passed", "number"),
        Column("rejected", "number"),
        Column("unjudged", "number"),
        Column("anew", "number"),
        Column("damaged", "number"),
        Column("state", "short"),
    )
    befores = (None, *nights[:-1])
    rows = (
        [_row(night, before) for before, night in zip(befores, nights, strict=True)][::-1]
        if nights
        else []
    )
    drawn = trend(nights)
    body = tag("h1", "Nights") + drawn + table(columns, rows, shown=60, most=MOST_NIGHTS)
    return document("Nights", body)


def _row(night: Night, before: Night | None) -> tuple[str, ...]:
    return (
        link(f"{night.name}/index.html", night.name),
        text(readable(night.started)),
        text(clock_span(night.seconds)),
        percent(night.yielded),
        text(points(before.yielded if before else None, night.yielded)),
        f"{night.passed:,}",
        f"{night.rejected:,}",
        f"{night.unjudged:,}",
        f"{night.attempted - night.known:,}",
        "–" if night.verified is None else f"{night.damaged:,}",
        text(night.state.replace("_", " ")),
    )
