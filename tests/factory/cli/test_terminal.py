"""Nothing that stands in a file steers a terminal: not its name, not a name in it."""

import io
import json
import os
import re

import pytest
from laid import laid
from rich.progress import Progress
from rich.table import Table

from asset_factory.factory.cli.commands import run
from asset_factory.factory.runtime.terminal import Terminal, complain, one_line, printable, say

HOSTILE = "\x1b]0;pwn\x07\x1b[2J\x9b31m\u202egnp.\udcff"
SHOWN = r"\x1b]0;pwn\x07\x1b[2J\x9b31m\u202egnp.\udcff"
#: What Rich writes by itself: colours, and the cursor of a bar.
OF_RICH = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")


def steers(text):
    return any(not (letter.isprintable() or letter in "\n\r") for letter in text)


@pytest.mark.parametrize("text", ["plain", "Küche, größer", "two\nlines\tand a tab", "櫃子 │ ━"])
def test_what_is_seen_stays(text):
    assert printable(text) == text


def test_what_is_not_seen_is_escaped(capsys):
    assert printable(HOSTILE) == SHOWN
    assert one_line("a\n[2/2] passed: b") == "a [2/2] passed: b"
    say(HOSTILE)
    complain(HOSTILE)
    assert capsys.readouterr() == (f"{SHOWN}\n", f"{SHOWN}\n")


def test_richs_own_colours_and_bars_stay(monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    stream = io.StringIO()
    terminal = Terminal(file=stream, force_terminal=True, color_system="standard", width=200)
    table = Table("[red]name[/]")
    table.add_row(HOSTILE.replace("[", r"\["))
    terminal.print(table, HOSTILE, markup=False)
    with Progress(console=terminal) as progress:
        progress.update(progress.add_task(HOSTILE, total=1), advance=1)
    written = stream.getvalue()
    assert OF_RICH.search(written)
    assert not steers(OF_RICH.sub("", written))
    assert written.count(r"\x1b]0;pwn") >= 3


@pytest.mark.parametrize("more", [[], ["--json"], ["--quiet"]])
def test_a_hostile_files_name_does_not_reach_the_terminal(tmp_path, capfd, more):
    name = "\x1b]0;pwn\x07\n\x1b[2J.obj"
    folder = laid(tmp_path / "in" / name, "no mesh").parent
    os.symlink("/etc/passwd", folder / "\x1b[31mout.obj")
    arguments = ["build", "--input", str(folder), "--output", str(tmp_path / "out"), *more]
    run([*arguments, "--sim", "sapien", "--no-report"])
    out, error = capfd.readouterr()
    if more == ["--json"]:
        assert json.loads(out)["rejected"] == 1
    assert "out.obj" in error
    run(["list", "--output", str(tmp_path / "out")])
    assert not steers(out + error + "".join(capfd.readouterr()))


def test_names_in_a_description_do_not_reach_the_terminal(tmp_path, capfd):
    # An XML character reference cannot name an escape; these come through all the same.
    name = "a\x85b\u009b2J\u202e"
    text = f'<robot name="r"><link name="{name}"/><link name="{name}"/></robot>'
    run(["check", str(laid(tmp_path / "\x1b[2J.urdf", text)), "--sim", "sapien"])
    run(["check", str(tmp_path / "\x1b[3J.urdf")])
    out, error = capfd.readouterr()
    assert r"a\x85b\x9b2J" in out
    assert not steers(out + error)
