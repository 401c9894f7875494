"""The pages: whole, the same for the same rows, harmless whatever inputs say, and not endless."""

import re
from xml.etree import ElementTree

import pytest
from html_page import Page
from hypothesis import given
from hypothesis import strategies as st
from nights_made import attempt, night

from asset_factory.factory.registry.verify import Problem
from asset_factory.factory.report.nightly.figures import compare
from asset_factory.factory.report.nightly.files import environment, night_page, nights_page
from asset_factory.factory.report.nightly.night import Night
from asset_factory.factory.report.nightly.report import LeftOut, NightlyReport

#: Nights in the trend; rows of a table that are seen at once, and those there are at all.
NIGHTS = 60
SHOWN = 20
MOST = 500
EVIL = "<script>alert(1)</script>\"'&<img src=x onerror=alert(2)>"


def rendered(source, **told):
    """What a template makes of some values."""
    source = '{% import "macros.html.j2" as m %}' + source
    return environment().from_string(source).render(**told)


def text(words):
    return rendered("{{ words }}", words=words)


def trend(nights):
    return rendered("{{ m.trend(nights) }}", nights=nights)


def report(count=12, evil=EVIL):
    before = [attempt(f"a{i}") for i in range(count)]
    now = [
        attempt(f"a{i}", ("passed", "rejected", "unjudged")[i % 3], seconds=i, stages={"load": i})
        for i in range(count)
    ]
    told = dict.fromkeys(("reason", "message", "license"), evil)
    now.append(attempt(evil, "rejected", **told, stages={evil: 1.0}, seconds=1.0))
    trend_of = tuple(Night(f"{n}", passed=n, rejected=2) for n in range(1, 5))
    return NightlyReport(
        night("5", now, damaged=1, verified=9),
        night("4", before),
        tuple(now),
        compare(before, now),
        (evil,),
        (Problem(evil, evil, "", evil),),
        (LeftOut(evil, evil),),
        registry={"new": 3},
        settings={"simulators": evil},
        trend=trend_of,
    )


def test_the_page_is_whole_needs_nothing_else_and_names_of_inputs_are_text():
    text = night_page(report())
    page = Page(text)
    assert {"script", "img", "iframe", "object", "link"}.isdisjoint(page.tags)
    assert page.loaded == page.handlers == []
    away = ("//", "javascript:", "data:")
    assert not [each for each in page.links if "://" in each or each.startswith(away)]
    assert "<script" not in text
    assert "<img" not in text
    assert "&lt;script&gt;alert(1)" in text
    # The same rows give the same bytes.
    assert night_page(report()) == text


@given(st.text(max_size=60))
def test_no_text_is_ever_markup(words):
    told = text(words)
    assert not re.search(r"[<>\"']", told)
    link = rendered("{{ m.link(words, words) }}", words=words)
    page = Page(f"<p>{link}{told}</p>")
    assert (page.tags, page.handlers) == (["p", "a"], [])


def test_text_that_turns_lines_round_is_shown_and_long_text_is_cut():
    assert "\u202e" not in text("good\u202eglb.exe")
    assert "\n" not in text("two\nlines")
    assert len(text("x" * 10_000)) < 2000


def test_links_lead_to_the_folder_and_the_report():
    links = Page(night_page(report(evil="odd name?#%"))).links
    assert "../../assets/a0-aaaaaaaaaa/" in links
    assert "../../rejected/a1-aaaaaaaaaa/report.json" in links
    assert "../../rejected/odd%20name%3F%23%25-aaaaaaaaaa/" in links


def test_an_empty_night_has_a_page():
    page = night_page(NightlyReport(night("1")))
    Page(page)
    assert "All is well" in page
    Page(nights_page(()))


@pytest.mark.parametrize(
    ("rows", "folded", "counted"), [(SHOWN, 0, 0), (SHOWN + 1, 1, 0), (MOST + 7, 1, 7)]
)
def test_long_tables_are_folded_and_longer_ones_counted(rows, folded, counted):
    body = rendered('{{ m.table({"n": "n"}, rows) }}', rows=[{"n": i} for i in range(rows)])
    Page(body)
    assert body.count("<details>") == folded
    assert body.count("<td") == min(rows, MOST)
    assert (f"And {counted:,} more, in attempts.parquet" in body) == bool(counted)


def test_the_page_of_ten_thousand_inputs_stays_readable():
    page = night_page(report(10_000))
    assert len(page) < 2_000_000
    assert page.count("<tr>") < 5_000
    assert "10,001 inputs" in page


def charts(page):
    drawn = re.findall(r"<svg.*?</svg>", page, re.DOTALL)
    return [ElementTree.fromstring(each) for each in drawn]


def test_bars_are_as_long_as_their_values():
    bars = '{% for part in parts %}{{ m.bar(loop.index0, "a", part, "40", "") }}{% endfor %}'
    (chart,) = charts(f"<svg>{rendered(bars, parts=(1.0, 0.25, 0.0))}</svg>")
    widths = [float(rect.get("width")) for rect in chart.iter("rect")]
    assert widths[0] == pytest.approx(4 * widths[1], abs=0.2)
    assert widths[2] <= 1.0


def test_the_trend_is_drawn_to_scale():
    nights = [Night("1", passed=9, rejected=1), Night("2", passed=8, rejected=2)]
    nights += [Night("3"), Night("4", passed=10)]
    (chart,) = charts(trend(nights))
    heights = [float(dot.get("cy")) for dot in chart.iter("circle")]
    assert len(heights) == 3
    bottom, _, top = [float(line.get("y1")) for line in chart.iter("line")][:3]
    least, most = (
        next(text.text for text in chart.iter("text") if float(text.get("y")) == y + 4)
        for y in (bottom, top)
    )
    assert (least, most) == ("70 %", "100 %")
    wanted = [top + (bottom - top) * short / 0.3 for short in (0.1, 0.2, 0.0)]
    assert heights == pytest.approx(wanted, abs=0.1)
    title = next(dot.find("title").text for dot in chart.iter("circle"))
    assert title == "1: 90.0 %; 9 passed, 1 rejected, 0 unjudged"
    bar = [float(rect.get("height")) for rect in chart.iter("rect")]
    assert bar[0] == pytest.approx(9 * bar[1], abs=0.1)


def test_one_night_is_no_trend_and_many_are_cut():
    assert trend([Night("1", passed=1)]).strip() == ""
    (chart,) = charts(trend([Night(f"{n:04d}", passed=n % 7 + 1) for n in range(400)]))
    assert len(list(chart.iter("circle"))) == NIGHTS
    assert len(list(chart.iter("text"))) < 20


def test_all_nights_are_listed_the_last_first():
    second = night("2", [attempt("a", "rejected")], state="out_of_time")
    page = nights_page((night("1", [attempt("a")]), second))
    pages = [target for target in Page(page).links if "index.html" in target]
    assert pages == ["2/index.html", "1/index.html"]
    assert "−100.0 points" in page
    assert "out of time" in page
