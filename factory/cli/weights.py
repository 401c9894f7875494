"""``factory weights``: what a checkpoint holds, and a safe form of it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro
from tyro.conf import Positional

from ..errors import Exit
from . import console


@dataclass(frozen=True)
class InfoCommand:
    """Say which network a checkpoint is for, its sizes, and the terms of the published weights."""

    checkpoint: Positional[str]
    """A safetensors, .pt or .ckpt file, or hf:owner/repository/file@commit."""


@dataclass(frozen=True)
class WeightsConvert:
    """Write a checkpoint as safetensors, which holds tensors and nothing that could run."""

    checkpoint: Positional[str]
    """A safetensors, .pt or .ckpt file, or hf:owner/repository/file@commit."""
    target: Positional[Path]
    """The file to write; ends in .safetensors."""


@dataclass(frozen=True)
class WeightsCommand:
    """Describe checkpoints of networks, or convert them to safetensors."""

    action: (
        Annotated[InfoCommand, tyro.conf.subcommand("info", prefix_name=False)]
        | Annotated[WeightsConvert, tyro.conf.subcommand("convert", prefix_name=False)]
    )


def run(command: WeightsCommand) -> int:
    """Describe or convert a checkpoint; returns the exit code."""
    from ..models.weights.checkpoint import convert, describe
    from ..models.weights.sources import fetch

    wanted = command.action
    source = fetch(wanted.checkpoint)
    if isinstance(wanted, WeightsConvert):
        info = convert(source, wanted.target)
    else:
        info = describe(source)
    shown = console.terminal()
    shown.print(f"{info.file}: {info.network}", markup=False, soft_wrap=True)
    numbers = {"tensors": info.tensors, "parameters": f"{info.parameters:,}"}
    for name, value in {**info.details, **numbers, "types": ", ".join(info.dtypes)}.items():
        shown.print(f"  {name}: {value}", markup=False, soft_wrap=True)
    shown.print(info.terms, markup=False, soft_wrap=True)
    return Exit.OK
