"""What the network is taught: the paper's losses, each a mean over what it applies to.

Every loss is a sum divided by a number that only the labels decide. The numbers are counted for a
whole step first, over all its micro-batches and processes, so that however a step is divided its
losses and gradients are the same.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from typing import Any

import torch  # noqa: TID253 - this module is only imported to train
from torch.nn import functional  # noqa: TID253

from asset_factory.factory.models.network.shape import AxisForm

from ..samples.batches import Batch
from .matching import arranged, arranged_columns, match
from .settings import LossSettings

Tensor = Any
NAMES = tuple(each.name for each in fields(LossSettings) if each.type == "Amount")
"""Losses, by the settings that are their weights."""
_DICE_EPS = 1e-6
_SYMMETRIC = 0.02
"""A range whose middle is this near to 0, as a share of its width, reads the same both ways."""


def taught(batch: Batch, settings: LossSettings) -> Batch:
    """Return a batch of tensors with its axes of rotation as the settings want them taught."""
    if not settings.upright_axes:
        return batch
    direction = batch.revolute_direction
    limits = batch.revolute_range
    largest = direction.gather(-1, direction.abs().argmax(-1, keepdim=True))
    turned = largest < 0.0
    direction = torch.where(turned, -direction, direction)
    limits = torch.where(turned, -limits.flip(-1), limits)
    return replace(batch, revolute_direction=direction, revolute_range=limits)


@dataclass(frozen=True)
class LossTargets:
    """Which rows of a batch each loss applies to, as booleans.

    Attributes:
        parts: shape [batch, parts].
        pairs: pairs of those parts, shape [batch, parts, parts].
        edges: row is parent of column, shape [batch, parts, parts].
        revolute_direction, prismatic_direction and both ranges: shape [batch, parts].
        closest_points: shape [batch, n].
    """

    parts: Tensor
    pairs: Tensor
    edges: Tensor
    revolute_direction: Tensor
    prismatic_direction: Tensor
    revolute_range: Tensor
    prismatic_range: Tensor
    closest_points: Tensor


def targets_of(batch: Batch, settings: LossSettings) -> LossTargets:
    """Return what of a batch of tensors the losses apply to."""
    numbers = torch.arange(batch.parts, device=batch.parents.device)
    parts = numbers < batch.counts[:, None]
    if not settings.unseen_parts:
        seen = torch.zeros_like(batch.parents).scatter_(1, batch.part_ids, 1)
        parts = parts & (seen > 0)
    pairs = parts[:, :, None] & parts[:, None, :]
    turns = (batch.motion == 1) | (batch.motion == 3)
    return LossTargets(
        parts=parts,
        pairs=pairs,
        edges=(batch.parents[:, None, :] == numbers[:, None]) & pairs,
        revolute_direction=(batch.revolute_direction != 0).any(-1) & parts,
        prismatic_direction=(batch.prismatic_direction != 0).any(-1) & parts,
        revolute_range=(batch.revolute_range != 0).any(-1) & parts,
        prismatic_range=(batch.prismatic_range != 0).any(-1) & parts,
        closest_points=turns.gather(1, batch.part_ids),
    )


@dataclass(frozen=True)
class Counts(LossTargets):
    """How many of each a step has, all its parts together, and how many points."""

    points: float
    auxiliary: float

    @property
    def edge_weight(self) -> float:
        """Return the pairs that are no edge, per edge; 1 without any edge."""
        return (self.pairs - self.edges) / self.edges if self.edges else 1.0


def count(batch: Batch, targets: LossTargets, settings: LossSettings) -> list[float]:
    """Return the fields of :class:`Counts` for one micro-batch; those of a step are their sums."""
    points = batch.part_ids.shape[1]
    auxiliary = math.ceil(points / settings.auxiliary_points)
    rows = [float(getattr(targets, each.name).sum()) for each in fields(LossTargets)]
    return [*rows, float(len(batch) * points), float(len(batch) * auxiliary)]


@dataclass(frozen=True)
class Answers:
    """What the network said, parts matched.

    Attributes:
        queries: see :func:`..matching.match`.
        mask_logits: before they are put in the parts' order, shape [batch, n, parts].
        parts: of the part heads, in the parts' order, by the names of ``PartOutputs``.
        closest_points: shape [batch, n, 3]; ``None`` of a network that says axes by their moments.
        early: mask logits of some points after every block but the last, if those teach.
    """

    queries: Tensor
    mask_logits: Tensor
    parts: Any
    closest_points: Tensor | None
    early: list[Tensor]


def forward(network: Any, batch: Batch, settings: LossSettings) -> Answers:
    """Run the network on a batch, and match its queries with the true parts."""
    hidden = network.embed(batch.points, batch.normals, batch.features)
    queries = network.first_queries().expand(len(batch), -1, -1)
    early: list[Tensor] = []
    for number, block in enumerate(network.blocks, start=1):
        hidden, queries = block(hidden, queries)
        if settings.auxiliary and number < len(network.blocks):
            early.append(network.mask_logits(hidden[:, :: settings.auxiliary_points], queries))
    masks = network.mask_logits(hidden, queries)
    found = match(masks, batch.part_ids, batch.counts, root_first=settings.root_first)
    queries = arranged(queries, found)
    votes = network.shape.axis_form is AxisForm.CLOSEST_POINTS
    closest = network.closest_points(hidden, queries, batch.part_ids) if votes else None
    return Answers(found, masks, network.part_outputs(queries), closest, early)


def losses(
    answers: Answers, batch: Batch, targets: LossTargets, counts: Counts, settings: LossSettings
) -> dict[str, Tensor]:
    """Return each loss of ``NAMES``, not weighted: this batch's share of the step's mean.

    A loss that applies to nothing is 0, and so is its gradient.
    """

    def mean(name: str, values: Tensor) -> Tensor:
        return _sum(values, getattr(targets, name)) / max(getattr(counts, name), 1.0)

    parts = answers.parts
    masks = arranged_columns(answers.mask_logits, answers.queries).float()
    found = {"mask": _cross_entropy(masks, batch.part_ids) / counts.points}
    zero = masks.new_zeros(())
    found["dice"] = _dice(masks, batch, targets) / max(counts.parts, 1.0) if settings.dice else zero
    edges = targets.edges.float()
    weight = torch.as_tensor(counts.edge_weight, dtype=torch.float32, device=edges.device)
    pairs = functional.binary_cross_entropy_with_logits(
        parts.hierarchy_logits.float(), edges, pos_weight=weight, reduction="none"
    )
    found["hierarchy"] = mean("pairs", pairs)
    motion = functional.cross_entropy(
        parts.motion_logits.float().transpose(1, 2), batch.motion, reduction="none"
    )
    found["motion"] = mean("parts", motion)
    for kind in ("revolute", "prismatic"):
        way = f"{kind}_direction"
        range_ = f"{kind}_range"
        limits = getattr(batch, range_)
        off = _direction_error(getattr(parts, way), getattr(batch, way), limits, settings.sign_free)
        found[way] = mean(way, off)
        found[range_] = mean(range_, (getattr(parts, range_).float() - limits).abs().mean(-1))
    found["closest_points"] = mean("closest_points", _place_error(answers, batch))
    found["auxiliary"] = _auxiliary(answers, batch, counts, settings) if answers.early else zero
    return found


def total(found: dict[str, Tensor], settings: LossSettings) -> Tensor:
    """Return the weighted sum that is minimised."""
    weights = {name: getattr(settings, name) for name in NAMES}
    return sum(weight * found[name] for name, weight in weights.items() if weight)


def _cross_entropy(masks: Tensor, part_ids: Tensor) -> Tensor:
    return functional.cross_entropy(masks.flatten(0, 1), part_ids.flatten(), reduction="sum")


def _auxiliary(answers: Answers, batch: Batch, counts: Counts, settings: LossSettings) -> Tensor:
    part_ids = batch.part_ids[:, :: settings.auxiliary_points]
    masks = (arranged_columns(each, answers.queries).float() for each in answers.early)
    sums = [_cross_entropy(each, part_ids) for each in masks]
    return sum(sums) / (len(sums) * counts.auxiliary)


def _dice(masks: Tensor, batch: Batch, targets: LossTargets) -> Tensor:
    shares = masks.softmax(-1)
    true = functional.one_hot(batch.part_ids, masks.shape[-1]).to(shares.dtype)
    both = 2.0 * (shares * true).sum(1) + _DICE_EPS
    return _sum(1.0 - both / (shares.sum(1) + true.sum(1) + _DICE_EPS), targets.parts)


def _direction_error(said: Tensor, true: Tensor, limits: Tensor, sign_free: bool) -> Tensor:
    """Return the mean distance per coordinate, shape [batch, parts]."""
    straight = (said.float() - true).abs().mean(-1)
    if not sign_free:
        return straight
    width = limits[..., 1] - limits[..., 0]
    round_ = width >= 2.0 * math.pi - _SYMMETRIC
    either = round_ | (limits.sum(-1).abs() <= 2.0 * _SYMMETRIC * width)
    turned = (said.float() + true).abs().mean(-1)
    return torch.where(either, torch.minimum(straight, turned), straight)


def _place_error(answers: Answers, batch: Batch) -> Tensor:
    """Return how far each point's axis is off: nearest point or moment; shape [batch, n]."""
    if answers.closest_points is not None:
        return (answers.closest_points.float() - batch.closest_points).abs().mean(-1)
    part = batch.part_ids[..., None].expand(-1, -1, 3)
    moment = batch.revolute_direction.gather(1, part).cross(batch.closest_points, dim=-1)
    return (answers.parts.revolute_moment.float().gather(1, part) - moment).abs().mean(-1)


def _sum(values: Tensor, where: Tensor) -> Tensor:
    """Sum over the rows a loss applies to; others, even infinite, reach no gradient."""
    return values.masked_fill(~where, 0.0).sum()
