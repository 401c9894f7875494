"""The ``factory`` command: parse, call one function, print."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any

import tyro
from tyro.conf import Positional

from asset_factory.sim_checks.simulators.catalog import SIMULATORS

from . import console
from .articulate.choose import ARTICULATORS
from .config import BuildConfig
from .errors import AssetFactoryError, ConfigError
from .evaluation.command import Evaluate
from .presets import load_config
from .registry import Registry, write_json
from .training.command import Train

EXIT_OK, EXIT_REJECTED, EXIT_USAGE, EXIT_UNJUDGED, EXIT_INTERRUPTED = 0, 1, 2, 3, 130
DEFAULT_SIMULATORS = "sapien"


@dataclass(frozen=True)
class Reading:
    """How inputs are loaded, and who says what moves."""

    articulator: str = "auto"
    """Who says what moves: auto, annotated, geometric, particulate or rigid."""
    checkpoint: str | None = None
    """Weights for particulate, which auto then asks alone: a file, or hf:owner/repository/file."""
    features: str | None = None
    """Weights of its feature extractor, where those want features: a file, or hf:owner/repository/file."""
    points: int | None = None
    """Points that particulate labels per sample."""
    samples: int | None = None
    """Samples that particulate reads; the one that agrees most with the others is taken."""
    up: str = "auto"
    """Axis of the input that points up: x, y, z, -x, -y, -z, or auto (glTF: y; everything else: z)."""
    height: float | None = None
    """Real height to scale every input to [m]."""
    config: str = "default"
    """A preset (default, fast, lenient, strict) or a TOML file of differences from the defaults."""


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


@dataclass(frozen=True)
class Predict:
    """Say what moves in one input, and how, without making anything of it.

    Exit codes: 0 there is an answer; 1 the input was rejected; 3 no answer came; 2 wrong usage.
    """

    input: Positional[Path]
    """A mesh file, a URDF or an MJCF file."""
    json: bool = False
    """Print JSON."""
    reading: tyro.conf.OmitArgPrefixes[Reading] = field(default_factory=Reading)
    """How it is loaded, and who says what moves."""


@dataclass(frozen=True)
class Check:
    """Judge URDF or MJCF files, anyone's.

    Exit codes: 0 every file got a verdict; 3 some file could not be judged; 2 wrong usage;
    1 something was rejected and --strict was given.
    """

    files: Positional[tuple[Path, ...]]
    """URDF or MJCF files, or folders of them."""
    sim: str = DEFAULT_SIMULATORS
    """Simulators that judge, separated by commas, or 'all'."""
    json: Path | None = None
    """Where to write the report; a list of reports for several files or a folder. '-' prints it."""
    config: str = "default"
    """A preset (default, fast, lenient, strict) or a TOML file of differences from the defaults."""
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


@dataclass(frozen=True)
class WeightsInfo:
    """Say which network a checkpoint is for, its sizes, and the terms of the published weights."""

    checkpoint: Positional[str]
    """A safetensors, .pt or .ckpt file, or hf:owner/repository/file."""


@dataclass(frozen=True)
class WeightsConvert:
    """Write a checkpoint as safetensors, which holds tensors and nothing that could run."""

    checkpoint: Positional[str]
    """A safetensors, .pt or .ckpt file, or hf:owner/repository/file."""
    target: Positional[Path]
    """The file to write; ends in .safetensors."""


@dataclass(frozen=True)
class WeightsCommand:
    """Describe and convert checkpoints of the networks behind particulate."""

    action: (
        Annotated[WeightsInfo, tyro.conf.subcommand("info", prefix_name=False)]
        | Annotated[WeightsConvert, tyro.conf.subcommand("convert", prefix_name=False)]
    )


Command = (
    Annotated[Build, tyro.conf.subcommand("build")]
    | Annotated[Predict, tyro.conf.subcommand("predict")]
    | Annotated[Check, tyro.conf.subcommand("check")]
    | Annotated[List, tyro.conf.subcommand("list")]
    | Annotated[Show, tyro.conf.subcommand("show")]
    | Annotated[WeightsCommand, tyro.conf.subcommand("weights")]
    | Annotated[Evaluate, tyro.conf.subcommand("evaluate")]
    | Annotated[Train, tyro.conf.subcommand("train")]
)


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and leave with its exit code."""
    sys.exit(run(arguments))


def run(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code. Wrong usage raises SystemExit(2)."""
    options = (tyro.conf.FlagCreatePairsOff,)
    command = tyro.cli(Command, args=arguments, prog="factory", description=__doc__, config=options)
    actions: dict[type, Callable[..., int]] = {
        Build: _build,
        Predict: _predict,
        Check: _check,
        List: _list,
        Show: _show,
        WeightsCommand: _weights,
        Evaluate: _evaluate,
        Train: _train,
    }
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
    from asset_factory.sim_checks.isolation import processors

    from .jobs import run_builds
    from .mesh import find_inputs
    from .summary import summarize

    config = _build_config(command)
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
        return EXIT_UNJUDGED
    return EXIT_REJECTED if command.strict and summary["rejected"] else EXIT_OK


def _predict(command: Predict) -> int:
    from asset_factory.sim_checks.isolation import Limits, run_isolated

    from .predict import predict

    config = _reading_config(command.reading)
    if not command.input.is_file():
        raise ConfigError(f"{command.input}: no such file; want a mesh, a URDF or an MJCF file")
    limits = Limits(wall_s=config.asset_wall_s, memory_bytes=config.asset_memory_bytes)
    outcome = run_isolated(predict, command.input, config, limits=limits)
    if isinstance(outcome.error, AssetFactoryError):
        raise outcome.error
    if outcome.value is None:
        print(f"factory: {command.input.name}: {outcome.detail}", file=sys.stderr)
        return EXIT_UNJUDGED
    if command.json:
        print(json.dumps(outcome.value, indent=2))
    else:
        console.print_prediction(outcome.value)
    return EXIT_REJECTED if "rejected" in outcome.value else EXIT_OK


def _build_config(command: Build) -> BuildConfig:
    return replace(_reading_config(command.reading), simulators=_simulators(command.sim))


def _reading_config(reading: Reading) -> BuildConfig:
    from .articulate.settings import require_usable
    from .mesh.orientation import parse_up

    config = load_config(reading.config)
    if reading.articulator not in ARTICULATORS:
        raise ConfigError(f"--articulator: no articulator {reading.articulator!r}; there are {', '.join(ARTICULATORS)}")
    if reading.height is not None and not reading.height > 0.0:
        raise ConfigError(f"--height: is {reading.height:g} m, want more than 0")
    up = reading.up if reading.up == "auto" else parse_up(reading.up)
    intake = replace(config.intake, up=up, height=reading.height)
    asked = ("checkpoint", "features", "points", "samples")
    given: dict[str, Any] = {name: getattr(reading, name) for name in asked if getattr(reading, name) is not None}
    particulate = replace(config.particulate, **given)
    require_usable(particulate, needed=reading.articulator == "particulate")
    return replace(config, articulator=reading.articulator, intake=intake, particulate=particulate)


def _check(command: Check) -> int:
    from asset_factory.sim_checks.isolation import processors
    from asset_factory.sim_checks.judge import Judge

    simulators, config = _simulators(command.sim), load_config(command.config).checks
    files, reports = _described(command.files), []
    printed = command.json is None or str(command.json) != "-"
    with Judge(config, processors()) as judge:
        for path, name in files:
            report = judge.check(path, simulators)
            reports.append(replace(report, description=name or report.description))
            if printed:
                console.print_report(reports[-1])
    data: Any = [report.to_dict() for report in reports]
    data = data if len(data) > 1 or any(path.is_dir() for path in command.files) else data[0]
    if not printed:
        print(json.dumps(data, indent=2))
    elif command.json is not None:
        write_json(command.json, data)
    if not all(report.judged for report in reports):
        return EXIT_UNJUDGED
    return EXIT_REJECTED if command.strict and not all(report.passed for report in reports) else EXIT_OK


def _described(paths: Sequence[Path]) -> list[tuple[Path, str | None]]:
    """Every file to judge; those of a folder with their path in it, which tells one ``asset.urdf`` from another."""
    found: list[tuple[Path, str | None]] = []
    for path in paths:
        if path.is_dir():
            from .mesh.discover import find_inputs, is_description

            inside = [file for file in find_inputs((path,)) if is_description(file)]
            found += [(file, file.relative_to(path).as_posix()) for file in inside]
        elif path.is_file():
            found.append((path, None))
        else:
            raise ConfigError(f"{path}: no such file; want a URDF or an MJCF file, or a folder of them")
    if not found:
        where = f"in {', '.join(map(str, paths))}" if paths else "given"
        raise ConfigError(f"no URDF or MJCF file {where}; want at least one")
    return found


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


def _weights(command: WeightsCommand) -> int:
    from .particulate.weights.checkpoint import convert, describe
    from .particulate.weights.sources import fetch

    wanted = command.action
    source = fetch(wanted.checkpoint)
    console.print_weights(convert(source, wanted.target) if isinstance(wanted, WeightsConvert) else describe(source))
    return EXIT_OK


def _evaluate(command: Evaluate) -> int:
    from .evaluation.command import evaluate

    return EXIT_OK if evaluate(command) else EXIT_UNJUDGED


def _train(command: Train) -> int:
    from .training.command import printed_recipe, train

    recipe = printed_recipe(command)
    if recipe is not None:
        print(recipe, end="")
        return EXIT_OK
    return EXIT_OK if train(command) else EXIT_INTERRUPTED


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
