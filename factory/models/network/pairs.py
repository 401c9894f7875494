"""A number per pair of a row and a column, and its gradient, storing nothing per pair."""

from collections.abc import Iterator
from typing import Any

import torch  # noqa: TID253 - this module is only imported to make a network
import torch.nn.functional as F  # noqa: N812, TID253

from .layers import Tensor, split_first_layer

_CACHED = 1 << 18
"""Numbers of a hidden layer that pass through a CPU's cache at a time."""


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
