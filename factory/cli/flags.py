"""Flags that several commands share: how inputs are loaded, and what validates them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any, TypeVar

import tyro

from asset_factory.sim_checks import Status
from asset_factory.sim_checks.read.roots import ReadOptions, ros_package_path
from asset_factory.sim_checks.read.xacro import parse_arguments
from asset_factory.sim_checks.simulators.catalog import SIMULATORS, USUAL, install_line, installed

from ..articulate.catalog import ARTICULATORS
from ..config import REPAIR_KINDS, BuildConfig, ParticulateConfig
from ..errors import AssetFactoryError, ConfigError
from ..presets import load_config
from ..registry import Entry, Registry
from ..registry.where import wanted
from ..runtime.terminal import complain

DEFAULT_SIMULATORS = "sapien"
T = TypeVar("T")
#: An asset, and any number of them, as commands take them.
AssetId = tyro.conf.Positional[Annotated[str, tyro.conf.arg(metavar="ID")]]
_IDS = tyro.conf.arg(metavar="[ID ...]", help_behavior_hint="")
AssetIds = tyro.conf.Positional[Annotated[tuple[str, ...], _IDS]]


@dataclass(frozen=True)
class RootFlags:
    """Which files descriptions may refer to, beside their own folder and its package."""

    root: Annotated[tuple[Path, ...], tyro.conf.UseAppendAction] = ()
    """A folder that URDF and MJCF may refer to, beside inputs and ROS_PACKAGE_PATH."""
    allow_outside: bool = False
    """Let descriptions refer to any file on this machine: only for those whose author you trust."""
    xacro_arg: Annotated[tuple[str, ...], tyro.conf.UseAppendAction] = ()
    """An argument of xacro files, name:=value."""

    def folders(self) -> tuple[Path, ...]:
        """Return the roots. Raises ConfigError: one is no folder."""
        for folder in self.root:
            if not folder.is_dir():
                raise ConfigError(f"--root: {folder} is no folder")
        return tuple(folder.absolute() for folder in self.root)

    def options(self, given: Sequence[Path] = ()) -> ReadOptions:
        """Return the same for a reader, with the folders in which inputs were looked for."""
        found = (folder.absolute() for folder in given if folder.is_dir())
        roots = (*self.folders(), *found, *ros_package_path())
        return ReadOptions(roots, self.allow_outside, self.arguments())

    def arguments(self) -> tuple[str, ...]:
        """Return what xacro files are given. Raises ConfigError: it is no ``name:=value``."""
        try:
            parse_arguments(self.xacro_arg)
        except ValueError as error:
            raise ConfigError(f"--xacro-arg: {error}") from error
        return self.xacro_arg


@dataclass(frozen=True)
class InputFlags:
    """How inputs are loaded and articulated."""

    articulator: str = "auto"
    """Proposes joints: auto, stated, annotated, geometric, particulate, vlm or rigid."""
    checkpoint: str | None = None
    """Weights of particulate: a file, hf:owner/repository/file@commit, or paper (as published)."""
    features: str | None = None
    """Weights of its feature extractor, if any: a file, or hf:owner/repository/file@commit."""
    points: int | None = None
    """Points that particulate labels per sample."""
    samples: int | None = None
    """Samples that particulate reads; the one that agrees most with the others is taken."""
    device: str | None = None
    """Where networks run: auto (a GPU if there is one), cpu, cuda, cuda:N or mps."""
    vlm_url: str | None = None
    """With --articulator vlm: a chat-completions URL, .../v1; its key: ASSET_FACTORY_VLM_KEY."""
    vlm_model: str | None = None
    """The model's name there."""
    up: str = "auto"
    """Axis that points up: x, y, z, -x (as --up=-x), -y, -z, or auto (glTF: y; all others: z)."""
    height: float | None = None
    """Real height to scale every input to [m]."""
    config: str = "default"
    """A preset (default, fast, lenient, strict) or a TOML file of differences from the defaults."""
    roots: tyro.conf.OmitArgPrefixes[RootFlags] = field(default_factory=RootFlags)
    """Which files descriptions may refer to."""


@dataclass(frozen=True, kw_only=True)
class OfRegistry:
    """A command on a registry."""

    output: Path
    """The registry's folder."""


@dataclass(frozen=True, kw_only=True)
class Printed:
    """A command that prints."""

    json: bool = False
    """Print JSON."""


@dataclass(frozen=True, kw_only=True)
class OfPassed(OfRegistry):
    """A command on some assets of a registry."""

    where: str = ""
    """Which assets, such as "category = fridge and joints > 1"; by default those that passed."""

    def entries(self) -> Iterator[Entry]:
        """Yield the assets that are wanted. Raises ConfigError for what no asset can be."""
        registry = Registry(self.output)
        return registry.walk(wanted(registry, self.where, status=Status.PASSED))


def input_config(flags: InputFlags, *, here: bool = True) -> BuildConfig:
    """Return the configuration that flags ask for, of work ``here`` or on other machines.

    Raises ConfigError: a bad flag.
    """
    from ..articulate.asking.endpoint import require_endpoint
    from ..articulate.settings import require_usable
    from ..intake.orientation import parse_up

    config = load_config(flags.config)
    if flags.articulator not in ARTICULATORS:
        known = ", ".join(ARTICULATORS)
        raise ConfigError(f"--articulator: no articulator {flags.articulator!r}; there are {known}")
    if flags.height is not None and not flags.height > 0.0:
        raise ConfigError(f"--height must be more than 0, not {flags.height:g} m")
    up = flags.up if flags.up == "auto" else parse_up(flags.up)
    intake = replace(
        config.intake,
        up=up,
        height=flags.height,
        roots=(*config.intake.roots, *map(str, flags.roots.folders())),
        given=tuple(map(str, ros_package_path())),
        allow_outside=config.intake.allow_outside or flags.roots.allow_outside,
        arguments=(*config.intake.arguments, *flags.roots.arguments()),
    )
    network = given(flags, "checkpoint", "features", "points", "samples", "device")
    particulate = replace(config.particulate, **{**network, **_published(flags)})
    particulate = on_device(particulate, here=here)
    require_usable(particulate, needed=flags.articulator == "particulate")
    vlm = replace(config.vlm, url=flags.vlm_url or config.vlm.url)
    vlm = replace(vlm, model=flags.vlm_model or vlm.model)
    if flags.articulator == "vlm":
        require_endpoint(vlm)
    return replace(
        config, articulator=flags.articulator, intake=intake, particulate=particulate, vlm=vlm
    )


def given(flags: object, *names: str) -> dict[str, Any]:
    """Return those of the flags that were given, by name."""
    asked = {name: getattr(flags, name) for name in names}
    return {name: value for name, value in asked.items() if value is not None}


def on_device(config: ParticulateConfig, *, here: bool = True) -> ParticulateConfig:
    """Return settings that name a device, not ``auto``.

    Raises ConfigError: there is none of that name, or the network does not run on it ``here``.
    """
    from ..models.particulate.device import device_for, works

    if not re.fullmatch(r"auto|cpu|cuda(:\d+)?|mps", config.device):
        raise ConfigError(f"--device must be auto, cpu, cuda, cuda:N or mps, not {config.device!r}")
    device = device_for(config.device)
    if here and not works(device):
        raise ConfigError(f"--device: torch finds no {device} here that works; want auto or cpu")
    return replace(config, device=device)


def _published(flags: InputFlags) -> dict[str, str]:
    """Return settings for the published weights, if asked for; say their terms before a fetch."""
    from ..models.weights.sources import PAPER, PARTFIELD, PARTICULATE

    if flags.checkpoint != PAPER:
        return {}
    named = {"checkpoint": PARTICULATE.source, "features": flags.features or PARTFIELD.source}
    for weights in (PARTICULATE, PARTFIELD):
        if weights.source in named.values():
            complain(f"factory: {weights.source}: {weights.terms}")
    return named


def simulators_named(names: str) -> tuple[str, ...]:
    """Parse simulators, comma-separated, or ``all``.

    Raises:
        ConfigError: one is unknown, or not installed; says what there is, or what installs it.
    """
    said = USUAL if names == "all" else names.split(",")
    chosen = tuple(dict.fromkeys(name.strip() for name in said if name.strip()))
    unknown = [name for name in chosen if name not in SIMULATORS]
    if unknown:
        known = ", ".join(SIMULATORS)
        raise ConfigError(f"--sim: no simulator {unknown[0]!r}; there are {known}, or 'all'")
    missing = [name for name in chosen if not installed(name)]
    if missing:
        there = ", ".join(name for name in SIMULATORS if installed(name)) or "none"
        advice = f"{install_line(missing[0])}; of the others there is {there}"
        raise ConfigError(f"--sim: {missing[0]} is not installed: {advice}")
    return chosen


def with_repairs(config: BuildConfig, kinds: str | None) -> BuildConfig:
    """Set what ``--repairs`` asks for; ``None``: as configured. Raises ConfigError."""
    if kinds is None:
        return config
    if kinds not in REPAIR_KINDS:
        raise ConfigError(f"--repairs must be one of {', '.join(REPAIR_KINDS)}, not {kinds!r}")
    return replace(config, repair=replace(config.repair, kinds=kinds))


def formats_asked(names: str) -> tuple[str, ...]:
    """Parse formats, comma-separated. Raises ConfigError: one is unknown or not installed."""
    from ..export.formats import formats_named

    asked = tuple(name.strip() for name in names.split(",") if name.strip())
    return tuple(each.name for each in formats_named(asked))


def in_own_process(
    function: Callable[..., T], file: Path, *others: object, limits: BuildConfig
) -> T | None:
    """Call a function of a file in a child process, within the limits on one asset.

    Returns what it returned; ``None`` where no answer came, which is said.
    Raises AssetFactoryError: what it raised.
    """
    from asset_factory.sim_checks.processes.isolation import Limits, run_isolated

    bounds = Limits(wall_s=limits.asset_wall_s, memory_bytes=limits.asset_memory_bytes)
    outcome = run_isolated(function, file, *others, limits=bounds)
    if isinstance(outcome.error, AssetFactoryError):
        raise outcome.error
    if outcome.value is None:
        complain(f"factory: {file.name}: {outcome.detail}")
    return outcome.value


def require_writable(folder: Path, flag: str) -> None:
    """Make a folder now, as finding out after hours that nothing can be written loses the work.

    Raises ConfigError naming the flag.
    """
    from tempfile import TemporaryFile

    try:
        folder.mkdir(parents=True, exist_ok=True)
        with TemporaryFile(dir=folder):
            pass
    except OSError as error:
        why = f"{error.strerror}; want a folder that can be written to"
        raise ConfigError(f"{flag}: {folder}: {why}") from error


def require_files(*paths: Path | None) -> None:
    """Raise ConfigError for a file that could not be written after the work; ``-`` is none."""
    for path in paths:
        if path is not None and str(path) != "-" and (path.is_dir() or not path.parent.is_dir()):
            raise ConfigError(f"{path}: cannot be written; want a file in a folder that is there")


def require_maniskill(purpose: str, *modules: str) -> None:
    """Raise ConfigError unless ManiSkill, and further modules, can be imported."""
    try:
        for module in ("mani_skill", *modules):
            import_module(module)
    except ImportError as error:
        hint = "pip install 'asset-factory[maniskill]'"
        raise ConfigError(f"{purpose} ManiSkill ({error}); {hint}") from error


def require_page(port: int) -> None:
    """Raise ConfigError where no page can be served: no such port, or a library is missing."""
    from ..report.pages import require_libraries

    if not 0 <= port < 2**16:
        raise ConfigError(f"--port must be 0 to 65535, not {port}")
    require_libraries()


def check_effort(command: Any, counts: Sequence[str], seed: str = "seed") -> None:
    """Raise ConfigError unless flags in ``counts`` are at least 1, and seed and timeout valid."""
    least = dict.fromkeys(counts, 1) | {seed: 0}
    for name, lowest in least.items():
        number = getattr(command, name)
        if number is not None and number < lowest:
            flag = name.replace("_", "-")
            raise ConfigError(f"--{flag} must be at least {lowest}, not {number}")
    if not command.timeout > 0.0:
        raise ConfigError(f"--timeout must be more than 0, not {command.timeout:g} s")
