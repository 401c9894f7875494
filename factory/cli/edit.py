"""``factory edit``: say on a page what opens, and build it."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from pathlib import Path

import tyro
from tyro.conf import Positional

from ..errors import ConfigError, Exit, InputRejected
from ..runtime.terminal import say
from .flags import (
    DEFAULT_SIMULATORS,
    InputFlags,
    RootFlags,
    input_config,
    require_page,
    simulators_named,
)

#: Of a mesh, if no other is named.
USUAL_OUTPUT = Path("out")


@dataclass(frozen=True)
class Edit:
    """Draw on a page what opens on a mesh, see it open, and build it.

    What was found is drawn as boxes on pictures of the mesh's sides: move, add and delete them, and
    choose what they are. Build writes them beside the mesh, as NAME.parts.json, runs `factory
    build`, and shows the verdict. The page is served to this machine only, until Ctrl-C.

    Example: factory edit out/rejected/chest-0123456789
    """

    input: Positional[Path]
    """A mesh file, the folder of an asset or of a rejected one, or its id with --output."""
    output: Path | None = None
    """The registry's folder that builds go into; that of the asset, or out, by default."""
    sim: str = DEFAULT_SIMULATORS
    """Simulators that validate, separated by commas; 'all' is sapien,mujoco,pybullet."""
    port: int = 0
    """Port of the page; 0: any that is free."""
    loading: tyro.conf.OmitArgPrefixes[InputFlags] = field(default_factory=InputFlags)
    """How the mesh is loaded and articulated."""


def run(command: Edit) -> int:
    """Serve the page; returns the exit code."""
    from ..edit.builds import Builds
    from ..edit.editor import editing
    from ..edit.subject import subject_of

    require_page(command.port)
    simulators_named(command.sim)
    config = input_config(command.loading)
    subject = subject_of(command.input, command.output, USUAL_OUTPUT)
    place = ("--input", str(subject.mesh.absolute()), "--output", str(subject.output))
    flags = (*place, "--sim", command.sim, "--json", *_said(command.loading))
    try:
        with editing(subject, config, Builds(("build", *flags)), command.port) as server:
            say(f"{subject.mesh.name} is edited at {server.url} until Ctrl-C")
            server.run()
    except InputRejected as rejection:
        raise ConfigError(f"{subject.mesh}: {rejection.code}: {rejection.message}") from rejection
    return Exit.OK


def _said(flags: InputFlags | RootFlags) -> list[str]:
    """Return flags as they are typed, those that differ from their defaults."""
    words: list[str] = []
    for each in fields(flags):
        value = getattr(flags, each.name)
        flag = f"--{each.name.replace('_', '-')}"
        if isinstance(value, RootFlags):
            words += _said(value)
        elif value is True:
            words.append(flag)
        elif value != each.default:
            words += [f"{flag}={one}" for one in (value if isinstance(value, tuple) else [value])]
    return words
