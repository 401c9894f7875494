"""What of the docs the code itself knows: tables between marks, and files.

python docs/generate.py            write them anew
python docs/generate.py --check    exit code 1 where a page is not as the code would write it
"""

from __future__ import annotations

import argparse
import inspect
import json
import re
import sys
import textwrap
import tomllib
import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import msgspec
import tyro

from asset_factory.envs.tasks.catalog import TASKS
from asset_factory.factory.articulate.catalog import ARTICULATORS
from asset_factory.factory.cli.commands import COMMANDS, OPTIONS
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.intake import stated
from asset_factory.factory.reasons import TABLES
from asset_factory.learn.train.settings import TrainConfig
from asset_factory.sim_checks import Disagreement, Finding, Report
from asset_factory.sim_checks.reasons import DEGREES
from asset_factory.sim_checks.report import VERSION
from asset_factory.sim_checks.simulators.catalog import SIMULATORS

ROOT = Path(__file__).resolve().parents[1]
DIALECT = {"$schema": "https://json-schema.org/draft/2020-12/schema"}
RESULTS = ROOT / "benchmarks" / "results"
MARKED = re.compile(r"(<!-- table: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)


def main() -> int:
    """Write or check every page; returns the exit code."""
    check = "--check" in sys.argv[1:]
    stale = []
    pages = sorted((*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")))
    for page in (*pages, *(ROOT / name for name in FILES)):
        text = page.read_text(encoding="utf-8") if page.is_file() else ""
        writer = FILES.get(page.relative_to(ROOT).as_posix())
        new = MARKED.sub(lambda found: f"{found[1]}{WRITERS[found[2]]()}{found[3]}", text)
        new = new if writer is None else writer()
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
    found: set[str] = set()
    for each in TABLES:
        rows = [(anchored(code, found), meaning) for code, meaning in each.meanings.items()]
        text += f"## {each.heading}\n\n{table(('code', 'meaning'), rows)}\n"
    return text


def anchored(code: str, found: set[str]) -> str:
    """A code as its row's first cell, with an anchor where it comes first."""
    anchor = "" if code in found else f'<a id="{code}"></a>'
    found.add(code)
    return f"{anchor}`{code}`"


def degrees() -> str:
    """Codes that reject from some degree on."""
    rows = [(f"`{code}`", *degree) for code, degree in DEGREES.items()]
    return table(("code", "warning at", "error at", "why"), rows)


def articulators() -> str:
    """What ``--articulator`` may be."""
    rows = [(f"`{entry.name}`", entry.summary) for entry in ARTICULATORS.values()]
    return table(("articulator", "goes by"), rows)


def commands() -> str:
    """Every command with its flags, as its parser has them."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # tyro would rather be asked to parse
        named = [
            (each.name, tyro.extras.get_parser(each.flags, config=OPTIONS)) for each in COMMANDS
        ]
    return "".join(text for name, parser in named for text in _command(f"factory {name}", parser))


def _command(name: str, parser: argparse.ArgumentParser, level: int = 2) -> Iterator[str]:
    yield f"{'#' * level} {name}\n\n{_plain(parser.description)}\n\n"
    rows = []
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for word, below in action.choices.items():
                yield from _command(f"{name} {word}", below, level + 1)
        elif "--help" not in action.option_strings:
            rows.append(_flag(action))
    if rows:
        yield table(("flag", "takes", "", "default"), rows) + "\n"


def _flag(action: argparse.Action) -> tuple[str, ...]:
    text = _plain(action.help)
    told = re.fullmatch(r"(.*?) ?\((required|default: .*|repeatable|optional)\)", text, re.DOTALL)
    meaning, default = (told[1], told[2]) if told else (text, "")
    default = default.removeprefix("default: ")
    names = ", ".join(f"`{name}`" for name in action.option_strings) or f"`{action.dest}`"
    takes = str(action.metavar or "").replace("|", " or ").replace("{None} or ", "")
    unsaid = default in ("", "''", "None", "True", "False", "required")
    shown = default if default == "required" else "" if unsaid else f"`{default}`"
    return (names, f"`{takes}`" if takes else "", _cell(meaning), shown)


def _plain(text: str | None) -> str:
    """Help as a paragraph: no colours, no line breaks but between paragraphs."""
    bare = re.sub(r"\x1b\[[0-9;]*m", "", text or "").strip()
    return "\n\n".join(" ".join(each.split()) for each in bare.split("\n\n"))


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|").replace("``", "`")


def settings() -> str:
    """Every setting of a build and of the judge."""
    return "".join(_settings(BuildConfig, ""))


def training_settings() -> str:
    """Every setting of a training."""
    return "".join(_settings(TrainConfig, ""))


def _settings(config: type[Any], section: str) -> Iterator[str]:
    """A table of a dataclass's settings, and one for each dataclass in it."""
    default = config()
    meanings = attributes(config)
    own = []
    below = []
    for each in fields(config):
        value = getattr(default, each.name)
        name = f"{section}.{each.name}".removeprefix(".")
        if is_dataclass(value) and not isinstance(value, type):
            below.append((type(value), name))
        else:
            own.append((f"`{each.name}`", f"`{_toml(value)}`", _cell(meanings.get(each.name, ""))))
    title = f"`[{section}]`" if section else "Above all sections"
    if own:
        first = (inspect.getdoc(config) or "").split("\n")[0]
        yield f"### {title}\n\n{first}\n\n{table(('setting', 'default', 'meaning'), own)}\n"
    for inner, name in below:
        yield from _settings(inner, name)


def _toml(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, tuple):
        return f"[{', '.join(_toml(each) for each in value)}]"
    return f"{value:g}" if isinstance(value, float) else "not set" if value is None else str(value)


def attributes(described: type[Any]) -> dict[str, str]:
    """What the section ``Attributes`` of a class's docstring says of each."""
    text = (inspect.getdoc(described) or "").partition("Attributes:\n")[2]
    found = {}
    for entry in re.split(r"\n(?=\S)", textwrap.dedent(text)):
        names, _, meaning = entry.partition(":")
        for name in names.split(","):
            found[name.strip()] = " ".join(meaning.split())
    return found


def finding() -> str:
    """What a finding in ``report.json`` holds."""
    meanings = attributes(Finding)
    rows = [(f"`{each.name}`", _cell(meanings[each.name])) for each in fields(Finding)]
    return table(("field", "meaning"), rows)


def simulators() -> str:
    """What ``--sim`` may name."""
    rows = [(f"`{name}`", ", ".join(engine.formats)) for name, engine in SIMULATORS.items()]
    return table(("simulator", "reads"), rows)


def tasks() -> str:
    """What ``gym.make`` may be given."""
    rows = [(f"`{task.id}`", f"`{task.class_name}`") for task in TASKS]
    return table(("task", "class"), rows)


def parts_schema() -> str:
    """Return the JSON schema of stated parts, each property with what its class says of it."""
    schema = stated.schema()
    for name, form in schema["$defs"].items():
        form["description"] = " ".join(form["description"].partition("\n")[0].split())
        for key, value in form.get("properties", {}).items():
            meaning = _cell(attributes(getattr(stated, name))[key])
            form["properties"][key] = {"description": meaning, **value}
    return json.dumps({**DIALECT, **schema}, indent=1) + "\n"


def report_schema() -> str:
    """Return the JSON schema of a report; a build's has more keys, which it leaves open."""
    types = [Report, Finding, Disagreement]
    _, forms = msgspec.json.schema_components(types, ref_template="#/$defs/{name}")
    for each in types:
        form = forms[each.__name__]
        form["description"] = (inspect.getdoc(each) or "").partition("\n")[0]
        meanings = attributes(each)
        form["properties"] = {
            key: {
                "description": meanings[key],
                **{k: v for k, v in value.items() if k != "default"},
            }
            for key, value in form["properties"].items()
        }
        form["required"] = list(form["properties"])
        form["additionalProperties"] = each is Report
    report = forms.pop("Report")
    report["properties"] = {
        "version": {"description": "of this form.", "const": VERSION},
        "passed": {"description": "whether no finding is an error.", "type": "boolean"},
        **report["properties"],
    }
    report["required"] = list(report["properties"])
    return json.dumps({**DIALECT, **report, "$defs": forms}, indent=1) + "\n"


def results() -> str:
    """Return every file of results as a table with what made it and what it means."""
    files = [tomllib.loads(each.read_text(encoding="utf-8")) for each in RESULTS.glob("*.toml")]
    text = ""
    for section in sorted({each["section"] for each in files}, key=SECTIONS.index):
        text += f"## {section}\n\n"
        of_section = (each for each in files if each["section"] == section)
        for each in sorted(of_section, key=lambda result: result["order"]):
            text += f"### {each['title']}\n\n{textwrap.fill(each['means'].strip(), 160)}\n\n"
            text += table(tuple(each["columns"]), [tuple(row) for row in each["rows"]])
            made = f"`{each['command']}`" if "command" in each else "No command of the project"
            text += f"\n{made}, {each['date']}, at {each['commit']}. "
            text += f"Held out: {each['held_out']}.\n\n"
    return text


#: Headings of the page of results, in order.
SECTIONS = (
    "Inputs that nobody here has seen",
    "Validation",
    "Objects that others made, rebuilt",
    "One-piece meshes",
    "Meshes by artists",
    "Joints",
    "Speed",
)

WRITERS: Mapping[str, Callable[[], str]] = {
    "reasons": reasons,
    "degrees": degrees,
    "articulators": articulators,
    "commands": commands,
    "settings": settings,
    "training_settings": training_settings,
    "finding": finding,
    "simulators": simulators,
    "tasks": tasks,
    "results": results,
}

#: Files that are written whole.
FILES: Mapping[str, Callable[[], str]] = {
    "docs/parts.schema.json": parts_schema,
    "docs/report.schema.json": report_schema,
}

if __name__ == "__main__":
    sys.exit(main())
