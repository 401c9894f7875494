"""The ``factory`` command: parse, call one function, print."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Annotated, Any

import tyro
from tyro.conf import Positional

from asset_factory.sim_checks.simulators.catalog import SIMULATORS

from . import console
from .articulate.choose import ARTICULATORS
from .config import BuildConfig
from .errors import AssetFactoryError, ConfigError
from .presets import load_config
from .registry import Registry, write_json

EXIT_OK, EXIT_REJECTED, EXIT_USAGE, EXIT_UNJUDGED, EXIT_INTERRUPTED = 0, 1, 2, 3, 130
DEFAULT_SIMULATORS = "sapien"


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
    articulator: str = "auto"
    """Who says what moves: auto, annotated, geometric or rigid."""
    up: str = "auto"
    """Axis of the input that points up: x, y, z, -x, -y, -z, or auto (glTF: y; everything else: z)."""
    height: float | None = None
    """Real height to scale every input to [m]."""
    workers: int | None = None
    """Inputs built at once; all processors by default."""
    config: str = "default"
    """A preset (default, strict, lenient) or a TOML file of differences from the defaults."""
    strict: bool = False
    """Exit with 1 when anything was rejected."""


@dataclass(frozen=True)
class Check:
    """Judge URDF or MJCF files, anyone's.

    Exit codes: 0 every file got a verdict; 3 some file could not be judged; 2 wrong usage;
    1 something was rejected and --strict was given.
    """

    files: Positional[tuple[Path, ...]]
    """URDF or MJCF files."""
    sim: str = DEFAULT_SIMULATORS
    """Simulators that judge, separated by commas, or 'all'."""
    json: Path | None = None
    """Where to write the report; a list of reports when several files are given. '-' prints it."""
    config: str = "default"
    """A preset (default, strict, lenient) or a TOML file of differences from the defaults."""
    strict: bool = False
    """Exit with 1 when anything was rejected."""


@dataclass(frozen=True)
class List:
    """List what a registry holds."""

    output: Path
    """The registry's folder."""
    json: bool = False
    """Print JSON."""


@dataclass(frozen=True)
class Show:
    """Show one asset: its files, its joints, and what the judge said."""

    id: Positional[str]
    """As `factory list` prints it."""
    output: Path
    """The registry's folder."""
    json: bool = False
    """Print JSON."""


Command = (
    Annotated[Build, tyro.conf.subcommand("build")]
    | Annotated[Check, tyro.conf.subcommand("check")]
    | Annotated[List, tyro.conf.subcommand("list")]
    | Annotated[Show, tyro.conf.subcommand("show")]
)


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and leave with its exit code."""
    sys.exit(run(arguments))


def run(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code. Wrong usage raises SystemExit(2)."""
    options = (tyro.conf.FlagCreatePairsOff,)
    command = tyro.cli(Command, args=arguments, prog="factory", description=__doc__, config=options)
    actions: dict[type, Callable[..., int]] = {Build: _build, Check: _check, List: _list, Show: _show}
    try:
        return actions[type(command)](command)
    except AssetFactoryError as error:
        print(f"factory: {error}", file=sys.stderr)
        return EXIT_USAGE
    except KeyboardInterrupt:
        print("factory: interrupted; what was finished is registered", file=sys.stderr, flush=True)
        # Worker processes follow this one; waiting for their threads would wait for their work.
        os._exit(EXIT_INTERRUPTED)


def _build(command: Build) -> int:
    # Geometry libraries load only to build.
    from .jobs import default_workers, run_builds
    from .mesh import find_inputs
    from .summary import summarize

    config = _build_config(command)
    inputs = find_inputs(command.input)
    Registry(command.output, create=True)
    workers = command.workers if command.workers is not None else default_workers()
    if workers < 1:
        raise ConfigError(f"--workers: is {workers}, want at least 1")
    results = console.follow(run_builds(inputs, command.output, config, workers), len(inputs))
    summary = summarize(results)
    write_json(command.output / "summary.json", summary)
    console.print_results(summary, command.output)
    if summary["unjudged"]:
        return EXIT_UNJUDGED
    return EXIT_REJECTED if command.strict and summary["rejected"] else EXIT_OK


def _build_config(command: Build) -> BuildConfig:
    from .mesh.orientation import parse_up

    config = load_config(command.config)
    if command.articulator not in ARTICULATORS:
        raise ConfigError(f"--articulator: no articulator {command.articulator!r}; there are {', '.join(ARTICULATORS)}")
    if command.height is not None and not command.height > 0.0:
        raise ConfigError(f"--height: is {command.height:g} m, want more than 0")
    up = command.up if command.up == "auto" else parse_up(command.up)
    intake = replace(config.intake, up=up, height=command.height)
    return replace(config, articulator=command.articulator, simulators=_simulators(command.sim), intake=intake)


def _check(command: Check) -> int:
    from asset_factory.sim_checks import run_checks

    simulators, config = _simulators(command.sim), load_config(command.config).checks
    missing = [path for path in command.files if not path.is_file()]
    if missing:
        raise ConfigError(f"{missing[0]}: no such file; want a URDF or an MJCF file")
    reports = [run_checks(path, simulators, config) for path in command.files]
    data: Any = [report.to_dict() for report in reports] if len(reports) > 1 else reports[0].to_dict()
    if command.json is not None and str(command.json) == "-":
        print(json.dumps(data, indent=2))
    else:
        for report in reports:
            console.print_report(report)
        if command.json is not None:
            write_json(command.json, data)
    if not all(report.judged for report in reports):
        return EXIT_UNJUDGED
    return EXIT_REJECTED if command.strict and not all(report.passed for report in reports) else EXIT_OK


def _list(command: List) -> int:
    entries = Registry(command.output).entries()
    if command.json:
        print(json.dumps([asdict(entry) for entry in entries], indent=2))
    else:
        console.print_entries(entries)
    return EXIT_OK


def _show(command: Show) -> int:
    registry = Registry(command.output)
    entry = registry.entry(command.id)
    if command.json:
        folder = registry.folder(entry)
        manifest = folder / "asset.json"
        data = {
            **asdict(entry),
            "folder": str(folder),
            "manifest": json.loads(manifest.read_text()) if manifest.is_file() else None,
            "report": registry.report(entry).to_dict(),
        }
        print(json.dumps(data, indent=2))
    else:
        console.print_entry(entry, registry.folder(entry), registry.report(entry))
    return EXIT_OK


def _simulators(names: str) -> tuple[str, ...]:
    if names == "all":
        return tuple(SIMULATORS)
    chosen = tuple(dict.fromkeys(name.strip() for name in names.split(",") if name.strip()))
    unknown = [name for name in chosen if name not in SIMULATORS]
    if unknown:
        raise ConfigError(f"--sim: no simulator {unknown[0]!r}; there are {', '.join(SIMULATORS)}, or 'all'")
    return chosen


if __name__ == "__main__":
    main()
