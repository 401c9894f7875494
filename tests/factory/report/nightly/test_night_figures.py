"""Counts, shares, changes and exit codes, in closed form."""

from dataclasses import replace
from pathlib import PurePath

import pytest
from hypothesis import given
from hypothesis import strategies as st
from nights_made import attempt, night

from asset_factory.factory.report.nightly.figures import (
    Changes,
    SourceRules,
    compare,
    licenses,
    reasons,
    slowest,
    source_yields,
    stage_times,
)
from asset_factory.factory.report.nightly.formats import clock_span, percent, points
from asset_factory.factory.report.nightly.night import latest, night_from, night_to, tally
from asset_factory.factory.report.nightly.outcome import FailureRules, concerns, exit_code
from asset_factory.factory.report.nightly.report import NightlyReport, message, summary


def codes(now, before, rules, **more):
    """The exit code of a night after another one, and that of each of its concerns."""
    report = NightlyReport(night("2", now, **more), night("1", before))
    found = list(concerns(replace(report, changes=compare(before, now)), rules))
    return exit_code(found), [concern.exit_code for concern in found]


OF_TEN = [attempt(f"a{i}") for i in range(8)] + [attempt("b", "rejected"), attempt("c", "unjudged")]


def test_figures_count_what_could_not_be_judged_as_not_passed_and_survive_storing():
    figures = night("7", OF_TEN, seconds=12.5, verified=8, damaged=1, exit_code=4)
    assert (figures.passed, figures.rejected, figures.unjudged, figures.attempted) == (8, 1, 1, 10)
    assert figures.yielded == 0.8
    assert night("1").yielded is None
    data = night_to(figures)
    assert data["yield"] == 0.8
    assert night_from({**data, "of_a_later_version": 3}) == figures
    assert night_from({"name": "old"}).attempted == 0
    with pytest.raises(ValueError, match="passed"):
        night_from({**data, "passed": "<script>"})
    with pytest.raises(ValueError, match="name"):
        night_from({})


@given(
    st.lists(
        st.tuples(
            st.integers(0, 9), st.sampled_from(["passed", "rejected", "unjudged"]), st.booleans()
        )
    )
)
def test_every_input_counts_once(rows):
    attempts = latest(
        attempt(f"a{n}", status, attempts=0 if known else 1) for n, status, known in rows
    )
    assert [a.input for a in attempts] == sorted({f"meshes/a{n}.glb" for n, _, _ in rows})
    counts = tally(attempts)
    assert counts["passed"] + counts["rejected"] + counts["unjudged"] == len(attempts)


def test_a_night_that_goes_on_keeps_the_true_times():
    first = attempt("a", seconds=40.0)
    assert latest([first, attempt("a", seconds=0.01, attempts=0)]) == (first,)
    other = attempt("a", "rejected", seconds=0.01, attempts=0)
    assert latest([first, other]) == (other,)
    anew = attempt("a", seconds=35.0)
    assert latest([first, anew]) == (anew,)


def test_changes_against_the_night_before():
    before = [attempt(name) for name in ("same", "broke", "gone", "edited")]
    before += [attempt("mended", "rejected")]
    before += [attempt("worse", "rejected"), attempt("crashed")]
    now = [attempt("same"), attempt("broke", "rejected")]
    now += [attempt("mended"), attempt("new", "rejected")]
    now += [
        attempt("edited", "rejected", digest="bbbbbbbbbb"),
        attempt("worse", "rejected", reason="too_large"),
    ]
    now += [attempt("crashed", "unjudged")]
    changes = compare(before, now)
    failing = [f"meshes/{name}.glb" for name in ("broke", "edited", "crashed")]
    assert [change.now.input for change in changes.failing] == failing
    assert [c.same_content for c in changes.failing] == [True, False, True]
    assert [c.now.input for c in changes.passing] == ["meshes/mended.glb"]
    assert [c.now.reason for c in changes.other] == ["too_large"]
    assert (changes.shared, changes.passed_before, changes.passed_now) == (6, 4, 2)
    assert [a.id for a in changes.fresh] == ["new-aaaaaaaaaa"]
    assert [a.id for a in changes.gone] == ["gone-aaaaaaaaaa"]
    # An input that was moved is the same input.
    moved = replace(attempt("a", "rejected"), input="elsewhere/a.glb")
    changes = compare([attempt("a")], [moved])
    assert (len(changes.failing), changes.fresh, changes.gone) == (1, (), ())


def test_the_first_night_has_nothing_to_compare_with():
    changes = compare([], OF_TEN)
    assert len(changes.fresh) == 10
    assert not changes.failing
    report = NightlyReport(night("1", OF_TEN[:9]), changes=changes)
    assert list(concerns(report, FailureRules())) == []


WELL = [*OF_TEN[:8], attempt("d"), attempt("e")]
WORSE = [*OF_TEN[:9], attempt("d", "rejected")]
NEW = [*WELL, *(attempt(f"new{i}", "rejected") for i in range(10))]
KNOWN_TO_CRASH = attempt("f", "unjudged", reason="crashed", attempts=0)
ANY_YIELD = FailureRules(yield_drop=1.0)


@pytest.mark.parametrize(
    ("now", "more", "failure", "code", "each"),
    [
        (WELL, {}, FailureRules(), 0, []),
        (OF_TEN, {}, ANY_YIELD, 3, [3]),
        (OF_TEN, {}, replace(ANY_YIELD, unjudged=False), 0, [0]),
        (WELL, {"damaged": 1}, FailureRules(), 4, [4]),
        (WELL, {"damaged": 1}, FailureRules(damage=False), 0, [0]),
        (WELL, {"damaged": 2, "mended": 2}, FailureRules(), 0, [0]),
        (WELL, {"damaged": 2, "mended": 1, "withdrawn": 1}, FailureRules(), 4, [4]),
        (WORSE, {}, FailureRules(), 5, [5, 0]),
        (WORSE, {}, FailureRules(yield_drop=0.2), 0, [0]),
        # Inputs that are new are no fall of what both nights had.
        (NEW, {}, FailureRules(over="all"), 5, [5]),
        (NEW, {}, FailureRules(over="shared"), 0, []),
        ([*WELL, KNOWN_TO_CRASH], {}, ANY_YIELD, 0, [0]),
        ([*WELL, replace(KNOWN_TO_CRASH, attempts=1)], {}, ANY_YIELD, 3, [3]),
        (OF_TEN, {"damaged": 1}, FailureRules(), 4, [4, 5, 3]),
        (OF_TEN, {}, FailureRules(), 5, [5, 3]),
        (OF_TEN, {"damaged": 1, "state": "interrupted"}, FailureRules(), 130, [130, 4, 5, 3]),
        (WELL, {"state": "out_of_time", "waiting": 3}, FailureRules(), 0, [0]),
    ],
)
def test_the_worst_concern_is_the_exit_code_and_the_first(now, more, failure, code, each):
    assert codes(now, WELL, failure, **more) == (code, each)


def test_what_does_not_ring_is_said_too():
    report = NightlyReport(night("1", [*WELL, KNOWN_TO_CRASH], damaged=2, mended=2, withdrawn=0))
    assert [item.sentence for item in concerns(report, FailureRules())] == [
        "Damaged: 2 registered assets; the files were not what was registered: 2 made whole again.",
        "Known to crash: 1 input; another version of anything tries them again.",
    ]


@pytest.mark.parametrize("drop", [0.05, 0.1, 0.3, 0.7])
def test_a_fall_of_exactly_what_is_allowed_is_allowed(drop):
    before = [attempt(f"a{i}") for i in range(100)]
    for more, code in ((0, 0), (1, 5)):
        fallen = round(100 * drop) + more
        now = [attempt(f"a{i}", "rejected" if i < fallen else "passed") for i in range(100)]
        assert codes(now, before, FailureRules(yield_drop=drop))[0] == code


def test_reasons_are_counted_with_an_example_that_has_a_sentence():
    attempts = [attempt("a", "rejected", message=""), attempt("b", "rejected")]
    attempts += [attempt("c", "unjudged"), attempt("d")]
    found = reasons(attempts)
    told = [(each.code, each.status, each.count) for each in found]
    assert told == [("jammed", "rejected", 2), ("build_crashed", "unjudged", 1)]
    assert found[0].message == "b is jammed"


def test_stages_and_the_slowest_leave_out_what_was_known():
    attempts = [
        attempt("a", seconds=3.0, stages={"load": 1.0, "validate": 2.0}),
        attempt("b", seconds=9.0, stages={"load": 4.0, "validate": 5.0}),
        attempt("c", seconds=99.0, attempts=0, stages={"load": 99.0}),
        attempt("d", "rejected", seconds=1.0, stages={"load": 1.0}),
    ]
    stages = stage_times(attempts)
    told = [(each.stage, each.seconds, each.median, each.inputs) for each in stages]
    assert told == [("validate", 7.0, 3.5, 2), ("load", 6.0, 1.0, 3)]
    assert stages[0].slowest == "b-aaaaaaaaaa"
    assert [a.id for a in slowest(attempts, 2)] == ["b-aaaaaaaaaa", "a-aaaaaaaaaa"]


def test_licenses_are_counted_by_verdict():
    free = {"license": "CC0-1.0"}
    attempts = [attempt("a", **free), attempt("b", "rejected", **free), attempt("c", "unjudged")]
    found = licenses(attempts)
    counted = [(each.license, each.passed, each.rejected, each.unjudged) for each in found]
    assert counted == [("CC0-1.0", 1, 1, 0), ("", 0, 0, 1)]


def test_the_message_is_one_line():
    before = night("1", WELL)
    figures = night("2", OF_TEN, seconds=15127.0, damaged=1)
    told = message(NightlyReport(figures, before, tuple(OF_TEN), compare(WELL, OF_TEN)))
    assert told == (
        "Night 2: 8 of 10 inputs passed (80.0 %, −20.0 points), "
        "1 rejected, 1 unjudged, 1 DAMAGED; 4 h 12 min."
    )
    interrupted = NightlyReport(night("3", state="interrupted"))
    assert message(interrupted) == "Night 3 [interrupted]: 0 of 0 inputs passed; 0 s."


def test_the_summary_holds_what_the_page_shows():
    changes = compare(WELL, OF_TEN)
    data = summary(NightlyReport(night("2", OF_TEN), night("1", WELL), tuple(OF_TEN), changes))
    assert data["night"]["yield"] == 0.8
    assert data["against"]["night"] == "1"
    counted = [(each["code"], each["count"]) for each in data["reasons"]]
    assert counted == [("build_crashed", 1), ("jammed", 1)]
    nothing = dict.fromkeys(("night", "yield_before", "yield_now"))
    nothing |= {"shared": 0, "fresh": 0, "gone": 0, "newly_failing": [], "newly_passed": []}
    assert summary(NightlyReport(night("1")))["against"] == nothing
    assert changes != Changes()


def test_numbers_are_never_rounded_to_what_they_are_not():
    assert percent(1.0) == "100 %"
    assert percent(9999 / 10000) == "over 99.9 %"
    assert percent(0.0) == "0 %"
    assert percent(1 / 10000) == "under 0.1 %"
    assert percent(0.873) == "87.3 %"
    assert percent(None) == "–"
    assert points(0.5, 0.5001) == "unchanged"
    assert points(0.9, 0.85) == "−5.0 points"
    assert points(None, 0.85) == ""


@given(st.floats(0.0, 1e6))
def test_spans_of_time_never_lose_an_hour(seconds):
    told = clock_span(seconds)
    numbers = [int(word) for word in told.replace(",", "").split() if word.isdecimal()]
    units = [word for word in told.split() if not word.replace(",", "").isdecimal()]
    sizes = {"h": 3600, "min": 60, "s": 1}
    assert abs(sum(n * sizes[u] for n, u in zip(numbers, units, strict=True)) - seconds) <= 30.5


ROOTS = (PurePath("meshes"), PurePath("meshes/inner"), PurePath("/single.glb"))


def attempts(passed, rejected, folder=""):
    names = [f"{folder}{number}" for number in range(passed + rejected)]
    return [attempt(n, "passed" if i < passed else "rejected") for i, n in enumerate(names)]


def yields(now, earlier, rules=None):
    return source_yields(now, ROOTS, [{"meshes": each} for each in earlier], rules or SourceRules())


def test_an_input_belongs_to_the_innermost_root_above_it():
    given = [attempt("a"), attempt("inner/b"), attempt("inner/c", "rejected")]
    given += [replace(attempt("d"), input="/single.glb")]
    found = source_yields(given, ROOTS, (), SourceRules())
    counted = [(each.source, each.passed, each.tried) for each in found]
    assert counted == [("/", 1, 1), ("meshes", 1, 1), ("meshes/inner", 1, 2)]


@pytest.mark.parametrize(
    ("now", "earlier", "fell"),
    [
        ((80, 20), [(90, 100)] * 3, False),
        ((79, 21), [(90, 100)] * 3, True),
        ((79, 21), [(90, 100)] * 2, False),
        ((79, 21), [(90, 100), (5, 10), (90, 100)], False),
        ((3, 16), [(90, 100)] * 3, False),
        # One bad night is not what is usual, fourteen are.
        ((79, 21), [(90, 100)] * 10 + [(10, 100)], True),
        ((79, 21), [(90, 100)] * 10 + [(80, 100)] * 14, False),
        # A point a night, of which none is a fall against the night before.
        ((70, 30), [(100 - number, 100) for number in range(30)], False),
        ((64, 36), [(100 - 2 * number, 100) for number in range(18)], True),
    ],
)
def test_a_fall_below_the_median_of_the_last_nights_counts(now, earlier, fell):
    (source,) = yields(attempts(*now), earlier)
    assert source.fell is fell


def test_nothing_is_compared_where_that_is_not_wanted():
    (source,) = yields(attempts(10, 90), [(90, 100)] * 9, SourceRules(nights=0))
    assert (source.usual, source.fell) == (None, False)
