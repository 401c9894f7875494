"""Conventions that no linter knows: prints what breaks them; exit code 1 if anything does."""

from __future__ import annotations

import ast
import re
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("factory", "sim_checks", "envs", "learn")
#: Files beside the folders of a package, its __init__ not counted.
MOST_LOOSE_FILES = 8
MOST_LINES = 400
#: Words that a newcomer would have to learn, and what to say instead.
WORDS = {
    "zoo": "fault corpus",
    "specimen": "sample",
    "lesson": "sample",
    "crew": "worker pool",
    "flight": "task",
    "parcel": "transfer",
    "lifting": "importing",
    "morning": "nightly report",
    "licence": "license",
}
#: What tells the time or the processor time, and where that may be asked: to stop what hangs, to
#: hold a job to its hours, to tell people. Nothing that decides about an asset is among them.
CLOCKS = re.compile(r"(process_time|perf_counter|monotonic|thread_time|time)(_ns)?")
CLOCKS_IN = (
    "factory/jobs/",
    "factory/models/service/",
    "factory/models/weights/pickled.py",
    "factory/registry/registration.py",
    "factory/runtime/clock.py",
    "factory/runtime/store.py",
    "learn/datasets/__main__.py",
    "learn/detector/train.py",
    "learn/samples/",
    "learn/train/",
    "sim_checks/processes/",
)
BANNED = re.compile(rf"\b({'|'.join(WORDS)})s?\b", re.IGNORECASE)


def main() -> int:
    """Look at every source; returns the exit code."""
    classes: dict[str, list[str]] = defaultdict(list)
    broken = [*_loose_files()]
    for path in sorted(file for package in PACKAGES for file in (ROOT / package).rglob("*.py")):
        name = path.relative_to(ROOT).as_posix()
        text = path.read_text(encoding="utf-8")
        tree = ast.parse(text)
        for node in ast.walk(tree):
            if isinstance(node, ast.ClassDef):
                classes[node.name].append(f"{name}:{node.lineno}")
        broken += _words(name, text)
        broken += _pairs(name, tree)
        broken += [] if name.startswith(CLOCKS_IN) else _clocks(name, tree)
        if text.count("\n") > MOST_LINES:
            broken.append(f"{name}: {text.count(chr(10))} lines, at most {MOST_LINES}")
    for found, places in classes.items():
        if len(places) > 1:
            broken.append(f"class {found} is defined in {' and '.join(places)}: once is enough")
    print("\n".join(broken) or "every convention is kept")
    return 1 if broken else 0


def _loose_files() -> Iterator[str]:
    for package in PACKAGES:
        loose = [path.name for path in (ROOT / package).glob("*.py") if path.name != "__init__.py"]
        if len(loose) > MOST_LOOSE_FILES:
            yield f"{package}/: {len(loose)} loose files, at most {MOST_LOOSE_FILES}"


def _words(name: str, text: str) -> Iterator[str]:
    for number, line in enumerate(text.splitlines(), start=1):
        for word in BANNED.findall(line):
            yield f"{name}:{number}: says {word!r}, want {WORDS[word.lower()]!r}"


def _clocks(name: str, tree: ast.AST) -> Iterator[str]:
    """Uses of the module ``time`` that ask for a time."""
    for node in ast.walk(tree):
        found = []
        if isinstance(node, ast.ImportFrom) and node.module == "time":
            found = [alias.name for alias in node.names]
        elif isinstance(node, ast.Attribute) and ast.unparse(node.value) == "time":
            found = [node.attr]
        for clock in found:
            if CLOCKS.fullmatch(clock):
                yield (
                    f"{name}:{node.lineno}: asks time.{clock}, which decides nothing here: count "
                    "work instead, or let a child's limits stop what hangs"
                )


def _pairs(name: str, tree: ast.AST) -> Iterator[str]:
    """Two assignments on one line by tuple; an exchange of values is one assignment."""
    for node in ast.walk(tree):
        if not (isinstance(node, ast.Assign) and isinstance(node.value, ast.Tuple)):
            continue
        target = node.targets[0]
        if not isinstance(target, ast.Tuple) or len(target.elts) != len(node.value.elts):
            continue
        set_names = {ast.unparse(each) for each in target.elts}
        used = {ast.unparse(each) for each in ast.walk(node.value) if isinstance(each, ast.expr)}
        if not set_names & used:
            yield f"{name}:{node.lineno}: two assignments by tuple, want a line each"


if __name__ == "__main__":
    sys.exit(main())
