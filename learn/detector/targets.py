"""What the network should answer, and how far from it an answer is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import torch  # noqa: TID253 - this module is only imported to train
from torch.nn import functional  # noqa: TID253

from asset_factory.factory.models.detector.canvas import CANVAS, SIDES, SORTS, STRIDE
from asset_factory.factory.models.detector.decode import Dense

from .looks import Shown
from .sides import BOX, IGNORED, OPENED, PART, SORT, VIEW, WAY

Tensor = Any
CELLS = CANVAS // STRIDE
#: Small parts are as large as this for learning [pixels].
LEAST = 6.0
GAMMA = 2.0
OTHER = SORTS.index(SORTS[-1])


@dataclass(frozen=True, eq=False)
class CellTargets:
    """Truth by cell of 4 pixels, [n, 5, 64, 64] unless said.

    Attributes:
        sort: number; -1: nothing moves there.
        ignored: nothing is learned there.
        edges: distances to the edges [pixels], [n, 5, 4, 64, 64].
        way: number; -1: not known.
        opened: as a share of its range.
        weight: so that small parts count nearly as much as large ones.
    """

    sort: Tensor
    ignored: Tensor
    edges: Tensor
    way: Tensor
    opened: Tensor
    weight: Tensor


def targets_of(shown: Shown) -> CellTargets:
    """Return the truth of every cell; where parts overlap it is that of the smallest."""
    table = shown.table
    count, most = table.shape[:2]
    views = len(SIDES)
    part = shown.part[..., STRIDE // 2 :: STRIDE, STRIDE // 2 :: STRIDE]
    center = (torch.arange(CELLS, device=table.device) + 0.5) * STRIDE
    best = torch.full((count, views, CELLS, CELLS), 1e9, device=table.device)
    owner = torch.full((count, views, CELLS, CELLS), -1, dtype=torch.long, device=table.device)
    ignored = torch.zeros_like(owner, dtype=torch.bool)
    view_numbers = torch.arange(views, device=table.device)
    for number in range(most):
        row = table[:, number]
        low, high = row[:, BOX].split(2, 1)
        grown = ((LEAST - (high - low)) / 2.0).clamp(min=0.0)
        low, high = low - grown, high + grown
        across = (center >= low[:, :1]) & (center <= high[:, :1])
        up = (center >= low[:, 1:]) & (center <= high[:, 1:])
        inside = (up[:, :, None] & across[:, None, :])[:, None]
        inside = inside & (view_numbers == row[:, VIEW, None])[:, :, None, None]
        small = (high - low).amin(1) < 3 * STRIDE
        own = (part == row[:, PART, None, None, None]) | (row[:, PART] == 0)[:, None, None, None]
        inside = inside & (own | small[:, None, None, None])
        drop = (row[:, IGNORED] > 0)[:, None, None, None]
        ignored = ignored | (inside & drop)
        area = ((high - low).prod(1))[:, None, None, None].expand_as(best)
        better = inside & ~drop & (area < best)
        best = torch.where(better, area, best)
        owner = torch.where(better, number, owner)
    there = owner >= 0
    index = owner.clamp(min=0).flatten(1)

    def column(k: int) -> Tensor:
        return table[..., k].gather(1, index).view(owner.shape)

    x = center[None, None, None, :]
    y = center[None, None, :, None]
    left, low, right, high = map(column, range(BOX.start, BOX.stop))
    edges = torch.stack([x - left, y - low, right - x, high - y], 2)
    cells = functional.one_hot(torch.where(there, owner, most).flatten(1), most + 1).sum(1)
    size = cells.gather(1, index).view(owner.shape).clamp(min=1).float()
    return CellTargets(
        torch.where(there, column(SORT).long(), -1),
        ignored & ~there,
        edges,
        torch.where(there, column(WAY).long(), -1),
        column(OPENED),
        torch.where(there, size.rsqrt(), 0.0),
    )


def loss_of(answers: Dense, targets: CellTargets) -> tuple[Tensor, dict[str, Tensor]]:
    """Return how far answers are from the truth, and its terms."""
    there = (targets.sort >= 0) & ~targets.ignored
    weight = targets.weight * there
    norm = weight.sum().clamp(min=1.0)
    mean = norm / there.sum().clamp(min=1)
    sort = answers.sort.float()
    wanted = functional.one_hot(targets.sort.clamp(min=0), len(SORTS)).movedim(-1, 2).float()
    wanted = wanted * there[:, :, None]
    loss = functional.binary_cross_entropy_with_logits(sort, wanted, reduction="none")
    share = torch.sigmoid(sort)
    away = torch.where(wanted > 0, 1.0 - share, share)
    balance = (torch.where(there, weight, mean) * ~targets.ignored)[:, :, None]
    focal = torch.where(wanted > 0, 0.4, 0.6) * away**GAMMA * loss * balance
    terms = {"sort": focal.sum() / norm}
    overlap, generous = _overlap(answers.edges, targets.edges)
    terms["box"] = (weight * (1.0 - generous)).sum() / norm
    off = functional.smooth_l1_loss(answers.edges / 8, targets.edges / 8, reduction="none")
    terms["edge"] = 0.3 * (weight * off.clamp(max=4.0).mean(2)).sum() / norm
    known = weight * (targets.way >= 0) * (targets.sort != OTHER)
    ways = functional.cross_entropy(
        answers.way.float().movedim(2, 1), targets.way.clamp(min=0), reduction="none"
    )
    terms["way"] = (known * ways).sum() / known.sum().clamp(min=1.0)
    quality = functional.binary_cross_entropy_with_logits(
        answers.quality.float(), overlap.detach(), reduction="none"
    )
    terms["quality"] = (weight * quality).sum() / norm
    opened = functional.smooth_l1_loss(answers.opened.float(), targets.opened, reduction="none")
    terms["opened"] = (weight * opened).sum() / norm
    return sum(terms.values()), terms


def _overlap(one: Tensor, other: Tensor) -> tuple[Tensor, Tensor]:
    """Return the intersection over union of boxes about each cell, and the generalised one."""
    smaller = torch.minimum(one, other).clamp(min=0.0)
    larger = torch.maximum(one, other)
    inner = _area(smaller)
    areas = _area(one).clamp(min=1e-3) + _area(other).clamp(min=1e-3)
    union = (areas - inner).clamp(min=1e-3)
    hull = _area(larger)
    overlap = (inner / union).clamp(0.0, 1.0)
    return overlap, overlap - (hull - union) / hull.clamp(min=1e-3)


def _area(edges: Tensor) -> Tensor:
    """Return the areas of boxes by the distances to their edges, [n, 5, 4, rows, columns]."""
    return (edges[:, :, 0] + edges[:, :, 2]) * (edges[:, :, 1] + edges[:, :, 3])
