"""The fault corpus: every broken exhibit is caught by its own code, every sound one passes."""

import warnings

import pytest
from fault_corpus.collection import blind_spots, broken, good
from fault_corpus.exhibits import ENGINES

from asset_factory.sim_checks import Report, Status
from asset_factory.sim_checks.config import CheckConfig
from asset_factory.sim_checks.description import DescriptionError
from asset_factory.sim_checks.judge import Judge, examine_here

GOOD = good()
BROKEN = broken()
ON_PAPER = [exhibit for exhibit in BROKEN if exhibit.expected("static")]
NOT_FINITE = [exhibit for exhibit in ON_PAPER if (exhibit.code or "").endswith("_not_finite")]
IN_ENGINES = [exhibit for exhibit in BROKEN if any(exhibit.expected(engine) for engine in ENGINES)]


def named(exhibits):
    return pytest.mark.parametrize("exhibit", exhibits, ids=[exhibit.name for exhibit in exhibits])


def told(report, detector):
    """Code -> severity of one detector's findings, the hardest of each code."""
    whose = None if detector == "static" else detector
    found = [item for item in report.findings if item.simulator == whose]
    found.sort(key=lambda item: item.severity, reverse=True)
    return {item.code: str(item.severity) for item in found}


def on_paper(path):
    """The same from the static checks, in this process."""
    try:
        with warnings.catch_warnings():
            # The child that looks for users shows no warnings either; what counts is what is found.
            warnings.simplefilter("ignore", RuntimeWarning)
            findings = examine_here(path, CheckConfig()).findings
    except DescriptionError as error:
        return {error.code: "error"}
    return told(Report(path.name, (), findings), "static")


@named(ON_PAPER)
def test_a_fault_on_paper_is_caught_by_its_own_code(exhibit, tmp_path):
    assert on_paper(exhibit.build(tmp_path)).get(exhibit.code or "") == exhibit.severity


@named(IN_ENGINES)
def test_a_fault_in_an_engine_is_caught_by_its_own_code(exhibit, tmp_path, judge):
    report = judge.check(exhibit.build(tmp_path), ENGINES)
    for engine in ENGINES:
        code = exhibit.expected(engine)
        if code is not None:
            severity = "error" if engine in exhibit.engines else exhibit.severity
            assert told(report, engine).get(code) == severity, (engine, report.findings)
    assert report.passed != exhibit.rejected


@named(NOT_FINITE)
def test_a_number_that_is_not_finite_gives_a_verdict_in_every_engine_too(exhibit, tmp_path, judge):
    report = judge.check(exhibit.build(tmp_path), ENGINES)
    assert report.errors[0].code == exhibit.code
    assert report.status is not Status.UNJUDGED
    assert exhibit.code in report.to_json()


@named(GOOD)
def test_what_is_sound_passes_on_paper_and_in_every_engine(exhibit, tmp_path, judge):
    assert judge.check(exhibit.build(tmp_path), ENGINES).errors == ()


@named(blind_spots())
def test_a_known_blind_spot_is_still_one(exhibit, tmp_path, judge):
    """When the judge learns to see one, it moves to the other exhibits."""
    assert judge.check(exhibit.build(tmp_path), ENGINES).passed == (exhibit.code is not None)


@pytest.mark.parametrize("name", ["fronts_overlap.urdf", "knuckle.mjcf"])
def test_a_report_depends_on_neither_place_nor_what_was_judged_before(name, tmp_path, judge):
    exhibit = next(item for item in (*GOOD, *BROKEN) if item.name == name)
    texts = []
    for folder in ("here", "there"):
        (tmp_path / folder).mkdir()
        with Judge() as fresh:
            asked = judge if folder == "here" else fresh
            texts.append(asked.check(exhibit.build(tmp_path / folder), ENGINES).to_json())
    assert texts[0] == texts[1]
    assert str(tmp_path) not in texts[0]
