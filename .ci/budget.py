"""Hold the size and the words of the code to a budget that only falls.

python .ci/budget.py           check; exit code 1 where a figure is over its budget or far below it
python .ci/budget.py --lower   write the figures of today where they are lower

``.ci/budget.toml`` has the figures: lines by package, named numeric constants where geometry is
judged by hand, and how docstrings and pages speak. A change that makes a package smaller lowers its
budget; one that must raise it removes as much elsewhere.
"""

from __future__ import annotations

import ast
import re
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BUDGET = ROOT / ".ci" / "budget.toml"
#: A budget is lowered when the code is this much below it.
SLACK = 0.01
HEADER = "# What .ci/budget.py holds the code to. Figures only fall: its --lower writes them.\n"
SOURCES = ("factory", "sim_checks", "envs", "learn")
#: Where a number that somebody set decides what a shape is.
JUDGED_BY_HAND = ("factory/articulate", "factory/manufacture")
RIDDLE = re.compile(r"\bwhat (?:is|are|was|were|has|lies|stands|goes|comes|moves)\b", re.IGNORECASE)
CODE = re.compile(r"^```.*?^```|^    .*?$|`[^`]*`|^\|.*?$", re.MULTILINE | re.DOTALL)
VERBS = frozenset((ROOT / ".ci" / "verbs.txt").read_text(encoding="utf-8").split())


def main() -> int:
    """Compare every figure with its budget; returns the exit code."""
    budget = tomllib.loads(BUDGET.read_text(encoding="utf-8"))
    figures = measure()
    if "--lower" in sys.argv[1:]:
        BUDGET.write_text(lowered(budget, figures), encoding="utf-8")
        return 0
    broken = list(compare(budget, figures))
    print("\n".join(broken) or "every budget is kept")
    return 1 if broken else 0


def measure() -> dict[str, dict[str, float]]:
    """Return today's figures by section and name."""
    trees = {path: ast.parse(path.read_text(encoding="utf-8")) for path in python_files(*SOURCES)}
    texts = [*docstrings(trees), *pages()]
    verbs = [text.split(" ", 1)[0].strip(".,:") in VERBS for text in function_docstrings(trees)]
    words = sum(len(text.split()) for text in texts)
    riddles = sum(len(RIDDLE.findall(text)) for text in texts)
    return {
        "lines": {name: count_lines(name) for name in packages()},
        "constants": {name: count_constants(name, trees) for name in JUDGED_BY_HAND},
        "words": {
            "functions_without_a_verb_percent": round(100 * (1 - sum(verbs) / len(verbs)), 1),
            "riddles_per_1000_words": round(1000 * riddles / words, 2),
        },
    }


def compare(
    budget: dict[str, dict[str, float]], figures: dict[str, dict[str, float]]
) -> Iterator[str]:
    """Yield a sentence for each figure over its budget, and for each budget to be lowered."""
    for section, found in figures.items():
        limits = budget.get(section, {})
        for name in sorted(limits.keys() | found.keys()):
            if name not in limits or name not in found:
                yield f"{section} of {name}: in the budget or in the tree, want it in both"
            elif found[name] > limits[name]:
                wanted = f"budget {limits[name]:g}; remove as much as you add"
                yield f"{section} of {name}: {found[name]:g}, {wanted}"
            elif section == "lines" and found[name] < (1 - SLACK) * limits[name]:
                wanted = f"budget {limits[name]:g}; run python .ci/budget.py --lower"
                yield f"{section} of {name}: {found[name]:g}, {wanted}"


def lowered(budget: dict[str, dict[str, float]], figures: dict[str, dict[str, float]]) -> str:
    """Return the budget's text with today's figures where they are lower, or new."""
    text = HEADER
    for section, found in figures.items():
        limits = budget.get(section, {})
        text += f"\n[{section}]\n"
        for name, value in found.items():
            key = f'"{name}"' if not name.isidentifier() else name
            text += f"{key} = {min(value, limits.get(name, value)):g}\n"
    return text


def packages() -> list[str]:
    """Return the names under which lines are counted."""
    folders = sorted(each.parent for each in (ROOT / "factory").glob("*/__init__.py"))
    return ["factory/*.py", *(f"factory/{each.name}" for each in folders), *SOURCES[1:], "tests"]


def python_files(*folders: str) -> list[Path]:
    """Return the sources below folders, sorted."""
    return sorted(file for folder in folders for file in (ROOT / folder).rglob("*.py"))


def count_lines(folder: str) -> int:
    """Return the lines of all sources in a folder; of ``factory/*.py`` those of its loose files."""
    loose = folder.endswith("/*.py")
    files = sorted(ROOT.glob(folder)) if loose else python_files(folder)
    return sum(file.read_text(encoding="utf-8").count("\n") for file in files)


def count_constants(folder: str, trees: dict[Path, ast.Module]) -> int:
    """Return how many names a folder's modules bind to a number, or to numbers, at their top."""
    return sum(
        is_numeric(node.value) and ast.unparse(target).lstrip("_").isupper()
        for path, tree in trees.items()
        if path.is_relative_to(ROOT / folder)
        for node in tree.body
        if isinstance(node, ast.Assign | ast.AnnAssign) and node.value is not None
        for target in (node.targets if isinstance(node, ast.Assign) else [node.target])
    )


def is_numeric(node: ast.expr) -> bool:
    """Tell whether an expression holds numbers and no other constants."""
    leaves = [each for each in ast.walk(node) if isinstance(each, ast.Constant)]
    numbers = [each for each in leaves if type(each.value) in (int, float)]
    return bool(numbers) and len(numbers) == len(leaves)


def docstrings(trees: dict[Path, ast.Module]) -> Iterator[str]:
    """Yield every docstring."""
    kinds = (ast.Module, ast.ClassDef, ast.FunctionDef)
    for tree in trees.values():
        for node in ast.walk(tree):
            if isinstance(node, kinds) and (text := ast.get_docstring(node)):
                yield text


def function_docstrings(trees: dict[Path, ast.Module]) -> Iterator[str]:
    """Yield the docstrings of functions and methods."""
    for tree in trees.values():
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef) and (text := ast.get_docstring(node)):
                yield text


def pages() -> Iterator[str]:
    """Yield the prose of README and the docs, without code and tables."""
    for page in (ROOT / "README.md", ROOT / "ARCHITECTURE.md", *sorted(ROOT.glob("docs/*.md"))):
        yield CODE.sub("", page.read_text(encoding="utf-8"))


if __name__ == "__main__":
    sys.exit(main())
