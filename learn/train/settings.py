"""What a training run does: its settings."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Annotated, Any

from msgspec import Meta

from asset_factory.factory.models.network.shape import AxisForm, NetworkShape
from asset_factory.factory.models.particulate.components import COMPONENT_FEATURES

from ..bounds import Amount, Count, Share, Whole
from ..samples.sample import DrawSettings

FEATURES = ("none", "components")
PRECISIONS = ("float32", "bfloat16")
#: Of a running mean, and of units in training: below 1, or nothing new would ever be learnt.
Decay = Annotated[float, Meta(ge=0.0, le=0.99999)]
Dropout = Annotated[float, Meta(ge=0.0, le=0.99)]


@dataclass(frozen=True)
class DataSource:
    """Where examples come from.

    Attributes:
        kind: ``procedural``: made on the fly; ``sampled``: a folder of npz files; or a kind of
            dataset.
        path: the folder, for every kind but ``procedural``; a relative one is taken from the
            working folder.
        split: file with the names to take, one per line; empty: all of them.
        weight: how often it is drawn from, relative to the other sources.
        reuse: procedural: examples drawn from each object before a new one is made.
        points: procedural: pooled per object, of which each example takes some.
        style: procedural: what differs from the defaults of ``MixtureSettings``.
        options: other kinds: what differs from the defaults of ``SourceSettings``.
    """

    kind: str = "sampled"
    path: str = ""
    split: str = ""
    weight: Annotated[float, Meta(ge=1e-9, le=1e9)] = 1.0
    reuse: Count = 8
    points: Count = 8192
    style: dict[str, Any] = field(default_factory=dict)
    options: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class NetworkSettings:
    """Sizes of the network.

    Attributes:
        hidden, blocks, heads, mlp_ratio, raw_coords, max_parts: see ``NetworkShape``.
        features: of a point beside place and normal: ``none``, or ``components``, what its
            connected component looks like.
        axes: ``per_point_closest``: every point votes for where its part's axis is; or
            ``per_part_plucker``: its part says so once, by a moment. See ``AxisForm``.
        dropout: in training.
        quiet_start: weights on the fast sinusoids, those that turn by more than ``quiet_below`` per
            unit of length, start the smaller the faster they are: a short training has no use for
            them.
        quiet_below: [rad per unit of length].
    """

    hidden: Count = 768
    blocks: Count = 6
    heads: Count = 12
    mlp_ratio: Count = 4
    raw_coords: bool = True
    max_parts: Annotated[int, Meta(ge=2)] = 16
    features: str = "none"
    axes: str = AxisForm.CLOSEST_POINTS.value
    dropout: Dropout = 0.0
    quiet_start: bool = False
    quiet_below: float = 30.0

    @property
    def shape(self) -> NetworkShape:
        """Return the sizes as the network wants them."""
        same = ("hidden", "blocks", "heads", "mlp_ratio", "raw_coords", "max_parts")
        sizes: dict[str, Any] = {name: getattr(self, name) for name in same}
        features = COMPONENT_FEATURES if self.features == "components" else 0
        return NetworkShape(**sizes, features=features, axis_form=AxisForm(self.axes))


@dataclass(frozen=True)
class LossSettings:
    """Weights of the losses, and what they apply to; the paper's where it names them.

    It names neither Dice nor auxiliary losses.

    Attributes:
        mask: cross-entropy of each point's part.
        dice: soft overlap of points and parts.
        hierarchy: binary cross-entropy of who is whose parent.
        motion: cross-entropy of the motion class.
        revolute_direction, prismatic_direction: distance of directions, not normalised.
        revolute_range, prismatic_range: distance of limits.
        closest_points: distance of the nearest points on the axes; of a network that says axes by
            their moments, distance of those.
        auxiliary: cross-entropy of each point's part after every block but the last.
        auxiliary_points: one in so many points takes part in it.
        root_first: the base always answers to query 0.
        sign_free: where a range reads the same from both ends, the opposite direction is as good.
        unseen_parts: parts of which no point was drawn teach too.
        upright_axes: every axis of rotation is taught by the one of its two directions whose
            largest coordinate is positive, and its limits to suit: the same joint. Which way a door
            opens is then for the limits alone to say; where it cannot be told, a direction would be
            torn between two opposite ones, and learnt as neither.
    """

    mask: Amount = 1.0
    dice: Amount = 0.0
    hierarchy: Amount = 1.0
    motion: Amount = 1.0
    revolute_direction: Amount = 1.0
    prismatic_direction: Amount = 1.0
    revolute_range: Amount = 0.1
    prismatic_range: Amount = 1.0
    closest_points: Amount = 1.0
    auxiliary: Amount = 0.0
    auxiliary_points: Count = 4
    root_first: bool = False
    sign_free: bool = False
    unseen_parts: bool = True
    upright_axes: bool = False


@dataclass(frozen=True)
class ScheduleSettings:
    """Steps and rates.

    Attributes:
        steps: of the whole run.
        rate: highest learning rate.
        warm_up: steps in which it rises from 0.
        last_rate: share of it that is left at the end of the cosine.
    """

    steps: Count = 100_000
    rate: Share = 1e-4
    warm_up: Whole = 1000
    last_rate: Share = 0.01

    def rate_at(self, step: int) -> float:
        """Return the rate of a step, counted from 0: a line up, then half a cosine down."""
        if step < self.warm_up:
            return self.rate * (step + 1) / self.warm_up
        done = (step - self.warm_up) / max(1, self.steps - self.warm_up)
        falling = 0.5 * (1.0 + math.cos(math.pi * min(1.0, done)))
        return self.rate * (self.last_rate + (1.0 - self.last_rate) * falling)


@dataclass(frozen=True)
class OptimiserSettings:
    """AdamW and its schedule.

    Attributes:
        betas: decay of its two means.
        weight_decay: of matrices; norms and biases are left alone.
        clip: largest norm of the gradient; 0: any.
        ema: decay of the running mean of the weights, which are shipped; less in the first
            steps.
    """

    betas: tuple[Decay, Decay] = (0.9, 0.98)
    weight_decay: Amount = 0.02
    clip: Amount = 1.0
    ema: Share = 0.999

    def decay_at(self, step: int) -> float:
        """Return the share of the running mean that stays at a step, counted from 0.

        In the first steps less does, so that the random start is forgotten.
        """
        return min(self.ema, (1.0 + step) / (10.0 + step))


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
        cache_mb: memory that each worker keeps sampled objects in [MB].
        cache: folder that other formats are converted into, once for all runs; empty: the run's
            own.
        log_every: steps per line of the log.
        checkpoint_every: steps per checkpoint.
        validate_every: steps per validation; 0: only at the end.
    """

    micro_batch: Whole = 0
    workers: Whole = 1
    threads: Whole = 0
    device: str = "auto"
    precision: str = "bfloat16"
    compile: bool = False
    ahead: Count = 4
    cache_mb: Whole = 1024
    cache: str = ""
    log_every: Count = 50
    checkpoint_every: Count = 500
    validate_every: Whole = 1000


@dataclass(frozen=True)
class ValidationSettings:
    """The held-out examples.

    Attributes:
        objects: at most so many, evenly spread over those there are.
        points: of each.
        batch: samples at once.
    """

    objects: Count = 64
    points: Count = 1024
    batch: Count = 16


@dataclass(frozen=True)
class TrainConfig:
    """A training run.

    Attributes:
        data: sources of examples.
        held_out: sources of validation examples; none: no validation.
        seed: of everything; a sample depends on it, the step and its place in the step alone.
        batch: samples per step, over all processes.
        half: write the weights as float16.
        recipe: a name for the run.
        terms: under which the weights may be used, with the sources of the data; written into the
            file.
    """

    data: tuple[DataSource, ...] = ()
    held_out: tuple[DataSource, ...] = ()
    seed: Whole = 0
    batch: Count = 128
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

    @property
    def training_draw(self) -> DrawSettings:
        """Return how samples are drawn: with the features that the network wants."""
        return replace(self.draw, components=self.network.features == "components")

    @property
    def validation_draw(self) -> DrawSettings:
        """Return how validation samples are drawn: as training's, but upright and whole."""
        points = self.validation.points
        return replace(self.training_draw, points=points, fused_share=0.0, merged_share=0.0)
