"""``factory propose``: what somebody is shown and told who says what opens."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path

import tyro
from tyro.conf import Positional

from ..errors import ConfigError, Exit, InputRejected
from ..runtime.store import write_whole
from ..runtime.terminal import say
from .flags import InputFlags, in_own_process, input_config, require_writable

SHEET = "sheet.png"
INSTRUCTION = "instruction.txt"
SCHEMA = "parts.schema.json"


@dataclass(frozen=True)
class Propose:
    """Write what a model or a colleague needs to say what opens: pictures, instruction, schema.

    The answer goes beside the mesh, as NAME.parts.json; the next build takes it.

    Exit codes: 0 written; 1 the input was rejected; 3 no answer came; 2 wrong usage.

    Example: factory propose fridge.glb --to pictures/
    """

    input: Positional[Path]
    """A mesh file."""
    to: Path
    """Folder that is written to; made if it is not there."""
    loading: tyro.conf.OmitArgPrefixes[InputFlags] = field(default_factory=InputFlags)
    """How it is loaded."""


def run(command: Propose) -> int:
    """Write the files; returns the exit code."""
    from ..articulate.asking.question import question_about
    from ..intake.stated import schema

    config = input_config(command.loading)
    if not command.input.is_file():
        raise ConfigError(f"{command.input}: no such file; want a mesh")
    try:
        asked = in_own_process(question_about, command.input, config, limits=config)
    except InputRejected as rejection:
        say(f"rejected: {rejection.code}: {rejection.message}")
        return Exit.REJECTED
    if asked is None:
        return Exit.UNJUDGED
    require_writable(command.to, "--to")
    write_whole(command.to / SHEET, asked.sheet)
    write_whole(command.to / INSTRUCTION, asked.instruction.encode())
    write_whole(command.to / SCHEMA, (json.dumps(schema(), indent=1) + "\n").encode())
    say(
        f"{command.to / SHEET}: what to look at; {command.to / INSTRUCTION}: what to answer. "
        f"Put the answer beside the mesh, as {command.input.stem}.parts.json, and build."
    )
    return Exit.OK
