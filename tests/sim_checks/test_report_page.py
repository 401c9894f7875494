"""The page on how to read a report shows what a report is."""

import json
import re
from pathlib import Path

import pytest

from asset_factory.sim_checks import Report
from asset_factory.sim_checks.checks.cause import Cause

PAGE = Path(__file__).parents[2] / "docs" / "reports.md"


@pytest.fixture
def page():
    return PAGE.read_text(encoding="utf-8")


def test_its_example_is_a_report_with_every_key(page):
    example = json.loads(re.search(r"```json\n(.*?)```", page, re.DOTALL)[1])
    assert Report.from_dict(example).to_dict() == example


def test_it_names_every_cause(page):
    rows = re.findall(r"^\| `([a-z_]+)` \|", page, re.MULTILINE)
    assert {str(cause) for cause in Cause} <= set(rows)
