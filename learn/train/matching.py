"""Which query answers for which true part: the assignment that explains the points best."""

from __future__ import annotations

from typing import Any

import numpy as np
import torch  # noqa: TID253 - this module is only imported to train
from scipy.optimize import linear_sum_assignment
from torch.nn import functional  # noqa: TID253

Tensor = Any


def match(
    mask_logits: Tensor, part_ids: Tensor, counts: Tensor, *, root_first: bool = False
) -> Tensor:
    """Return the query of every part, then the queries that are left.

    The assignment has the greatest sum over points of the logarithm of the probability that the
    point belongs to the query of its part (the paper, "Matching predicted parts with
    ground-truth"), found by the Hungarian method.

    Args:
        mask_logits: which query each point belongs to, shape [batch, n, parts].
        part_ids: true part of each point, int64, shape [batch, n].
        counts: true parts of each sample, at most ``parts``, shape [batch].
        root_first: part 0, the base, always answers to query 0.

    Returns:
        int64, shape [batch, parts]: a permutation of the queries per sample, by part; after the
        sample's parts come the others in ascending order.
    """
    # In full precision: the sums over points are long.
    with torch.no_grad(), torch.autocast(mask_logits.device.type, enabled=False):
        # An answer that overflowed is matched anyhow: its loss, no number, is seen by the step.
        costs = np.nan_to_num(assignment_costs(mask_logits.detach(), part_ids).cpu().numpy())
    queries = [
        _permutation(cost[:count], root_first)
        for cost, count in zip(costs, counts.cpu().tolist(), strict=True)
    ]
    return torch.from_numpy(np.stack(queries)).to(mask_logits.device)


def assignment_costs(mask_logits: Tensor, part_ids: Tensor) -> Tensor:
    """Return the cost of a part for a query, [batch, part, query]: minus log-probability."""
    log_shares = functional.log_softmax(mask_logits.float(), dim=-1)
    of_part = functional.one_hot(part_ids, mask_logits.shape[-1]).to(log_shares.dtype)
    return -torch.matmul(of_part.transpose(1, 2), log_shares)


def _permutation(cost: Any, root_first: bool) -> Any:
    queries = np.arange(cost.shape[1])
    if root_first:
        _, rest = linear_sum_assignment(cost[1:, 1:])
        chosen = np.concatenate([[0], rest + 1])
    else:
        _, chosen = linear_sum_assignment(cost)
    return np.concatenate([chosen, np.setdiff1d(queries, chosen)]).astype(np.int64)


def arranged(tensor: Tensor, queries: Tensor) -> Tensor:
    """Return the rows of [batch, parts, n] in the order that :func:`match` found."""
    return tensor.take_along_dim(queries[..., None], 1)


def arranged_columns(tensor: Tensor, queries: Tensor) -> Tensor:
    """Return the columns of [batch, n, parts] in the order that :func:`match` found."""
    return tensor.take_along_dim(queries[:, None], 2)
