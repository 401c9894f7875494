"""What people read: what was done, not once more what was known."""

import io
import time
from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

from registry_samples import REJECTED, named

from asset_factory.factory.cli import console
from asset_factory.factory.jobs.executor import UnderWay
from asset_factory.factory.registry.result import Result
from asset_factory.factory.report.summary import Summary


def results(known, built):
    """So many that were known, then so many that were built, the last of them rejected."""
    old = [Result(f"{number}.glb", named(f"old-{number}"), attempts=0) for number in range(known)]
    new = [Result(f"new_{number}.glb", named(f"new-{number}")) for number in range(built)]
    if new:
        new[-1] = Result("bad.glb", replace(REJECTED, id="bad"))
    return old + new


def test_what_was_known_is_counted_in_a_line(capsys):
    everything = results(3, 2)
    assert list(console.follow(iter(everything), 5)) == everything
    assert capsys.readouterr().err.splitlines() == [
        "3 of 5 inputs known from before",
        "[4/5] passed: new-0",
        "[5/5] rejected: bad: 5 mm deep",
    ]


def test_nothing_known_and_nothing_else_are_told_too(capsys):
    list(console.follow(iter(results(0, 1)), 1))
    assert capsys.readouterr().err.splitlines() == ["[1/1] rejected: bad: 5 mm deep"]
    list(console.follow(iter(results(4, 0)), 4))
    assert capsys.readouterr().err.splitlines() == ["4 of 4 inputs known from before"]
    list(console.follow(iter(()), 0))
    assert capsys.readouterr().err == ""


def test_rate_and_time_left_are_those_of_what_is_built():
    with patch.object(console.Progress, "update") as update:
        list(console.follow(iter(results(3, 2)), 6))
    told = [call.kwargs for call in update.call_args_list]
    assert (told[-1]["total"], sum(each["advance"] for each in told)) == (3, 2)


def test_a_night_without_a_terminal_says_how_far_it_is_by_the_pace_of_the_last_minutes(capsys):
    assert console.pace(0, 100, None) == "0 of 100"
    assert console.pace(50, 80, 10.0 / 60.0) == "50 of 80, 10.0 a minute, about 3 min 00 s left"
    for every_s, said in ((60.0, []), (0.0, ["1 of 3", "2 of 3", "3 of 3"])):
        assert len(list(console.follow(iter(results(1, 2)), 3, every_s=every_s))) == 3
        assert [line.split(",")[0] for line in capsys.readouterr().err.splitlines()] == said


def test_the_bar_says_what_is_at_work_and_after_one_input_how_long_the_rest_takes(monkeypatch):
    at_work = tuple(UnderWay(f"in/oven_{number}.glb", "solids") for number in range(5))
    told = console.Console(file=io.StringIO(), force_terminal=True, width=160)
    monkeypatch.setattr(console, "Terminal", lambda **_: told)
    seen = []

    def slowly():
        for number, result in enumerate(results(0, 3)):
            if number == 1:
                time.sleep(0.6)
            seen.append(told.file.getvalue())
            yield result

    list(console.follow(slowly(), 3, lambda: at_work))
    assert "about" not in seen[0]
    assert "about 0:00:" in told.file.getvalue()
    assert "oven_0.glb solids, oven_1.glb solids, oven_2.glb solids +2" in told.file.getvalue()


def test_a_long_table_leaves_out_what_was_known(capsys):
    console.print_results(Summary(tuple(results(console.LISTED - 1, 1))), Path("out"))
    assert "old-0" in capsys.readouterr().out
    console.print_results(Summary(tuple(results(console.LISTED, 1))), Path("out"))
    printed = capsys.readouterr().out
    assert "old-0" not in printed
    assert "bad" in printed
    assert f"{console.LISTED} known from before: in summary.json." in printed


def test_an_edit_is_offered_of_meshes_that_were_read(tmp_path, capsys):
    def told():
        console.print_results(Summary(tuple(rejected)), tmp_path)
        return capsys.readouterr().out

    bad = {name: replace(REJECTED, id=name) for name in ("a", "b", "c")}
    rejected = [Result("a.glb", bad["a"]), Result("b.urdf", bad["b"])]
    for name in ("b", "c"):
        (tmp_path / "rejected" / name).mkdir(parents=True)
        (tmp_path / "rejected" / name / "view.glb").touch()
    assert "factory edit" not in told()
    rejected.append(Result("c.glb", bad["c"]))
    assert f"factory edit {tmp_path}/rejected/c" in told()
