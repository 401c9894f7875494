"""The Part Articulation Transformer: as it is trained, on batches, with gradients."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import torch  # noqa: TID253 - this module is only imported to make a network
import torch.nn.functional as F  # noqa: N812, TID253
from torch import nn  # noqa: TID253

from .layers import Block, SinusoidEmbedding, Tensor, split_first_layer, two_layers
from .shape import FREQUENCIES, AxisForm, NetworkShape

_CACHED = 1 << 18
"""Numbers of a hidden layer that pass through a CPU's cache at a time."""


@dataclass(frozen=True)
class PartOutputs:
    """What the part heads say about each query; see :class:`..prediction.Prediction` for units.

    Attributes:
        hierarchy_logits: row is parent of column, shape [batch, parts, parts].
        motion_logits: shape [batch, parts, 4].
        revolute_direction, prismatic_direction: shape [batch, parts, 3].
        revolute_range, prismatic_range: shape [batch, parts, 2].
        revolute_moment: shape [batch, parts, 3], or ``None``.
    """

    hierarchy_logits: Tensor
    motion_logits: Tensor
    revolute_direction: Tensor
    revolute_range: Tensor
    prismatic_direction: Tensor
    prismatic_range: Tensor
    revolute_moment: Tensor | None


class PartArticulationTransformer(nn.Module):  # type: ignore[misc]
    """Points and part queries through the blocks, then the heads."""

    def __init__(self, shape: NetworkShape, dropout: float = 0.0) -> None:
        super().__init__()
        self.shape = shape
        wide = shape.hidden
        deep = shape.mlp
        if shape.features:
            self.feat_proj = nn.Linear(shape.features, wide)
        self.pos_embed = SinusoidEmbedding(shape.embedding, wide, shape.raw_coords)
        if shape.normals:
            self.normal_embed = SinusoidEmbedding(shape.embedding, wide, shape.raw_coords)
        self.part_id_embed = SinusoidEmbedding(2 * FREQUENCIES, wide, raw_coords=False)
        self.blocks = nn.ModuleList([Block(shape, dropout) for _ in range(shape.blocks)])
        if shape.hypotheses > 1:
            masks = [two_layers(2 * wide, deep, 1) for _ in range(shape.hypotheses)]
            self.point_mask_decoder = nn.ModuleList(masks)
        else:
            self.point_mask_decoder = two_layers(2 * wide, deep, 1)
        closest = shape.axis_form is AxisForm.CLOSEST_POINTS
        self.part_hierarchy_decoder = two_layers(2 * wide, deep, 1)
        self.part_motion_classifier = two_layers(wide, deep, 4)
        self.revolute_motion_decoder = two_layers(wide, deep, 5 if closest else 8)
        self.prismatic_motion_decoder = two_layers(wide, deep, 5)
        if closest:
            self.point_motion_decoder = two_layers(2 * wide, deep, 3)

    def forward(
        self, points: Tensor, normals: Tensor | None, features: Tensor | None
    ) -> tuple[Tensor, Tensor]:
        """Return the points and queries after the last block.

        Args:
            points: network frame, shape [batch, n, 3].
            normals: shape [batch, n, 3]; not looked at by networks without normals.
            features: shape [batch, n, channels]; not looked at by networks without features.

        Returns:
            [batch, n, hidden] and [batch, parts, hidden], for the heads below.
        """
        hidden = self.embed(points, normals, features)
        queries = self.first_queries().expand(len(points), -1, -1)
        for block in self.blocks:
            hidden, queries = block(hidden, queries)
        return hidden, queries

    def embed(self, points: Tensor, normals: Tensor | None, features: Tensor | None) -> Tensor:
        """Return the points before the first block, shape [..., n, hidden]."""
        hidden = self.pos_embed(points)
        if self.shape.normals:
            hidden = hidden + self.normal_embed(normals)
        if self.shape.features:
            hidden = hidden + self.feat_proj(features)
        return hidden

    def first_queries(self) -> Tensor:
        """Return the queries before the first block: embedded part numbers, [parts, hidden]."""
        weight = self.part_id_embed.mlp[0].weight
        numbers = torch.arange(self.shape.max_parts, dtype=torch.float32, device=weight.device)
        return self.part_id_embed((numbers / self.shape.max_parts)[:, None])

    @property
    def mask_head(self) -> Any:
        """Return the perceptron that says which part a point belongs to; the first of several."""
        heads = self.point_mask_decoder
        return heads[0] if self.shape.hypotheses > 1 else heads

    def mask_logits(self, hidden: Tensor, queries: Tensor) -> Tensor:
        """Return which query each point belongs to, shape [batch, n, parts]."""
        return pair_logits(self.mask_head, hidden, queries)

    def part_outputs(self, queries: Tensor) -> PartOutputs:
        """Return what the part heads say about the queries, [batch, parts, hidden]."""
        revolute = self.revolute_motion_decoder(queries)
        prismatic = self.prismatic_motion_decoder(queries)
        plucker = self.shape.axis_form is AxisForm.PLUCKER
        return PartOutputs(
            hierarchy_logits=pair_logits(self.part_hierarchy_decoder, queries, queries),
            motion_logits=self.part_motion_classifier(queries),
            revolute_direction=revolute[..., :3],
            revolute_range=revolute[..., -2:],
            prismatic_direction=prismatic[..., :3],
            prismatic_range=prismatic[..., -2:],
            revolute_moment=revolute[..., 3:6] if plucker else None,
        )

    def closest_points(self, hidden: Tensor, queries: Tensor, part_ids: Tensor) -> Tensor:
        """Return the point nearest to each point on the axis of its part, shape [batch, n, 3].

        Args:
            hidden: points after the last block, [batch, n, hidden].
            queries: after the last block, [batch, parts, hidden].
            part_ids: part of each point, int64, [batch, n].
        """
        head = self.point_motion_decoder
        of_parts = split_first_layer(head, queries, first=False)
        picked = of_parts.gather(1, part_ids[..., None].expand(-1, -1, of_parts.shape[-1]))
        return head[2](F.silu(split_first_layer(head, hidden, first=True) + picked))


def pair_logits(head: Any, rows: Tensor, columns: Tensor) -> Tensor:
    """Return one number for every pair of a row and a column, shape [batch, n, m].

    Args:
        head: perceptron on [row, column] concatenated, with one number out.
        rows: shape [batch, n, width].
        columns: shape [batch, m, width].
    """
    of_rows = split_first_layer(head, rows, first=True)
    of_columns = split_first_layer(head, columns, first=False)
    logits: Tensor = _Pairs.apply(of_rows, of_columns, head[2].weight[0].to(of_rows.dtype))
    return logits + head[2].bias


class _Pairs(torch.autograd.Function):  # type: ignore[misc]
    """``silu(row + column) . last`` for every pair, one column at a time.

    To keep the hidden layer of all pairs would take 400 MB for 2048 points of one object at the
    released size, and is
    no faster: on the way back it is computed anew while it passes through the cache.
    """

    @staticmethod
    def forward(context: Any, rows: Tensor, columns: Tensor, last: Tensor) -> Tensor:
        """Map [batch, n, h], [batch, m, h] and [h] to [batch, n, m]."""
        context.save_for_backward(rows, columns, last)
        logits = rows.new_empty(*rows.shape[:2], columns.shape[1])
        for some in _passes(rows):
            few = rows[some]
            work = torch.empty_like(rows[some])
            for number, column in enumerate(columns[some].unbind(1)):
                torch.add(few, column[:, None], out=work)
                found = torch.mv(F.silu(work, inplace=True).flatten(0, 1), last)
                logits[some, :, number] = found.view(few.shape[:2])
        return logits

    @staticmethod
    def backward(context: Any, above: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        """Return the gradients of the three, from that of the logits."""
        rows, columns, last = context.saved_tensors
        # Sums over columns and samples stay in at least float32, whatever the products are in.
        wide = torch.promote_types(rows.dtype, torch.float32)
        to_rows = torch.zeros_like(rows, dtype=wide)
        to_last = torch.zeros_like(last, dtype=wide)
        to_columns = torch.empty_like(columns)
        for some in _passes(rows):
            few = rows[some]
            work = torch.empty_like(rows[some])
            slope = torch.empty_like(rows[some])
            through = last.expand_as(few)
            for number, column in enumerate(columns[some].unbind(1)):
                of_column = above[some, :, number, None].to(few.dtype)
                torch.add(few, column[:, None], out=work)
                torch.ops.aten.silu_backward.grad_input(through, work, grad_input=slope)
                to_last += torch.mv(F.silu(work, inplace=True).flatten(0, 1).T, of_column.flatten())
                slope *= of_column
                to_rows[some] += slope
                to_columns[some, number] = slope.sum(1)
        return to_rows.to(rows.dtype), to_columns, to_last.to(last.dtype)


def _passes(rows: Tensor) -> Iterator[slice]:
    """Yield the samples at a time: all of them, but on a CPU as many as fit its cache."""
    size = len(rows) if rows.is_cuda else max(1, _CACHED // max(1, rows[0].numel()))
    return (slice(start, start + size) for start in range(0, len(rows), size))
