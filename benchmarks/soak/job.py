"""The build that is killed, starved and watched: the command itself, in surroundings of its own."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

FACTORY = (sys.executable, "-m", "asset_factory.factory.cli")
#: Everything runs, nothing for long.
CHEAP = Path(__file__).with_name("cheap.toml")


def build_command(inputs: Path, output: Path, workers: int, *flags: str) -> list[str]:
    """``factory build`` with cheap settings."""
    cheap = (
        "--articulator",
        "annotated",
        "--sim",
        "mujoco",
        "--config",
        str(CHEAP),
        "--workers",
        str(workers),
    )
    return [*FACTORY, "build", "--input", str(inputs), "--output", str(output), *cheap, *flags]


def surroundings(scratch: Path) -> dict[str, str]:
    """An environment whose temporary files lie in a folder of their own, made if need be."""
    scratch.mkdir(parents=True, exist_ok=True)
    return {**os.environ, "TMPDIR": str(scratch), "OMP_NUM_THREADS": "1"}


def started(command: list[str], scratch: Path) -> subprocess.Popen[bytes]:
    """The command, under way and silent."""
    silent = subprocess.DEVNULL
    return subprocess.Popen(command, stdout=silent, stderr=silent, env=surroundings(scratch))


def done(command: list[str], scratch: Path) -> subprocess.CompletedProcess[str]:
    """The command, run to its end, with what it said."""
    return subprocess.run(
        command, capture_output=True, text=True, env=surroundings(scratch), check=False
    )


def collected(output: Path, scratch: Path) -> subprocess.CompletedProcess[str]:
    """``factory gc``, run to its end."""
    return done([*FACTORY, "gc", "--output", str(output)], scratch)
