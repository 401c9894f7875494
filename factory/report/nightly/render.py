"""The pages of nights, from the templates beside this file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from asset_factory.sim_checks import Status

from ...intake.licenses import is_allowed
from ..pages import BASE_CSS, trusted
from ..pages import environment as templates
from ..summary import JobState
from . import figures, formats
from .night import Night, share
from .outcome import SEVERE
from .report import NightlyReport

if TYPE_CHECKING:
    from jinja2 import Environment


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
