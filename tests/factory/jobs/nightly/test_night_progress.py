"""How far a night says it is."""

from asset_factory.factory.jobs.nightly import work
from asset_factory.factory.registry import Entry
from asset_factory.factory.registry.result import Result


def test_the_pace_is_of_the_last_minutes():
    assert work.pace([(0.0, 0), (60.0, 0)], 100) == "0 of 100"
    told = work.pace([(100.0, 40), (160.0, 50)], 80)
    assert told == "50 of 80, 10.0 a minute, about 3 min 00 s left"


def test_a_night_without_a_terminal_says_how_far_it_is(monkeypatch, capsys):
    entries = [Entry(f"a{n}", "a", "", "passed", "", 1, 1, 1) for n in range(3)]
    results = [Result(f"meshes/{entry.id}.glb", entry) for entry in entries]
    assert list(work.followed(iter(results), 3)) == results
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(work, "EVERY_S", 0.0)
    assert list(work.followed(iter(results), 3)) == results
    said = capsys.readouterr().err.splitlines()
    assert [line.split(",")[0] for line in said] == ["1 of 3", "2 of 3", "3 of 3"]
