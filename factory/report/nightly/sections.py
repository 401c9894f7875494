"""Sections of a night's page. Each is HTML, or empty where there is nothing to say."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ...jobs.nightly.attempt import STATUSES, UNJUDGED, Attempt
from ...jobs.nightly.changes import Change, Changes
from ...jobs.nightly.figures import licences, reasons, slowest, stage_times
from ...jobs.nightly.morning import SLOWEST, Morning
from ...jobs.nightly.night import share
from ...jobs.nightly.outcome import DAMAGED, YIELD_FELL, count
from ...jobs.nightly.permitted import permitted
from ...jobs.nightly.words import percent, points, span
from .charts import Bar, bars, trend
from .markup import Column, asset, link, status, table, tag, text

REASONS_DRAWN, ROWS_OF_ALL = 12, 1000


def attention(morning: Morning) -> str:
    """What to look at first."""
    if not morning.attention:
        return tag("div", "All is well: nothing here needs a look.", "well")
    lines = "".join(tag("li", text(sentence)) for sentence in morning.attention)
    kind = "attention bad" if morning.night.exit_code in (DAMAGED, YIELD_FELL) else "attention"
    return tag("div", tag("ul", lines), kind)


def tiles(morning: Morning) -> str:
    """The night's figures."""
    night, before = morning.night, morning.before
    change = points(before.yielded if before else None, night.yielded)
    against = f"{change} against {before.name}" if change and before else "passed of those tried"
    told = [("yield", percent(night.yielded), against)]
    told += [(name, f"{getattr(night, name):,}", "") for name in ("passed", "rejected", "unjudged")]
    built = night.attempted - night.known
    told.append(("built anew", f"{built:,}", f"{night.known:,} known from before"))
    if night.waiting or night.left_out:
        told.append(
            (
                "not begun",
                f"{night.waiting + night.left_out:,}",
                f"{night.left_out:,} for their licence",
            )
        )
    if night.verified is not None:
        told.append(("damaged", f"{night.damaged:,}", f"of {night.verified:,} verified"))
    boxes = [
        tag(
            "div",
            tag("span", text(name))
            + tag("b", text(value), _colour(name, value))
            + tag("span", text(note)),
            "tile",
        )
        for name, value, note in told
    ]
    return tag("div", "".join(boxes), "tiles")


def _colour(name: str, value: str) -> str:
    if value == "0" or name not in ("rejected", "unjudged", "damaged"):
        return ""
    return "rejected" if name == "damaged" else name


def damage(morning: Morning) -> str:
    """Registered assets whose files are not what was registered."""
    columns = (Column("asset", "name"), Column("damage", "short"), Column("what", "sentence"))
    rows = [
        (
            link(f"../../assets/{item.id}/", item.id) if item.id else "",
            tag("code", text(item.code)),
            text(item.message),
        )
        for item in morning.damage
    ]
    note = (
        tag(
            "p",
            "Remove an asset's folder, and the next night builds it anew from its input.",
            "dim",
        )
        if rows
        else ""
    )
    return _section("Damaged", table(columns, rows) + note)


def newly_failing(changes: Changes) -> str:
    """Passed the night before, and not now; unchanged inputs first, since there the change is ours."""
    ordered = sorted(
        changes.failing, key=lambda change: (not change.same_content, change.now.input)
    )
    columns = (
        Column("asset", "name"),
        Column("now", "short"),
        Column("why", "sentence"),
        Column("the file", "short"),
    )
    rows = [
        (
            asset(c.now),
            status(c.now.status),
            _why(c.now),
            "unchanged" if c.same_content else "changed since",
        )
        for c in ordered
    ]
    return _section("Newly failing", table(columns, rows))


def newly_passed(changes: Changes) -> str:
    """Passed now, and not the night before."""
    columns = (
        Column("asset", "name"),
        Column("was", "short"),
        Column("because", "sentence"),
        Column("the file", "short"),
    )
    return _section(
        "Newly passed", table(columns, [_recovered(change) for change in changes.passing], shown=10)
    )


def _recovered(change: Change) -> Sequence[str]:
    file = "unchanged" if change.same_content else "changed since"
    return asset(change.now), status(change.before.status), _why(change.before), file


def unjudged(attempts: Iterable[Attempt]) -> str:
    """What nobody could judge, and why."""
    columns = (
        Column("input", "name"),
        Column("why", "sentence"),
        Column("tries", "number"),
        Column("time", "number"),
    )
    rows = [
        (asset(a), _why(a), f"{a.attempts}", span(a.seconds))
        for a in attempts
        if a.status == UNJUDGED
    ]
    return _section("Could not be judged", table(columns, rows))


def why(attempts: Sequence[Attempt]) -> str:
    """Reasons, how often, and one example each."""
    found = reasons(attempts)
    if not found:
        return ""
    failed = sum(reason.count for reason in found)
    drawn = [
        Bar(r.code or "no code", r.count, f"{r.count:,}", r.status) for r in found[:REASONS_DRAWN]
    ]
    columns = (
        Column("reason", "short"),
        Column("inputs", "number"),
        Column("share", "number"),
        Column("for example", "sentence"),
    )
    rows = [
        (
            f"{tag('code', text(r.code or 'no code'))}<br>{status(r.status)}",
            f"{r.count:,}",
            percent(share(r.count, failed)),
            f"{asset(r.example)}<br>{text(r.example.message)}",
        )
        for r in found
    ]
    return _section(
        "Why inputs did not pass", bars(drawn, "Inputs by reason") + table(columns, rows)
    )


def over_nights(morning: Morning) -> str:
    """The trend."""
    drawn = trend(morning.trend)
    kinds = ", ".join(status(name) for name in STATUSES)
    note = f"Above: the share that passed. Below: how many inputs of each verdict ({kinds})."
    compared = ""
    if morning.before is not None and morning.changes.shared:
        then, now = (
            percent(share(n, morning.changes.shared))
            for n in (morning.changes.passed_before, morning.changes.passed_now)
        )
        compared = tag(
            "p",
            f"Of {count(morning.changes.shared, 'input')} that night {text(morning.before.name)} had too, "
            f"{now} passed; {then} then. New: {len(morning.changes.fresh):,}; gone: {len(morning.changes.gone):,}.",
        )
    return _section("Over the nights", compared + (drawn + tag("p", note, "dim") if drawn else ""))


def times(attempts: Sequence[Attempt]) -> str:
    """Stages and inputs that took longest."""
    stages = stage_times(attempts)
    if not stages:
        return ""
    whole = sum(item.seconds for item in stages)
    drawn = [
        Bar(
            s.stage,
            s.seconds,
            f"{percent(share_of(s.seconds, whole))} · {span(s.seconds)} · median {span(s.median)}",
        )
        for s in stages
    ]
    columns = (
        Column("slowest inputs", "name"),
        Column("time", "number"),
        Column("most of it in", "short"),
        Column("verdict", "short"),
    )
    rows = [
        (asset(a), span(a.seconds), text(_longest_stage(a)), status(a.status))
        for a in slowest(attempts, SLOWEST)
    ]
    note = tag("p", "Summed over all inputs that were built anew, however many at once.", "dim")
    return _section(
        "Where the time went", bars(drawn, "Time by stage") + note + table(columns, rows, shown=10)
    )


def share_of(part: float, whole: float) -> float | None:
    """A share of a time; ``None`` of none."""
    return part / whole if whole > 0.0 else None


def _longest_stage(attempt: Attempt) -> str:
    if not attempt.stages:
        return ""
    stage = max(attempt.stages, key=lambda name: attempt.stages[name])
    return f"{stage}, {span(attempt.stages[stage])}"


def by_licence(morning: Morning) -> str:
    """Inputs by licence, and what was left out for it."""
    columns = (
        Column("licence"),
        Column("passed", "number"),
        Column("rejected", "number"),
        Column("unjudged", "number"),
        Column("allowed"),
    )
    rows = [
        (
            text(item.licence or "none stated"),
            f"{item.passed:,}",
            f"{item.rejected:,}",
            f"{item.unjudged:,}",
            "yes" if permitted(item.licence, morning.rules) else tag("b", "no", "rejected"),
        )
        for item in licences(morning.attempts)
    ]
    left = table(
        (Column("left out", "name"), Column("licence")),
        [(text(item.input), text(item.licence or "none stated")) for item in morning.left_out],
        shown=5,
    )
    forbidden = table(
        (Column("registered all the same", "name"), Column("licence")),
        [(asset(a), text(a.licence or "none stated")) for a in morning.not_allowed],
        shown=5,
    )
    return _section("Licences", table(columns, rows) + forbidden + left)


def everything(attempts: Sequence[Attempt]) -> str:
    """Every input, those that did not pass first."""
    ordered = sorted(attempts, key=lambda a: (a.passed, a.status, a.input))
    columns = (
        Column("asset", "name"),
        Column("verdict", "short"),
        Column("reason", "short"),
        Column("parts", "number"),
        Column("joints", "number"),
        Column("hulls", "number"),
        Column("time", "number"),
        Column("licence"),
    )
    rows = [
        (
            asset(a),
            status(a.status),
            tag("code", text(a.reason)) if a.reason else "",
            *(f"{number:,}" for number in (a.parts, a.joints, a.hulls)),
            "known" if a.known else span(a.seconds),
            text(a.licence),
        )
        for a in ordered[:ROWS_OF_ALL]
    ]
    if not rows:
        return ""
    hidden = len(ordered) - len(rows)
    note = (
        f'<p class="dim">And {hidden:,} more, all passed or further down, in attempts.parquet.</p>'
        if hidden
        else ""
    )
    inside = table(columns, rows, shown=ROWS_OF_ALL)
    fold = f"<details><summary>{count(len(ordered), 'input')}</summary>{inside}{note}</details>"
    return _section("Everything", fold)


def _why(attempt: Attempt) -> str:
    code = tag("code", text(attempt.reason)) if attempt.reason else ""
    return f"{code} {text(attempt.message)}".strip()


def _section(title: str, body: str) -> str:
    return f"<section><h2>{text(title)}</h2>\n{body}</section>" if body else ""
