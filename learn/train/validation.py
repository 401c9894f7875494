"""How good a network is on held-out examples: always the same ones, drawn the same way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch  # noqa: TID253 - this module is only imported to train
from scipy.optimize import linear_sum_assignment

from asset_factory.factory.mesh import IntArray

from ..samples.batches import collate
from ..samples.sample import Sample
from .losses import NAMES, Counts, count, forward, losses, targets_of, taught
from .matching import arranged_columns
from .settings import TrainConfig


@dataclass(frozen=True)
class Scores:
    """Figures over the held-out examples, parts matched as in training.

    Attributes:
        loss: weighted sum of the losses.
        point_accuracy: share of the points whose part is right.
        part_iou: mean over true parts of the overlap with what the best assignment gives.
        class_accuracy: share of the parts whose motion class is right.
        revolute_angle, prismatic_angle: median angle between directions, either sign [deg].
    """

    loss: float
    point_accuracy: float
    part_iou: float
    class_accuracy: float
    revolute_angle: float
    prismatic_angle: float


def validate(network: Any, samples: Sequence[Sample], config: TrainConfig, device: str) -> Scores:
    """Score a network by at least one sample; it is left in the mode it was in."""
    training = network.training
    network.eval()
    settings = config.loss
    loss = 0.0
    right = points = 0
    ious: list[float] = []
    classes: list[bool] = []
    angles: dict[str, list[float]] = {"revolute": [], "prismatic": []}
    for start in range(0, len(samples), config.validation.batch):
        chunk = samples[start : start + config.validation.batch]
        batch = taught(collate(chunk, config.network.max_parts).to(device), settings)
        targets = targets_of(batch, settings)
        with torch.no_grad():
            answers = forward(network, batch, settings)
            counts = Counts(*count(batch, targets, settings))
            found = losses(answers, batch, targets, counts, settings)
        loss += len(batch) * sum(getattr(settings, name) * float(found[name]) for name in NAMES)
        labels = arranged_columns(answers.mask_logits, answers.queries).argmax(-1)
        right += int((labels == batch.part_ids).sum())
        points += batch.part_ids.numel()
        kinds = answers.parts.motion_logits.argmax(-1) == batch.motion
        classes += kinds[targets.parts].tolist()
        for kind in angles:
            rows = getattr(targets, f"{kind}_direction")
            said = getattr(answers.parts, f"{kind}_direction")[rows].cpu().numpy()
            true = getattr(batch, f"{kind}_direction")[rows].cpu().numpy()
            angles[kind] += _angles(said, true)
        for said, true in zip(labels.cpu().numpy(), batch.part_ids.cpu().numpy(), strict=True):
            ious += part_ious(said, true)
    network.train(training)
    return Scores(
        loss=loss / len(samples),
        point_accuracy=right / points,
        part_iou=sum(ious) / len(ious),
        class_accuracy=sum(classes) / len(classes),
        revolute_angle=_median(angles["revolute"]),
        prismatic_angle=_median(angles["prismatic"]),
    )


def part_ious(said: IntArray, true: IntArray) -> list[float]:
    """Return the overlap of every true part with its predicted one, by the best total assignment.

    Of points with labels ``said`` and true parts, shape [n]: those in both over those in either,
    for every part that has points; 0 for one that is given none.
    """
    _, rows = np.unique(true, return_inverse=True)
    _, columns = np.unique(said, return_inverse=True)
    both = np.zeros((rows.max() + 1, columns.max() + 1))
    np.add.at(both, (rows, columns), 1.0)
    either = both.sum(1)[:, None] + both.sum(0)[None] - both
    overlap = both / either
    row, column = linear_sum_assignment(-overlap)
    found = np.zeros(len(overlap))
    found[row] = overlap[row, column]
    return [float(value) for value in found]


def _angles(said: Any, true: Any) -> list[float]:
    length = np.linalg.norm(said, axis=1) * np.linalg.norm(true, axis=1)
    cosine = np.abs(np.einsum("ij,ij->i", said, true)) / np.maximum(length, 1e-9)
    return [float(angle) for angle in np.degrees(np.arccos(np.clip(cosine, 0.0, 1.0)))]


def _median(values: Sequence[float]) -> float:
    return float(np.median(values)) if values else 0.0
