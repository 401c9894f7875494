"""The table of what a robot opened."""

from asset_factory.envs.solving import printing
from asset_factory.factory.runtime.terminal import Terminal

ID = f"{'long_' * 16}-657fead206"
ROW = {
    "joint": "drawer_2_slide",
    "robot": "panda",
    "open_fraction": 0.97,
    "kinds": ["pull"],
    "steps": 214,
    "peak_force_n": 31.0,
    "mean_force_n": 8.2,
    "solved": True,
}


def test_ids_are_whole_in_80_columns(capsys, monkeypatch):
    monkeypatch.setattr(printing, "Terminal", lambda: Terminal(width=80))
    printing.print_table({ID: [ROW], "chest-1": [ROW]})
    lines = capsys.readouterr().out.splitlines()
    assert {ID, "chest-1"} <= set(lines)
    assert sum("drawer_2_slide" in line and "97%" in line for line in lines) == 2
