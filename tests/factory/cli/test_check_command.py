"""`factory check` judges files and folders, and tells it at once, in forms of other tools too."""

import json
import re
import threading
from pathlib import Path

import defusedxml.ElementTree
import jsonschema
import pytest
from box_world import write_drawer
from repository import ROOT

import asset_factory
from asset_factory.factory.cli import console
from asset_factory.factory.cli.check_formats import FORMATS, as_github, page_of
from asset_factory.factory.cli.commands import run
from asset_factory.sim_checks import Disagreement, Finding, Report, Severity
from asset_factory.sim_checks.judge import Judge

DOCS = ROOT / "docs"
HOSTILE = "a|b::error::%\n</failure>]]>\x1b\x00 `<b>`"


@pytest.fixture
def bad(tmp_path):
    """A drawer that lies 4 mm deep in its shell."""
    return write_drawer(tmp_path / "asset.urdf", -0.004)


def test_a_folder_is_judged_file_by_file_with_its_path_as_the_name(tmp_path, capsys):
    good = write_drawer(tmp_path / "good" / "asset.urdf", 0.004)
    write_drawer(tmp_path / "bad" / "asset.urdf", -0.004)
    (tmp_path / "notes.xml").write_text("<notes/>")
    assert run(["check", str(tmp_path), "--sim", "", "--json", str(tmp_path / "report.json")]) == 0
    reports = json.loads((tmp_path / "report.json").read_text())
    told = [(each["description"], each["passed"]) for each in reports]
    assert told == [("bad/asset.urdf", False), ("good/asset.urdf", True)]
    lines = capsys.readouterr().out.splitlines()
    heads = [line.split(" (")[0] for line in lines[:-1] if not line.startswith(" ")]
    assert heads == ["rejected bad/asset.urdf", "passed good/asset.urdf"]
    assert lines[-1].startswith("2 files: 1 passed, 1 rejected, 0 could not be validated; 1 error")
    # Of one file there is one report, and no other output.
    assert run(["check", str(good), "--sim", "", "--json", "-"]) == 0
    report = json.loads(capsys.readouterr().out)
    told = (report["description"], report["passed"], report["disagreements"])
    assert told == ("asset.urdf", True, [])


def test_reports_are_printed_as_they_come(tmp_path, monkeypatch):
    files = [write_drawer(tmp_path / f"{name}.urdf", 0.004) for name in ("one", "two")]
    printed = threading.Event()
    check = Judge.check
    print_report = console.print_report

    def watched(judge, path, *rest):
        assert path.stem == "one" or printed.wait(60.0)
        return check(judge, path, *rest)

    def noted(*told, verbose):
        print_report(*told, verbose=verbose)
        printed.set()

    monkeypatch.setattr(Judge, "check", watched)
    monkeypatch.setattr(console, "print_report", noted)
    assert run(["check", *map(str, files), "--sim", "", "--workers", "1"]) == 0


def test_every_simulator_at_once_and_who_disagrees(tmp_path, capsys):
    path = write_drawer(tmp_path / "asset.urdf", -0.01)
    assert run(["check", str(path), "--sim", "all", "--strict"]) == 1
    out = capsys.readouterr().out
    assert "(sapien, mujoco, pybullet)" in out
    told = r"disagree whether 'slide' opens: sapien pass \(100% of range\), mujoco jammed .* "
    assert re.search(told + "PhysX never collides", out)


def test_joints_of_which_engines_say_the_same_are_told_in_one_line(capsys):
    verdicts = {"sapien": "pass", "pybullet": "jammed"}
    joints = [("a", verdicts), ("b", verdicts), ("c", {**verdicts, "pybullet": "not_finite"})]
    values = {"sapien": 1.0, "pybullet": 0.04}
    told = tuple(Disagreement("opens", *each, values, "of range", "why") for each in joints)
    report = Report("asset.urdf", ("sapien", "pybullet"), (), {}, told)
    for verbose, lines in ((False, 2), (True, 3)):
        console.print_report(report, verbose=verbose)
        said = [line for line in capsys.readouterr().out.splitlines() if "disagree" in line]
        assert len(said) == lines
        assert ("(so for 1 more joint)" in said[0]) is not verbose
        assert "sapien pass (100% of range), pybullet jammed (4% of range)" in said[0]


def test_many_files_are_judged_at_once_and_told_in_the_order_given(tmp_path, monkeypatch, capsys):
    names = ["one", "two", "three"]
    files = [write_drawer(tmp_path / f"{name}.urdf", 0.004) for name in names]
    both = threading.Barrier(2)
    second_done = threading.Event()
    judges = set()
    check = Judge.check

    def watched(judge, path, *rest):
        judges.add(id(judge))
        if path.stem != "three":
            both.wait(60.0)
        if path.stem == "one":
            assert second_done.wait(60.0)
        report = check(judge, path, *rest)
        if path.stem == "two":
            second_done.set()
        return report

    monkeypatch.setattr(Judge, "check", watched)
    assert run(["check", *map(str, files), "--sim", "", "--workers", "2"]) == 0
    told = capsys.readouterr()
    assert all(f"checking {path} (" in told.err for path in files)
    lines = [line for line in told.out.splitlines()[:-1] if not line.startswith(" ")]
    assert [line.split(" (")[0] for line in lines] == [f"passed {name}.urdf" for name in names]
    assert len(judges) == 2


MJCF = """<mujoco><worldbody><body name="shell">{0}<body name="drawer"><joint name="slide"
type="slide" axis="1 0 0" range="0 {2}"/>{1}</body></body></worldbody></mujoco>"""
GEOM = '<geom type="box" size="0.2 0.1 0.1" pos="0 {0} 0" mass="1"/>'


def mjcf_beside(urdf, upper):
    path = urdf.with_suffix(".xml")
    path.write_text(MJCF.format(GEOM.format(0), GEOM.format(0.204), upper))
    return path


@pytest.mark.parametrize(("upper", "code"), [(0.3, 0), (0.2, 3)])
def test_a_format_that_no_engine_reads_is_judged_by_the_file_beside_it_that_says_the_same(
    tmp_path, capsys, upper, code
):
    # Told before the file that speaks for it.
    mjcf_beside(write_drawer(tmp_path / "z.urdf", 0.004), upper).rename(tmp_path / "a.xml")
    assert run(["check", str(tmp_path), "--sim", "sapien"]) == code
    out = capsys.readouterr().out
    assert ("note simulated_beside: " in out) is (code == 0)
    assert ("error not_simulated: " in out) is (code == 3)
    assert ("z.urdf, which has the same joints" in out) is (code == 0)


def test_findings_are_told_once_by_code_with_the_worst_first(bad, capsys):
    text = bad.read_text()
    first, second = (text.replace('axis xyz="1 0 0"', f'axis xyz="{n} 0 0"') for n in (2, 5))
    tray = second[second.index('<link name="drawer"') : second.index("</robot>")]
    tray = tray.replace("drawer", "tray").replace("slide", "other").replace("0.196", "0.5")
    bad.write_text(first.replace("</robot>", f"{tray}</robot>"))
    assert run(["check", str(bad), "--sim", ""]) == 0
    lines = [line.strip() for line in capsys.readouterr().out.splitlines()]
    axes = [line for line in lines if "axis_not_unit" in line]
    assert len(axes) == 1
    assert axes[0].startswith("error axis_not_unit (2 of them, the worst): joint 'other'")
    severities = [line.split()[0] for line in lines if line.split()[0] in ("error", "warning")]
    assert severities == sorted(severities)
    assert run(["check", str(bad), "--sim", "", "--verbose"]) == 0
    assert capsys.readouterr().out.count("error axis_not_unit: ") == 2


def test_what_the_urdf_was_told_for_is_not_told_again_of_the_mjcf(bad, tmp_path, capsys):
    path = mjcf_beside(bad, 0.3)
    path.write_text(path.read_text().replace("0.204", "0.196"))
    assert run(["check", str(tmp_path), "--sim", ""]) == 0
    out = capsys.readouterr().out
    assert out.count("rest_penetration") == 1
    assert "as in another file of this asset" in out
    assert "2 files: 0 passed, 2 rejected, 0 could not be validated; 1 error" in out


def test_only_what_the_baseline_does_not_know_fails(bad, tmp_path, capsys):
    known = str(tmp_path / "known.json")
    check = ["check", str(bad), "--sim", "", "--strict"]
    assert run(check) == 1
    assert run([*check, "--write-baseline", known]) == 0
    capsys.readouterr()
    assert run([*check, "--baseline", known]) == 0
    assert "rest_penetration" not in capsys.readouterr().out
    bad.write_text(bad.read_text().replace('axis xyz="1 0 0"', 'axis xyz="2 0 0"'))
    assert run([*check, "--baseline", known]) == 1
    assert re.findall(r"error (\w+)", capsys.readouterr().out) == ["axis_not_unit"]
    Path(known).write_text('{"version": 7}')
    assert run([*check, "--baseline", known]) == 2
    assert "no baseline" in capsys.readouterr().err


@pytest.fixture
def checked(bad):
    found = (
        Finding("friction_ignored", Severity.NOTE, "note", "sapien", joints=("slide",)),
        Finding("oblong_hull", Severity.WARNING, HOSTILE, parts=("drawer",), value=9.0, limit=6.0),
        Finding("jammed", Severity.ERROR, "stuck", "mujoco", "slide", value=0.5, limit=0.95),
        Finding("jammed", Severity.ERROR, "worse", "sapien", "slide", value=0.1, limit=0.95),
    )
    return [(str(bad), Report("asset.urdf", ("sapien",), found))]


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


def test_every_format_is_printed_alone(bad, tmp_path, capsys):
    check = ["check", str(bad), "--sim", "", "--format"]
    for form in FORMATS:
        assert run([*check, form, "--strict"]) == 1
        out = capsys.readouterr().out
        assert "rest_penetration" in out
        assert not out.startswith("rejected")
    assert run([*check, f"json,markdown={tmp_path}/a.md,junit={tmp_path}/a.xml"]) == 0
    assert json.loads(capsys.readouterr().out)["passed"] is False
    assert "rest_penetration" in (tmp_path / "a.md").read_text()
    assert "rest_penetration" in (tmp_path / "a.xml").read_text()


def test_reports_keep_to_their_schema_and_codes_have_their_place(bad):
    schema = json.loads((DOCS / "report.schema.json").read_text())
    validator = jsonschema.Draft202012Validator(schema)
    validator.check_schema(schema)
    report = asset_factory.check(bad, simulators=())
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
