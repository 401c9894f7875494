"""Flags that several commands share: how inputs are loaded, and what validates them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any, Protocol, TypeVar

import tyro

from asset_factory.sim_checks import Status
from asset_factory.sim_checks.simulators.catalog import SIMULATORS, USUAL

from ..articulate.catalog import ARTICULATORS
from ..config import REPAIR_KINDS, BuildConfig
from ..errors import AssetFactoryError, ConfigError
from ..presets import load_config
from ..registry import Entry, Registry
from ..registry.entry import SOLVED
from ..registry.rows import Filters
from ..registry.split import SPLITS
from ..runtime.terminal import complain

DEFAULT_SIMULATORS = "sapien"
T = TypeVar("T")


@dataclass(frozen=True)
class InputFlags:
    """How inputs are loaded, and who says what moves."""

    articulator: str = "auto"
    """Who says what moves: auto, stated, annotated, geometric, seams, particulate, vlm or rigid."""
    checkpoint: str | None = None
    """Weights for particulate, which auto then asks alone: a file,
    hf:owner/repository/file@commit, or paper: those published, which are fetched."""
    features: str | None = None
    """Weights of its feature extractor, if it needs one: a file, or
    hf:owner/repository/file@commit."""
    points: int | None = None
    """Points that particulate labels per sample."""
    samples: int | None = None
    """Samples that particulate reads; the one that agrees most with the others is taken."""
    vlm_url: str | None = None
    """With --articulator vlm: an endpoint of OpenAI's chat-completions protocol, such as
    http://localhost:8000/v1; pictures of inputs go there. Its key: ASSET_FACTORY_VLM_KEY."""
    vlm_model: str | None = None
    """The model's name there."""
    up: str = "auto"
    """Axis of the input that points up: x, y, z, -x, -y, -z, or auto (glTF: y; all others: z)."""
    height: float | None = None
    """Real height to scale every input to [m]."""
    config: str = "default"
    """A preset (default, fast, lenient, strict) or a TOML file of differences from the defaults."""


@dataclass(frozen=True)
class EntryFilters:
    """Which assets."""

    status: str | None = None
    """passed, rejected or unjudged."""
    category: str | None = None
    """Of the object."""
    reason: str | None = None
    """Code of the first finding that is an error."""
    tag: str | None = None
    """One of their tags."""
    split: str | None = None
    """train or test."""
    solved: str | None = None
    """yes or no: whether a robot opened one of their joints."""
    license: Annotated[str | None, tyro.conf.arg(aliases=["--licence"])] = None
    """Of the input."""
    gpu_ready: bool = False
    """Only those that PhysX takes on a GPU: up to 64 hulls a link, of 64 corners, of aspect 64."""

    def filters(self, **defaults: str) -> Filters:
        """Return the same for the registry. Raises ConfigError for what no asset can be."""
        values = {
            **defaults,
            **{name: value for name, value in asdict(self).items() if isinstance(value, str)},
            **({"gpu_ready": "yes"} if self.gpu_ready else {}),
        }
        for name, known in (("status", tuple(Status)), ("split", SPLITS), ("solved", SOLVED[1:])):
            if name in values and values[name] not in known:
                raise ConfigError(f"--{name}: is {values[name]!r}, want one of {', '.join(known)}")
        return Filters(**values)


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

    wanted: tyro.conf.OmitArgPrefixes[EntryFilters] = field(default_factory=EntryFilters)
    """Which assets; those that passed, if no status is given."""

    def entries(self) -> Iterator[Entry]:
        """Yield the assets that are wanted. Raises ConfigError for what no asset can be."""
        return Registry(self.output).walk(self.wanted.filters(status="passed"))


def input_config(flags: InputFlags) -> BuildConfig:
    """Return the configuration that flags ask for. Raises ConfigError: a bad flag."""
    from ..articulate.asking.endpoint import require_endpoint
    from ..articulate.settings import require_usable
    from ..intake.orientation import parse_up

    config = load_config(flags.config)
    if flags.articulator not in ARTICULATORS:
        raise ConfigError(
            f"--articulator: no articulator {flags.articulator!r}; "
            f"there are {', '.join(ARTICULATORS)}"
        )
    if flags.height is not None and not flags.height > 0.0:
        raise ConfigError(f"--height: is {flags.height:g} m, want more than 0")
    up = flags.up if flags.up == "auto" else parse_up(flags.up)
    intake = replace(config.intake, up=up, height=flags.height)
    asked = ("checkpoint", "features", "points", "samples")
    given: dict[str, Any] = {
        name: getattr(flags, name) for name in asked if getattr(flags, name) is not None
    }
    particulate = replace(config.particulate, **{**given, **_published(flags)})
    require_usable(particulate, needed=flags.articulator == "particulate")
    vlm = replace(config.vlm, url=flags.vlm_url or config.vlm.url)
    vlm = replace(vlm, model=flags.vlm_model or vlm.model)
    require_endpoint(vlm, needed=flags.articulator == "vlm")
    return replace(
        config, articulator=flags.articulator, intake=intake, particulate=particulate, vlm=vlm
    )


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
    """Parse simulators, comma-separated, or ``all``. Raises ConfigError that names all known."""
    if names == "all":
        return USUAL
    chosen = tuple(dict.fromkeys(name.strip() for name in names.split(",") if name.strip()))
    unknown = [name for name in chosen if name not in SIMULATORS]
    if unknown:
        raise ConfigError(
            f"--sim: no simulator {unknown[0]!r}; there are {', '.join(SIMULATORS)}, or 'all'"
        )
    return chosen


def with_repairs(config: BuildConfig, kinds: str | None) -> BuildConfig:
    """Set what ``--repairs`` asks for; ``None``: as configured. Raises ConfigError."""
    if kinds is None:
        return config
    if kinds not in REPAIR_KINDS:
        raise ConfigError(f"--repairs: is {kinds!r}, want one of {', '.join(REPAIR_KINDS)}")
    return replace(config, repair=replace(config.repair, kinds=kinds))


def formats_asked(names: str) -> tuple[str, ...]:
    """Parse formats, comma-separated. Raises ConfigError: one is unknown or not installed."""
    from ..export.formats import formats_named

    asked = tuple(name.strip() for name in names.split(",") if name.strip())
    return tuple(each.name for each in formats_named(asked))


def workers_fitting(asked: int | None, each: int) -> int:
    """Return how many workers to start: ``--workers``, or fewer (said) if memory is short.

    Args:
        asked: ``None``: as many as there are processors.
        each: what one may need [bytes].

    Raises:
        ConfigError: fewer than one is asked for.
    """
    from ..jobs.memory import workers_for

    if asked is not None and asked < 1:
        raise ConfigError(f"--workers: is {asked}, want at least 1")
    workers, sentence = workers_for(asked, each)
    if sentence is not None:
        complain(f"factory: {sentence}")
    return workers


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


def require_maniskill(purpose: str, *modules: str) -> None:
    """Raise ConfigError unless ManiSkill, and further modules, can be imported."""
    try:
        for module in ("mani_skill", *modules):
            import_module(module)
    except ImportError as error:
        hint = "pip install 'asset-factory[maniskill]'"
        raise ConfigError(f"{purpose} ManiSkill ({error}); {hint}") from error


class Effort(Protocol):
    """Flags of commands that have a robot try something."""

    @property
    def seed(self) -> int:
        """Return the seed of the first episode."""

    @property
    def timeout(self) -> float:
        """Return the longest that one attempt may take [s]."""


def check_effort(command: Effort, counts: Sequence[str]) -> None:
    """Raise ConfigError unless flags in ``counts`` are at least 1, and seed and timeout valid."""
    for name in counts:
        if getattr(command, name) < 1:
            raise ConfigError(
                f"--{name.replace('_', '-')}: is {getattr(command, name)}, want at least 1"
            )
    if command.seed < 0:
        raise ConfigError(f"--seed: is {command.seed}, want 0 or more")
    if not command.timeout > 0.0:
        raise ConfigError(f"--timeout: is {command.timeout:g} s, want more than 0")
