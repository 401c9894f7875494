"""Tables in the docs that the code itself knows, written between marks.

python docs/generate.py            write them anew
python docs/generate.py --check    exit code 1 where a page is not as the code would write it
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

from asset_factory.envs.tasks.catalog import TASKS
from asset_factory.factory.articulate.catalog import ARTICULATORS
from asset_factory.factory.cli.commands import COMMANDS
from asset_factory.factory.reasons import TABLES
from asset_factory.sim_checks.reasons import DEGREES
from asset_factory.sim_checks.simulators.catalog import SIMULATORS

ROOT = Path(__file__).resolve().parents[1]
MARKED = re.compile(r"(<!-- table: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)


def main() -> int:
    """Write or check every page; returns the exit code."""
    check = "--check" in sys.argv[1:]
    stale = []
    for page in sorted((*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"))):
        text = page.read_text(encoding="utf-8")
        new = MARKED.sub(lambda found: f"{found[1]}{WRITERS[found[2]]()}{found[3]}", text)
        if new != text:
            stale.append(page.relative_to(ROOT))
            if not check:
                page.write_text(new, encoding="utf-8")
    for name in stale:
        print(f"{name}: {'run python docs/generate.py' if check else 'written'}")
    return 1 if check and stale else 0


def table(head: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    """A Markdown table."""
    lines = [head, ("---",) * len(head), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def reasons() -> str:
    """Every code, by what became of the input."""
    text = ""
    for heading, codes in TABLES.items():
        rows = [(f"`{code}`", meaning) for code, meaning in codes.items()]
        text += f"## {heading}\n\n{table(('code', 'meaning'), rows)}\n"
    return text


def degrees() -> str:
    """Codes that reject from some degree on."""
    rows = [(f"`{code}`", soft, hard) for code, (soft, hard) in DEGREES.items()]
    return table(("code", "reported from", "rejects from"), rows)


def articulators() -> str:
    """What ``--articulator`` may be."""
    rows = [(f"`{entry.name}`", entry.summary) for entry in ARTICULATORS.values()]
    return table(("articulator", "goes by"), rows)


def commands() -> str:
    """What can be typed after ``factory``."""
    rows = [
        (f"`factory {command.name}`", (command.flags.__doc__ or "").strip().split("\n\n")[0])
        for command in COMMANDS
    ]
    return table(("command", ""), [(name, " ".join(text.split())) for name, text in rows])


def simulators() -> str:
    """What ``--sim`` may name."""
    rows = [(f"`{name}`", ", ".join(engine.formats)) for name, engine in SIMULATORS.items()]
    return table(("simulator", "reads"), rows)


def tasks() -> str:
    """What ``gym.make`` may be given."""
    rows = [(f"`{task.id}`", f"`{task.class_name}`") for task in TASKS]
    return table(("task", "class"), rows)


WRITERS: Mapping[str, Callable[[], str]] = {
    "reasons": reasons,
    "degrees": degrees,
    "articulators": articulators,
    "commands": commands,
    "simulators": simulators,
    "tasks": tasks,
}

if __name__ == "__main__":
    sys.exit(main())
