"""The page of one night."""

from __future__ import annotations

from ...jobs.nightly.morning import Morning
from ...jobs.nightly.words import clock_span, readable
from . import sections
from .markup import document, link, tag, text


def night_page(morning: Morning) -> str:
    """The page of a night, as HTML: the same morning gives the same bytes."""
    night, before = morning.night, morning.before
    places = [link("../index.html", "all nights")]
    if before is not None:
        places.append(link(f"../{before.name}/index.html", f"the night before: {before.name}"))
    when = f"{readable(night.started)}, {clock_span(night.seconds)}"
    body = [
        tag("nav", " · ".join(places)),
        tag("h1", f"Night {text(night.name)}"),
        tag(
            "p",
            text(
                when + ("" if night.state == "finished" else f"; {night.state.replace('_', ' ')}")
            ),
            "dim",
        ),
        sections.attention(morning),
        sections.tiles(morning),
        sections.damage(morning),
        sections.newly_failing(morning.changes),
        sections.unjudged(morning.attempts),
        sections.over_nights(morning),
        sections.why(morning.attempts),
        sections.newly_passed(morning.changes),
        sections.times(morning.attempts),
        sections.by_licence(morning),
        sections.everything(morning.attempts),
        _foot(morning),
    ]
    return document(f"Night {night.name}", "\n".join(part for part in body if part))


def _foot(morning: Morning) -> str:
    run = " · ".join(f"{text(name)}: {text(value)}" for name, value in morning.settings.items())
    rows = " · ".join(f"{text(name)}: {number:,}" for name, number in morning.registry.items())
    files = ", ".join(
        link(name, name)
        for name in ("attempts.parquet", "summary.json", "night.log", "message.txt")
    )
    lines = [
        run,
        f"Registry: {rows}" if rows else "",
        f"Beside this page: {files}. docs/reasons.md explains the codes.",
    ]
    lines.append("Links lead to assets as they are now; later nights may have replaced them.")
    return tag("footer", "".join(tag("p", line) for line in lines if line))
