"""The ``factory`` command: parse, call one function, leave with its exit code."""

from __future__ import annotations

import os
import re
import sys
import textwrap
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any, Union, get_args

import tyro

from asset_factory import __version__

from ..errors import AssetFactoryError, Exit
from ..runtime.terminal import complain, say
from . import (
    build,
    check,
    demos,
    doctor,
    edit,
    gc,
    listing,
    nightly,
    predict,
    propose,
    registry,
    remove,
    report,
    show,
    solve,
    view,
    weights,
)


@dataclass(frozen=True)
class Command:
    """A command.

    Attributes:
        name: the word after ``factory``.
        flags: a dataclass; its docstring is the help.
        run: does it; returns the exit code.
    """

    name: str
    flags: type[Any]
    run: Callable[[Any], int]


#: Modules of commands that teach: their package stands above this one and is found by its name.
_evaluate = import_module("asset_factory.learn.commands.evaluate")
_train = import_module("asset_factory.learn.commands.train")

#: Every command, in the order of the help.
COMMANDS = (
    Command("build", build.Build, build.run),
    Command("check", check.Check, check.run),
    Command("view", view.ViewFile, view.run),
    Command("edit", edit.Edit, edit.run),
    Command("list", listing.List, listing.run),
    Command("show", show.Show, show.run),
    Command("solve", solve.Solve, solve.run),
    Command("demos", demos.Demos, demos.run),
    Command("doctor", doctor.Doctor, doctor.run),
    Command("predict", predict.Predict, predict.run),
    Command("propose", propose.Propose, propose.run),
    Command("report", report.ReportPages, report.run),
    Command("remove", remove.Remove, remove.run),
    Command("gc", gc.Gc, gc.run),
    Command("registry", registry.RegistryCommand, registry.run),
    Command("weights", weights.WeightsCommand, weights.run),
    Command("nightly", nightly.Nightly, nightly.run),
    Command("evaluate", _evaluate.Evaluate, _evaluate.run),
    Command("train", _train.Train, _train.run),
)
#: So many of them are for the first hour.
FIRST = 8

#: Flags that add to what was given before them.
AGAIN = ("--root", "--xacro-arg")
#: How every command is parsed.
OPTIONS = (tyro.conf.FlagCreatePairsOff,)
#: How values of flags that need not be given are read, and named in the help.
VALUES = tyro.constructors.ConstructorRegistry()
_NAMES = {int: "INT", float: "FLOAT", str: "STR", Path: "PATH"}

HELP = """Turn 3D meshes into articulated assets that robots can open.

  factory build --input meshes/ --output out/    makes assets
  factory list --output out/                     lists them
  factory COMMAND --help                         says more of each
"""
MORE = """
--version says which version this is; --tyro-print-completion bash prints a completion for bash
(zsh and tcsh are there, too).
"""


@VALUES.primitive_rule
def _optional(
    asked: tyro.constructors.PrimitiveTypeInfo,
) -> tyro.constructors.PrimitiveConstructorSpec[Any] | None:
    """Read a number, or a value of a flag that may be left out; the word None is none of them."""
    said = get_args(asked.type)
    kinds = [kind for kind in said if kind is not type(None)] or [asked.type]
    if len(kinds) != 1 or len(said) not in (0, 2) or kinds[0] not in _NAMES:
        return None
    (kind,) = kinds
    return tyro.constructors.PrimitiveConstructorSpec(
        nargs=1,
        metavar=_NAMES[kind],
        instance_from_str=lambda words: _read(kind, words[0]),
        is_instance=lambda value: value is None or isinstance(value, kind),
        str_from_instance=lambda value: ["unset" if value is None else str(value)],
    )


def _read(kind: Callable[[str], Any], word: str) -> Any:
    try:
        return kind(word)
    except ValueError as error:
        wanted = "a whole number" if kind is int else "a number"
        raise ValueError(f"must be {wanted}, not {word!r}") from error


def short_help() -> str:
    """Return every command with the first clause of its help."""
    width = max(len(command.name) for command in COMMANDS)

    def line(command: Command) -> str:
        summary = (command.flags.__doc__ or "").split("\n\n")[0]
        first = re.split(r"[.:;](?: |$)|, and ", " ".join(summary.split()))[0]
        told = textwrap.shorten(first, 76 - width, placeholder=" ...")
        return f"  {command.name:{width}}  {told}\n"

    first = "".join(line(command) for command in COMMANDS[:FIRST])
    rest = "".join(line(command) for command in COMMANDS[FIRST:])
    return f"{HELP}\n{first}\nmore\n{rest}{MORE}"


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and leave with its exit code."""
    try:
        code = run(arguments)
        sys.stdout.flush()
    except BrokenPipeError:
        # Who reads the output has seen enough. Python would complain of it once more at its exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        code = Exit.PIPE_CLOSED
    sys.exit(code)


def run(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code. Wrong usage raises SystemExit(2)."""
    command, flags = parse(arguments)
    try:
        return command.run(flags)
    except AssetFactoryError as error:
        complain(f"factory: {error}")
        return Exit.USAGE
    except KeyboardInterrupt:
        complain("factory: interrupted; what was finished is registered")
        # Worker processes follow this one; waiting for their threads would wait for their work.
        os._exit(Exit.INTERRUPTED)


def parse(arguments: Sequence[str] | None = None) -> tuple[Command, Any]:
    """Return the command that is meant, and its flags. Wrong usage raises SystemExit(2)."""
    arguments = sys.argv[1:] if arguments is None else arguments
    first = next(iter(arguments), "")
    if first in ("", "-h", "--help", "--version"):
        say(f"asset-factory {__version__}" if first == "--version" else short_help().strip())
        raise SystemExit(Exit.OK if first else Exit.USAGE)
    names = [command.name for command in COMMANDS]
    if not first.startswith("-") and first not in names:
        near = get_close_matches(first, names, n=1, cutoff=0.5)
        meant = f"did you mean {near[0]!r}?" if near else f"there are {', '.join(names)}"
        complain(f"factory: no command {first!r}; {meant}")
        raise SystemExit(Exit.USAGE)
    twice = _said_twice(arguments)
    if twice:
        wanted = f"say {twice} once, with all that it is to hold after it"
        complain(f"factory: {twice} is there twice and only the last would count; {wanted}")
        raise SystemExit(Exit.USAGE)
    named = tuple(Annotated[c.flags, tyro.conf.subcommand(c.name)] for c in COMMANDS)
    any_command: Any = Union[named]  # noqa: UP007 - made from a table
    with VALUES:
        flags: Any = tyro.cli(
            any_command, args=arguments, prog="factory", description=HELP, config=OPTIONS
        )
    (command,) = (command for command in COMMANDS if command.flags is type(flags))
    return command, flags


def _said_twice(arguments: Sequence[str]) -> str:
    """Return a flag that is there twice, if one is that holds its last value alone."""
    said = [each.split("=")[0] for each in arguments if each.startswith("--")]
    return next((flag for flag in said if said.count(flag) > 1 and flag not in AGAIN), "")
