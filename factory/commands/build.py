"""``factory build``: meshes in, a registry out."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

import tyro

from .. import console
from ..config import BuildConfig
from ..errors import ConfigError
from ..registry import Registry, write_json
from . import exits
from .reading import DEFAULT_SIMULATORS, Reading, reading_config, simulators_named


@dataclass(frozen=True)
class Build:
    """Turn meshes into simulation-checked assets and register what passes.

    Exit codes: 0 every input got a verdict; 3 some input could not be judged; 2 wrong usage;
    1 something was rejected and --strict was given.
    """

    input: tuple[Path, ...]
    """Mesh files (GLB, glTF, OBJ, PLY, STL, OFF), URDF or MJCF files, or folders of them."""
    output: Path
    """The registry's folder; made if it is not there."""
    sim: str = DEFAULT_SIMULATORS
    """Simulators that judge, separated by commas, or 'all'."""
    workers: int | None = None
    """Inputs built at once; all processors by default."""
    strict: bool = False
    """Exit with 1 when anything was rejected."""
    reading: tyro.conf.OmitArgPrefixes[Reading] = field(default_factory=Reading)
    """How inputs are loaded, and who says what moves."""


def run(command: Build) -> int:
    """Build every input; returns the exit code."""
    # Geometry libraries load only to build.
    from asset_factory.sim_checks.isolation import processors

    from ..jobs import run_builds
    from ..mesh import find_inputs
    from ..summary import summarize

    config = build_config(command)
    inputs = find_inputs(command.input)
    Registry(command.output, create=True)
    workers = command.workers if command.workers is not None else processors()
    if workers < 1:
        raise ConfigError(f"--workers: is {workers}, want at least 1")
    results = console.follow(run_builds(inputs, command.output, config, workers), len(inputs))
    summary = summarize(results)
    write_json(command.output / "summary.json", summary)
    console.print_results(summary, command.output)
    if summary["unjudged"]:
        return exits.UNJUDGED
    return exits.REJECTED if command.strict and summary["rejected"] else exits.OK


def build_config(command: Build) -> BuildConfig:
    """The configuration that the flags ask for."""
    return replace(reading_config(command.reading), simulators=simulators_named(command.sim))
