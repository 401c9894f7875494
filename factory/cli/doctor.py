"""``factory doctor``: what works on this machine, and what to install for the rest."""

import json
from dataclasses import asdict, dataclass
from pathlib import Path

from rich.markup import escape
from rich.table import Table

from ..errors import Exit
from ..runtime.terminal import say
from . import console
from .flags import Printed

STYLE = {"works": "green", "missing": "yellow", "broken": "red"}


@dataclass(frozen=True)
class Doctor(Printed):
    """Try every engine and library that a build may need, and say what works on this machine.

    Exit codes: 0 a build can run: an engine works; 1 none does.

    Example: factory doctor --output out/
    """

    output: Path = Path()
    """Where assets are to go."""


def run(command: Doctor) -> int:
    """Try everything; returns the exit code."""
    from asset_factory.sim_checks.simulators.catalog import SIMULATORS

    from ..report.machine import Health, abilities

    found = tuple(abilities(command.output))
    if command.json:
        say(json.dumps([asdict(each) for each in found], indent=2))
    else:
        table = Table("", "for", "", "detail", "what would help")
        for each in found:
            state = f"[{STYLE[each.health]}]{each.health}[/]"
            texts = (each.detail, each.remedy)
            table.add_row(each.name, each.serves, state, *(escape(text) for text in texts))
        console.terminal().print(table)
    works = {each.name for each in found if each.health is Health.WORKS}
    return Exit.OK if works & set(SIMULATORS) else Exit.REJECTED
