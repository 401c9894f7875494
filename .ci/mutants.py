"""Make small wrong changes to copies of the tree, and demand that tests notice each of them.

``tests/mutants.toml`` lists them: in ``file``, ``before`` occurs once and becomes ``after``; one of
``tests`` must fail; ``says`` is what would go wrong for a user. Exit code 1 if one goes unnoticed.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from queue import SimpleQueue

ROOT = Path(__file__).resolve().parents[1]
LIST = ROOT / "tests" / "mutants.toml"
NOT_COPIED = shutil.ignore_patterns(".*", "__pycache__", "node_modules", "out")
#: How a test fails that met a program which does not run, rather than one that errs.
BROKEN = re.compile(r"^FAILED .* - (Import|ModuleNotFound|Name|Syntax|UnboundLocal)Error", re.M)


@dataclass(frozen=True)
class Mutant:
    """One small wrong change, and the tests of which one must fail by it; see above."""

    file: str
    before: str
    after: str
    tests: tuple[str, ...]
    says: str

    def apply(self, tree: Path) -> None:
        """Make the change in a tree. Raises ValueError or SyntaxError where it cannot be made."""
        text = (tree / self.file).read_text(encoding="utf-8")
        if (count := text.count(self.before)) != 1:
            raise ValueError(f"its text before occurs {count} times, want once: {self.before!r}")
        changed = text.replace(self.before, self.after)
        compile(changed, self.file, "exec")
        (tree / self.file).write_text(changed, encoding="utf-8")


def read_mutants(path: Path) -> tuple[Mutant, ...]:
    """Read the list. Raises TypeError where an entry lacks a field, or has one too many."""
    entries = tomllib.loads(path.read_text(encoding="utf-8"))["mutant"]
    return tuple(Mutant(**{**entry, "tests": tuple(entry["tests"])}) for entry in entries)


def judge(mutant: Mutant, tree: Path) -> str:
    """Make the change in a copy of the tree, run its tests, undo it; empty if a test noticed."""
    source = tree / mutant.file
    original = shutil.copy2(source, tree / "unchanged")
    try:
        mutant.apply(tree)
        # What is compiled of a changed file must not be left for the next one.
        code, output = run_tests(mutant.tests, tree, PYTHONDONTWRITEBYTECODE="1")
    except (ValueError, SyntaxError) as error:
        return f"cannot be made: {error}"
    except subprocess.TimeoutExpired:
        return "its tests did not end"
    finally:
        # With its old time, so that what was compiled of it still counts.
        os.replace(original, source)
    if code == 0:
        return f"SURVIVES {', '.join(mutant.tests)}"
    if code != 1 or "\nFAILED " not in output or BROKEN.search(output):
        return f"no test judged it, pytest ended with code {code}:\n{output[-2000:]}"
    return ""


def run_tests(tests: Iterable[str], tree: Path, **environment: str) -> tuple[int, str]:
    """Run tests on the code of a tree until one fails: pytest's exit code, and what it said."""
    command = [sys.executable, "-m", "pytest", "-x", "-p", "no:cacheprovider", *sorted(tests)]
    own = {**os.environ, **environment, "PYTHONPATH": str(tree / "src")}
    done = subprocess.run(  # noqa: S603 - our own tests
        command, cwd=tree, env=own, capture_output=True, text=True, timeout=1800, check=False
    )
    return done.returncode, done.stdout + done.stderr


def main() -> int:
    """Try every change of the list; return the exit code."""
    parser = argparse.ArgumentParser(description="Demand that tests notice small wrong changes.")
    parser.add_argument("only", nargs="?", default="", help="part of a file's path, or of a reason")
    parser.add_argument("-j", type=int, default=2, help="how many at once")
    options = parser.parse_args()
    mutants = [each for each in read_mutants(LIST) if options.only in f"{each.file}: {each.says}"]
    trees: SimpleQueue[Path] = SimpleQueue()

    def killed(mutant: Mutant) -> bool:
        tree = trees.get()
        fault = judge(mutant, tree)
        trees.put(tree)
        print(f"{fault or 'killed'}  {mutant.file}: {mutant.says}", flush=True)
        return not fault

    with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
        first = shutil.copytree(ROOT, Path(folder) / "0", symlinks=True, ignore=NOT_COPIED)
        code, output = run_tests({test for each in mutants for test in each.tests}, first)
        if code != 0:
            print(f"the tests fail without any change:\n{output}")
            return 1
        trees.put(first)
        for number in range(1, options.j):
            trees.put(shutil.copytree(first, Path(folder) / str(number), symlinks=True))
        with ThreadPoolExecutor(options.j) as pool:
            results = list(pool.map(killed, mutants))
    print(f"{sum(results)} of {len(results)} killed")
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
