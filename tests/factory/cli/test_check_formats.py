"""Reports in the forms that other tools read: each holds every finding, and none breaks out."""

import json
from pathlib import Path

import defusedxml.ElementTree
import jsonschema
import pytest
from box_world import write_drawer

import asset_factory
from asset_factory.factory.cli.check_formats import FORMATS, as_github, page_of
from asset_factory.factory.cli.commands import run
from asset_factory.sim_checks import Finding, Report, Severity

DOCS = Path(__file__).resolve().parents[3] / "docs"
HOSTILE = "a|b::error::%\n</failure>]]>\x1b\x00 `<b>`"


@pytest.fixture
def drawer(tmp_path):
    """A drawer that lies 4 mm deep in its shell."""
    return write_drawer(tmp_path / "asset.urdf", -0.004)


@pytest.fixture
def checked(drawer):
    found = (
        Finding("friction_ignored", Severity.NOTE, "note", "sapien", joints=("slide",)),
        Finding("oblong_hull", Severity.WARNING, HOSTILE, parts=("drawer",), value=9.0, limit=6.0),
        Finding("jammed", Severity.ERROR, "stuck", "mujoco", "slide", value=0.5, limit=0.95),
        Finding("jammed", Severity.ERROR, "worse", "sapien", "slide", value=0.1, limit=0.95),
    )
    return [(str(drawer), Report("asset.urdf", ("sapien",), found))]


def test_sarif_names_code_level_file_and_line(checked):
    (sarif,) = json.loads(FORMATS["sarif"](checked))["runs"]
    assert [each["level"] for each in sarif["results"]] == ["note", "warning", "error", "error"]
    rules = {each["id"] for each in sarif["tool"]["driver"]["rules"]}
    assert rules == {"friction_ignored", "oblong_hull", "jammed"}
    prints = [each["partialFingerprints"]["place/v1"] for each in sarif["results"]]
    assert len(set(prints)) == 4
    Path(checked[0][0]).write_text('<robot>\n<link name="drawer"/>\n<joint name="slide"/></robot>')
    (sarif,) = json.loads(FORMATS["sarif"](checked))["runs"]
    places = [each["locations"][0]["physicalLocation"] for each in sarif["results"]]
    assert [each["region"]["startLine"] for each in places] == [3, 2, 3, 3]


def test_junit_fails_by_code(checked):
    (suite,) = defusedxml.ElementTree.fromstring(FORMATS["junit"](checked).encode())
    assert (suite.get("tests"), suite.get("failures")) == ("3", "1")
    failed = [case.get("name") for case in suite if case.find("failure") is not None]
    assert failed == ["jammed"]
    assert "stuck" in suite[0].find("failure").text
    clean = [(checked[0][0], Report("asset.urdf"))]
    (suite,) = defusedxml.ElementTree.fromstring(FORMATS["junit"](clean).encode())
    assert (suite.get("tests"), suite.get("failures")) == ("1", "0")


def test_github_has_errors_first_and_no_command_of_a_stranger(checked):
    *lines, total = as_github(checked).splitlines()
    assert [line.split(" ")[0] for line in lines] == ["::error", "::warning", "::notice"]
    assert "worse (2 of them, the worst)" in lines[0]
    assert page_of("jammed") in lines[0]
    assert "1 file: 0 passed, 1 rejected" in total


def test_markdown_is_a_table_that_nobody_breaks(checked):
    rows = [line for line in FORMATS["markdown"](checked).splitlines() if line.startswith("| ")]
    assert len(rows) == 4
    assert all(row.replace("\\|", "").count("|") == 5 for row in rows)
    assert "<b>" not in "".join(rows).replace("\\<", "")


def test_every_format_is_printed_alone(drawer, tmp_path, capsys):
    check = ["check", str(drawer), "--sim", "", "--format"]
    for form in FORMATS:
        assert run([*check, form, "--strict"]) == 1
        out = capsys.readouterr().out
        assert "rest_penetration" in out
        assert not out.startswith("rejected")
    assert run([*check, f"json,markdown={tmp_path}/a.md,junit={tmp_path}/a.xml"]) == 0
    assert json.loads(capsys.readouterr().out)["passed"] is False
    assert "rest_penetration" in (tmp_path / "a.md").read_text()
    assert "rest_penetration" in (tmp_path / "a.xml").read_text()


def test_reports_keep_to_their_schema_and_codes_have_their_place(drawer):
    schema = json.loads((DOCS / "report.schema.json").read_text())
    validator = jsonschema.Draft202012Validator(schema)
    validator.check_schema(schema)
    report = asset_factory.check(drawer, simulators=())
    data = json.loads(report.to_json())
    validator.validate(data)
    assert Report.from_dict(data) == report
    found = data["findings"][0]
    odd = ({**found, "extra": 1}, {**found, "severity": "hard"})
    wrong = ({"version": 1}, {"passed": "no"}, *({"findings": [each]} for each in odd))
    assert [each for each in wrong if validator.is_valid(data | each)] == []
    older = Report.from_dict({**data, "findings": odd[1:]})
    assert older.findings[0].severity is Severity.ERROR
    page = (DOCS / "reasons.md").read_text()
    assert all(f'id="{each.code}"' in page for each in report.findings)
