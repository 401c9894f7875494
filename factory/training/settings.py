"""What a training run does, from a TOML file."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, field, replace
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from ..errors import ConfigError
from ..particulate.components import COMPONENT_FEATURES
from ..particulate.network.shape import NetworkShape
from ..presets import overlay
from .bounds import require_within
from .losses import LossSettings
from .sample import DrawSettings
from .schedule import ScheduleSettings

KINDS = (
    "procedural",
    "specimens",
    "description",
    "partnet",
    "particulate",
    "predictions",
    "registry",
    "usd",
)
FEATURES = ("none", "components")
PRECISIONS = ("float32", "bfloat16")


@dataclass(frozen=True)
class DataSource:
    """Where examples come from.

    Attributes:
        kind: one of ``KINDS``; ``specimens``: a folder of npz files; ``procedural``: made on the
            fly.
        path: the folder, for every kind but ``procedural``; a relative one is taken from the
            working folder.
        split: file with the names to take, one per line; empty: all of them.
        weight: how often it is drawn from, relative to the other sources.
        objects: procedural: how many different ones; 0: ever new ones.
        reuse: procedural: examples drawn from each object before a new one is made.
        points: procedural: pooled per object, of which each example takes some.
        style: procedural: what differs from the defaults of ``MixtureSettings``.
        options: other kinds: what differs from the defaults of ``SourceSettings``.
    """

    kind: str = "specimens"
    path: str = ""
    split: str = ""
    weight: float = 1.0
    objects: int = 0
    reuse: int = 8
    points: int = 8192
    style: dict[str, Any] = field(default_factory=dict)
    options: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class NetworkSettings:
    """Sizes of the network.

    Attributes:
        hidden, blocks, heads, mlp_ratio, raw_coords, max_parts: see ``NetworkShape``.
        features: of a point beside place and normal: ``none``, or ``components``, what its
            connected component looks like.
        dropout: in training.
        quiet_start: weights on the fast sinusoids, those that turn by more than ``quiet_below`` per
            unit of length, start the smaller the faster they are: a short training has no use for
            them.
        quiet_below: [rad per unit of length].
    """

    hidden: int = 768
    blocks: int = 6
    heads: int = 12
    mlp_ratio: int = 4
    raw_coords: bool = True
    max_parts: int = 16
    features: str = "none"
    dropout: float = 0.0
    quiet_start: bool = False
    quiet_below: float = 30.0

    @property
    def shape(self) -> NetworkShape:
        """As the network wants them."""
        return NetworkShape(
            hidden=self.hidden,
            blocks=self.blocks,
            heads=self.heads,
            mlp_ratio=self.mlp_ratio,
            raw_coords=self.raw_coords,
            max_parts=self.max_parts,
            features=COMPONENT_FEATURES if self.features == "components" else 0,
        )


@dataclass(frozen=True)
class OptimiserSettings:
    """AdamW and what is around it.

    Attributes:
        betas: decay of its two means.
        weight_decay: of matrices; norms and biases are left alone.
        clip: largest norm of the gradient; 0: any.
        ema: decay of the running mean of the weights, which is what is shipped; less in the first
            steps.
    """

    betas: tuple[float, float] = (0.9, 0.98)
    weight_decay: float = 0.02
    clip: float = 1.0
    ema: float = 0.999


@dataclass(frozen=True)
class RunSettings:
    """How the work is done, which the result does not depend on, but for rounding.

    Attributes:
        micro_batch: samples that go through the network at once; gradients of a step's add up. 0:
            all of them.
        workers: processes per trainer that draw samples; 0: none, samples are drawn between the
            steps.
        threads: of a trainer on the CPU; 0: as torch decides.
        device: ``auto``, ``cpu``, ``cuda`` or ``cuda:<n>``.
        precision: of the products on a GPU: ``float32`` or ``bfloat16``.
        compile: have torch compile the blocks, on a GPU.
        ahead: steps whose samples wait drawn.
        cache_mb: memory that each worker keeps specimens in [MB].
        cache: folder that other formats are converted into, once for all runs; empty: the run's
            own.
        log_every: steps per line of the log.
        checkpoint_every: steps per checkpoint.
        validate_every: steps per validation; 0: only at the end.
    """

    micro_batch: int = 0
    workers: int = 1
    threads: int = 0
    device: str = "auto"
    precision: str = "bfloat16"
    compile: bool = False
    ahead: int = 4
    cache_mb: int = 1024
    cache: str = ""
    log_every: int = 50
    checkpoint_every: int = 500
    validate_every: int = 1000


@dataclass(frozen=True)
class ValidationSettings:
    """The held-out examples.

    Attributes:
        objects: at most so many, evenly spread over those there are.
        points: of each.
        batch: samples at once.
    """

    objects: int = 64
    points: int = 1024
    batch: int = 16


@dataclass(frozen=True)
class TrainConfig:
    """A training run.

    Attributes:
        data: sources of examples.
        held_out: sources of validation examples; none: no validation.
        seed: of everything; a sample depends on it, the step and its place in the step alone.
        batch: samples per step, over all processes.
        lanes: streams of procedural objects; a worker takes whole ones, so at least as many as
            workers.
        half: write the weights as float16.
        recipe: a name for the run.
        terms: under which the weights may be used, with the sources of the data; written into the
            file.
    """

    data: tuple[DataSource, ...] = ()
    held_out: tuple[DataSource, ...] = ()
    seed: int = 0
    batch: int = 128
    lanes: int = 16
    half: bool = False
    recipe: str = "paper"
    terms: str = ""
    draw: DrawSettings = field(default_factory=DrawSettings)
    network: NetworkSettings = field(default_factory=NetworkSettings)
    loss: LossSettings = field(default_factory=LossSettings)
    schedule: ScheduleSettings = field(default_factory=ScheduleSettings)
    optimiser: OptimiserSettings = field(default_factory=OptimiserSettings)
    validation: ValidationSettings = field(default_factory=ValidationSettings)
    run: RunSettings = field(default_factory=RunSettings)

    def draw_at(self, step: int) -> DrawSettings:
        """How the samples of a step are drawn."""
        points = self.schedule.points_at(step, self.draw.points)
        return replace(self.draw, points=points, components=self.network.features == "components")

    @property
    def validation_draw(self) -> DrawSettings:
        """How validation examples are drawn: as the training's, but all upright, whole and unstretched."""
        return replace(
            self.draw_at(0), points=self.validation.points, fused_share=0.0, merged_share=0.0
        )


def recipe_names() -> tuple[str, ...]:
    """The recipes that come with the package."""
    names = (entry.name for entry in _shipped().iterdir())
    return tuple(sorted(name.removesuffix(".toml") for name in names if name.endswith(".toml")))


def load_train_config(recipe: str) -> TrainConfig:
    """The configuration of a recipe.

    Args:
        recipe: the name of a shipped one, or the path of a TOML file.

    Raises:
        ConfigError: no such recipe, unreadable TOML, a setting that does not exist or cannot be.
    """
    return parse_train_config(recipe_text(recipe), recipe)


def recipe_text(recipe: str) -> str:
    """The TOML of a recipe.

    Raises:
        ConfigError: there is no such recipe.
    """
    try:
        if recipe in recipe_names():
            return (_shipped() / f"{recipe}.toml").read_text(encoding="utf-8")
        if recipe.endswith(".toml"):
            return Path(recipe).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(f"recipe {recipe!r}: {error}") from error
    raise ConfigError(
        f"no recipe {recipe!r}; there are {', '.join(recipe_names())}, or a path to a .toml file"
    )


def parse_train_config(text: str, where: str) -> TrainConfig:
    """A configuration from TOML; what it leaves out is as the defaults say.

    Raises:
        ConfigError: see :func:`load_train_config`.
    """
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ConfigError(f"{where}: {error}") from error
    data, held_out = (
        _sources(table.pop(name, []), f"{where}: {name}") for name in ("data", "held_out")
    )
    config = replace(overlay(TrainConfig(), table, where), data=data, held_out=held_out)
    _check(config, where)
    return config


def _shipped() -> Traversable:
    return resources.files("asset_factory") / "configs" / "train"


def _sources(tables: Any, where: str) -> tuple[DataSource, ...]:
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise ConfigError(f"{where}: want [[{where.rpartition(' ')[2]}]] tables, each with a kind")
    free = ("style", "options")
    found = []
    for number, table in enumerate(tables, start=1):
        at = f"{where} {number}"
        for name in free:
            if not isinstance(table.get(name, {}), dict):
                raise ConfigError(f"{at}: {name}: is {table[name]!r}, want a table of settings")
        plain = {name: value for name, value in table.items() if name not in free}
        source = overlay(DataSource(), plain, at)
        if "kind" not in table or source.kind not in KINDS:
            raise ConfigError(f"{at}: kind is {table.get('kind')!r}; there are {', '.join(KINDS)}")
        if source.kind != "procedural" and not source.path:
            raise ConfigError(f"{at}: {source.kind} wants a path")
        found.append(replace(source, **{name: table[name] for name in free if name in table}))
    return tuple(found)


def _check(config: TrainConfig, where: str) -> None:
    network = config.network
    if network.features == "partfield":
        raise ConfigError(
            f"{where}: network.features: PartField is not computed while training; want 'none' or 'components', "
            "which need no other network"
        )
    allowed = {
        "network.features": (network.features, FEATURES),
        "run.precision": (config.run.precision, PRECISIONS),
    }
    for name, (value, values) in allowed.items():
        if value not in values:
            raise ConfigError(
                f"{where}: {name}: is {value!r}, want {' or '.join(map(repr, values))}"
            )
    require_within(config, where)
    if network.hidden % network.heads:
        raise ConfigError(
            f"{where}: network.heads: {network.heads} do not divide the width {network.hidden}"
        )
    if not config.data:
        raise ConfigError(
            f"{where}: no [[data]]; want at least one source, of kind {', '.join(KINDS)}"
        )
