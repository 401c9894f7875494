"""A report says what it says the same way every time, and survives a round trip."""

import json
import re
from pathlib import Path

import pytest

from asset_factory.sim_checks import Finding, Report, Severity, Status
from asset_factory.sim_checks.checks.cause import Cause

#: How to read a report.
PAGE = (Path(__file__).parents[2] / "docs" / "reports.md").read_text(encoding="utf-8")

HARD = Finding(
    "rest_penetration", Severity.ERROR, "5 mm", parts=("a", "b"), value=5.0, unit="mm", limit=2.0
)
SOFT = Finding("loader_warning", Severity.WARNING, "hm", simulator="sapien", joint="hinge")
CRASH = Finding("simulator_crashed", Severity.ERROR, "killed by SIGSEGV", simulator="pybullet")


@pytest.mark.parametrize(
    ("findings", "passed", "judged"),
    [
        ((), True, True),
        ((SOFT,), True, True),
        ((SOFT, HARD), False, True),
        ((CRASH,), False, False),
        ((CRASH, HARD), False, True),
    ],
)
def test_only_hard_findings_decide(findings, passed, judged):
    report = Report("a.urdf", findings=findings)
    assert (report.passed, report.status is not Status.UNJUDGED) == (passed, judged)


def test_the_json_has_the_promised_keys_and_returns():
    report = Report("a.urdf", ("sapien",), (HARD, SOFT), {"joints": {"hinge": 1.0}})
    data = json.loads(report.to_json())
    assert list(data["findings"][0]) == [
        "code", "severity", "message", "simulator", "joint", "parts", "value", "unit", "limit",
        "cause", "joints",
    ]  # fmt: skip
    assert Report.from_dict(data) == report
    assert Report.from_dict(data).to_json() == report.to_json()


def test_a_number_that_json_has_no_word_for_is_refused():
    with pytest.raises(ValueError, match="Out of range float"):
        Report("a.urdf", measurements={"x": float("nan")}).to_json()


def test_the_pages_example_is_a_report_with_every_key():
    example = json.loads(re.search(r"```json\n(.*?)```", PAGE, re.DOTALL)[1])
    assert Report.from_dict(example).to_dict() == example


def test_the_page_names_every_cause():
    rows = re.findall(r"^\| `([a-z_]+)` \|", PAGE, re.MULTILINE)
    assert {str(cause) for cause in Cause} <= set(rows)
