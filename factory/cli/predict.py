"""``factory predict``: the moving parts of one input."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path

import tyro
from tyro.conf import Positional

from ..errors import ConfigError, Exit
from ..runtime.terminal import say
from . import console
from .flags import InputFlags, Printed, in_own_process, input_config


@dataclass(frozen=True)
class Predict(Printed):
    """Print the parts and joints proposed for one input; build nothing.

    Exit codes: 0 there is an answer; 1 the input was rejected; 3 no answer came; 2 wrong usage.

    Example: factory predict fridge.glb --json
    """

    input: Positional[Path]
    """A mesh file, a URDF or an MJCF file."""
    loading: tyro.conf.OmitArgPrefixes[InputFlags] = field(default_factory=InputFlags)
    """How it is loaded and articulated."""


def run(command: Predict) -> int:
    """Print the moving parts; returns the exit code."""
    from ..articulate.predict import predict

    config = input_config(command.loading)
    if not command.input.is_file():
        raise ConfigError(f"{command.input}: no such file; want a mesh, a URDF or an MJCF file")
    found = in_own_process(predict, command.input, config, limits=config)
    if found is None:
        return Exit.UNJUDGED
    if command.json:
        say(json.dumps(found, indent=2))
    else:
        console.print_prediction(found)
    return Exit.REJECTED if "rejected" in found else Exit.OK
