"""The ``factory`` command: parse, call one function, leave with its exit code."""

import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from importlib import import_module
from typing import Annotated, Any, Union

import tyro

from ..errors import AssetFactoryError, Exit
from ..runtime.terminal import complain
from . import (
    build,
    check,
    demos,
    doctor,
    edit,
    listing,
    nightly,
    predict,
    propose,
    registry,
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
        name: what is typed after ``factory``.
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
    Command("nightly", nightly.Nightly, nightly.run),
    Command("predict", predict.Predict, predict.run),
    Command("propose", propose.Propose, propose.run),
    Command("check", check.Check, check.run),
    Command("report", report.ReportPages, report.run),
    Command("view", view.ViewFile, view.run),
    Command("edit", edit.Edit, edit.run),
    Command("list", listing.List, listing.run),
    Command("show", show.Show, show.run),
    Command("registry", registry.RegistryCommand, registry.run),
    Command("solve", solve.Solve, solve.run),
    Command("weights", weights.WeightsCommand, weights.run),
    Command("demos", demos.Demos, demos.run),
    Command("evaluate", _evaluate.Evaluate, _evaluate.run),
    Command("train", _train.Train, _train.run),
    Command("doctor", doctor.Doctor, doctor.run),
)

#: Flags of a command that add up when they are said again.
ADDING = (("demos", "--category"),)

#: How every command is parsed.
OPTIONS = (tyro.conf.FlagCreatePairsOff,)

HELP = """Turn 3D meshes into articulated assets that robots can open.

factory doctor tries what is installed here; factory build --input meshes/ --output out/ makes
assets; factory list --output out/ lists them; factory COMMAND --help says more of each.
factory --tyro-print-completion bash prints a completion for bash; zsh and tcsh are there, too.
"""


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
    first = next(iter(sys.argv[1:] if arguments is None else arguments), "-")
    names = [command.name for command in COMMANDS]
    if not first.startswith("-") and first not in names:
        near = get_close_matches(first, names, n=1, cutoff=0.5)
        meant = f"did you mean {near[0]!r}?" if near else f"there are {', '.join(names)}"
        complain(f"factory: no command {first!r}; {meant}")
        raise SystemExit(Exit.USAGE)
    twice = _said_twice(sys.argv[1:] if arguments is None else arguments)
    if twice:
        wanted = f"say {twice} once, with all that it is to hold after it"
        complain(f"factory: {twice} is there twice and only the last would count; {wanted}")
        raise SystemExit(Exit.USAGE)
    named = tuple(Annotated[c.flags, tyro.conf.subcommand(c.name)] for c in COMMANDS)
    any_command: Any = Union[named]  # noqa: UP007 - made from a table
    flags: Any = tyro.cli(
        any_command,
        args=arguments,
        prog="factory",
        description=HELP,
        config=OPTIONS,
    )
    (command,) = (command for command in COMMANDS if command.flags is type(flags))
    return command, flags


def _said_twice(arguments: Sequence[str]) -> str:
    """Return a flag that is there twice, if one is and does not add up."""
    said = [each.split("=")[0] for each in arguments if each.startswith("--")]
    twice = (flag for flag in said if said.count(flag) > 1)
    return next((flag for flag in twice if (arguments[0], flag) not in ADDING), "")
