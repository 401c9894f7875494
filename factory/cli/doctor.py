"""``factory doctor``: what works on this machine, and what to install for the rest."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path

from rich.markup import escape

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
    """Folder that assets are to go to, for its free space."""


def run(command: Doctor) -> int:
    """Try everything; returns the exit code."""
    from asset_factory.sim_checks.simulators.catalog import SIMULATORS

    from ..report.machine import Health, abilities

    found = []
    shown = console.terminal()
    if not command.json:
        say("Every engine and library is tried, which takes up to a minute.")
    for each in abilities(command.output):
        found.append(each)
        if not command.json:
            state = f"[{STYLE[each.health]}]{each.health:8}[/]"
            told = f"{state}{each.name:11}{escape(each.detail)} [dim]({escape(each.serves)})[/]"
            shown.print(told, soft_wrap=True)
            if each.remedy:
                shown.print(f"{'':8}{escape(each.remedy)}", soft_wrap=True)
    if command.json:
        say(json.dumps([asdict(each) for each in found], indent=2))
    works = {each.name for each in found if each.health is Health.WORKS}
    return Exit.OK if works & set(SIMULATORS) else Exit.REJECTED
