"""The same network on one cloud of any size: no gradients, little memory, least work.

Savings over the plain form, exact up to rounding:

- Points never look at each other, so they pass through in chunks; only what they add up to is kept.
- There are 16 queries. So values are mixed before they are projected (queries looking at points),
  and values and output are projected before they are mixed (points looking at queries).
- The sums for the next block are taken while a chunk is still in the processor's cache.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import torch  # noqa: TID253 - this module is only imported to run a network
import torch.nn.functional as F  # noqa: N812, TID253

from ...mesh import Float32Array, IntArray
from .layers import RMS_EPS, Attention, Block, Tensor, split_first_layer
from .transformer import PartArticulationTransformer

#: Points at a time.
CHUNK = 512


@dataclass(frozen=True)
class PointUpdate:
    """What one block does to a point, once its queries are known.

    Attributes:
        norm_attention, norm_perceptron: layer norms before the two steps.
        to_query: projection of a point, shape [width, width].
        keys: of the queries, normalised and scaled, shape [heads, head_width, parts].
        answers: what a point gets from each query in each head, shape [heads * parts, width].
        value, gate, out: the perceptron's layers, each a weight and a bias.
    """

    norm_attention: Any
    norm_perceptron: Any
    to_query: Tensor
    keys: Tensor
    answers: Tensor
    value: tuple[Tensor, Tensor]
    gate: tuple[Tensor, Tensor]
    out: tuple[Tensor, Tensor]

    def apply(self, points: Tensor) -> None:
        """Change a chunk of points in place, [n, width]."""
        heads = len(self.keys)
        dtype = self.to_query.dtype
        query = F.linear(_normed(points, self.norm_attention, dtype), self.to_query)
        query = query.view(len(points), heads, -1).float()
        weights = torch.matmul(query.transpose(0, 1), self.keys)
        weights.mul_(_inverse_rms(query).T[:, :, None])
        shares = weights.softmax(-1).transpose(0, 1).reshape(len(points), -1)
        _add_product(points, shares.to(dtype), self.answers)
        seen = _normed(points, self.norm_perceptron, dtype)
        gate = F.gelu(F.linear(seen, self.gate[0], self.gate[1]))
        _add_product(points, F.linear(seen, self.value[0], self.value[1]).mul_(gate), self.out[0].T)
        points.add_(self.out[1])


@dataclass(frozen=True)
class Driven:
    """What a cloud tells about its parts: enough to label any other point of the same surface.

    Attributes:
        updates: what each block does to a point.
        queries: after the last block, shape [parts, width], float32.
    """

    updates: tuple[PointUpdate, ...]
    queries: Tensor


class QueryPass:
    """What the queries of one block see in all points, summed chunk by chunk.

    A softmax over all points needs their largest logit; the sums are rescaled whenever a larger one
    turns up.
    """

    def __init__(self, attention: Attention, asking: Tensor, dtype: Any) -> None:
        self._attention = attention
        self._dtype = dtype
        split = attention.split(attention.to_q(asking))
        scale = split.shape[-1] ** -0.5
        self._queries = attention.norm_q(split) * attention.norm_k.weight * scale
        self._to_key = attention.to_k.weight.to(dtype)
        heads, parts = self._queries.shape[:2]
        self._largest = torch.full((heads, parts), -torch.inf, device=asking.device)
        self._total = torch.zeros(heads, parts, device=asking.device)
        self._seen = torch.zeros(heads, parts, asking.shape[1], device=asking.device)

    def see(self, points: Tensor) -> None:
        """Add a chunk of points, [n, width]."""
        heads, parts, width = self._seen.shape
        low = points.to(self._dtype)
        key = F.linear(low, self._to_key).view(len(points), heads, -1).float()
        logits = torch.matmul(self._queries, key.permute(1, 2, 0))
        logits.mul_(_inverse_rms(key).T[:, None])
        largest = torch.maximum(self._largest, logits.amax(-1))
        shrink = (self._largest - largest).exp_()
        weights = logits.sub_(largest[..., None]).exp_()
        self._largest = largest
        self._total = self._total * shrink + weights.sum(-1)
        seen = weights.view(heads * parts, -1).to(self._dtype) @ low
        self._seen.mul_(shrink[..., None]).add_(seen.view(heads, parts, width))

    def found(self) -> Tensor:
        """Return what attention to all points gives each query, shape [parts, width]."""
        heads, parts, width = self._seen.shape
        seen = self._seen / self._total[..., None]
        values = self._attention.to_v.weight.view(heads, -1, width)
        mixed = torch.matmul(seen, values.transpose(1, 2)).transpose(0, 1).reshape(parts, width)
        return self._attention.to_out[0](mixed)


@torch.inference_mode()  # type: ignore[untyped-decorator]
def drive(network: PartArticulationTransformer, hidden: Tensor, dtype: Any) -> Driven:
    """Let a cloud drive the queries through all blocks.

    Args:
        network: in evaluation mode.
        hidden: embedded points, shape [n, width], float32; changed in place to what they are before
            the last block's update, so that ``Driven.updates[-1]`` finishes them.
        dtype: of the products over points; sums, norms and queries are float32 regardless.
    """
    queries = network.first_queries()
    updates: list[PointUpdate] = []
    for block in network.blocks:
        queries = block.among_queries(queries)
        query_pass = QueryPass(block.attn2, block.norm2(queries), dtype)
        for points in hidden.split(CHUNK):
            if updates:
                updates[-1].apply(points)
            query_pass.see(points)
        queries = queries + query_pass.found()
        updates.append(_update_of(block, queries, dtype))
        queries = block.finish_queries(queries)
    return Driven(tuple(updates), queries)


@torch.inference_mode()  # type: ignore[untyped-decorator]
def embed_chunks(
    network: PartArticulationTransformer,
    points: Float32Array,
    normals: Float32Array | None,
    features: Float32Array | None,
) -> Tensor:
    """Return the points before the first block, shape [n, width], float32, where the network is."""
    device = network.pos_embed.mlp[0].weight.device
    hidden = torch.empty(len(points), network.shape.hidden, device=device)
    for rows in chunks(len(points), CHUNK):
        cloud = (points, normals, features)
        given = [x if x is None else torch.tensor(x[rows], device=device) for x in cloud]
        hidden[rows] = network.embed(*given)
    return hidden


@torch.inference_mode()  # type: ignore[untyped-decorator]
def finish(hidden: Tensor, updates: tuple[PointUpdate, ...], masks: PairHead) -> Float32Array:
    """Put points through the updates, in place; returns the part of each, shape [n, parts]."""
    # Made at once: small arrays kept between large passing ones would leave holes of a gigabyte.
    logits = np.empty((len(hidden), masks.parts), dtype=np.float32)
    for rows in chunks(len(hidden), CHUNK):
        for update in updates:
            update.apply(hidden[rows])
        logits[rows] = masks.every_part(hidden[rows]).cpu().numpy()
    return logits


@torch.inference_mode()  # type: ignore[untyped-decorator]
def part_outputs(
    network: PartArticulationTransformer, queries: Tensor
) -> dict[str, Float32Array | None]:
    """Return what the part heads say, by the names of :class:`..prediction.Prediction`."""
    outputs = network.part_outputs(queries[None])
    arrays = {each.name: getattr(outputs, each.name) for each in fields(outputs)}
    return {
        name: None if value is None else value[0].cpu().numpy() for name, value in arrays.items()
    }


class PairHead:
    """A head on pairs of a point and a query, for one cloud's queries.

    Args:
        queries: shape [parts, width].
        dtype: of the product over points.
    """

    def __init__(self, head: Any, queries: Tensor, dtype: Any) -> None:
        width = queries.shape[1]
        self._to_hidden = head[0].weight[:, :width].to(dtype)
        self._bias = head[0].bias
        self._last = head[2]
        self._of_parts = split_first_layer(head, queries, first=False)
        self._dtype = dtype
        self.parts = len(queries)

    @torch.inference_mode()  # type: ignore[untyped-decorator]
    def every_part(self, hidden: Tensor) -> Tensor:
        """Return one number for each point and query, [n, width] to [n, parts]."""
        of_points = self._of_points(hidden)
        logits = torch.empty(len(hidden), len(self._of_parts), device=hidden.device)
        work = torch.empty_like(of_points)
        last = self._last.weight[0]
        for part, of_part in enumerate(self._of_parts):
            torch.add(of_points, of_part, out=work)
            logits[:, part] = torch.mv(F.silu(work, inplace=True), last)
        return logits.add_(self._last.bias)

    @torch.inference_mode()  # type: ignore[untyped-decorator]
    def own_parts(self, hidden: Tensor, part_ids: IntArray) -> Float32Array:
        """Return the head for every point and its part, [n, width] and [n] to [n, outputs]."""
        found = np.empty((len(hidden), self._last.out_features), dtype=np.float32)
        for part in np.unique(part_ids):
            rows = np.flatnonzero(part_ids == part)
            for some in chunks(len(rows), CHUNK):
                few = self._of_points(hidden[rows[some]]).add_(self._of_parts[part])
                found[rows[some]] = self._last(F.silu(few, inplace=True)).cpu().numpy()
        return found

    def _of_points(self, hidden: Tensor) -> Tensor:
        return F.linear(hidden.to(self._dtype), self._to_hidden).float().add_(self._bias)


def chunks(count: int, size: int) -> Iterator[slice]:
    """Yield the slices that cover ``count`` rows, ``size`` at a time."""
    return (slice(start, min(start + size, count)) for start in range(0, count, size))


def _update_of(block: Block, queries: Tensor, dtype: Any) -> PointUpdate:
    attention = block.attn3
    middle = block.mlp_x.net[2].in_features
    heads = attention.heads
    parts = len(queries)
    keys = attention.norm_k(attention.split(attention.to_k(queries))) * attention.norm_q.weight
    values = attention.split(attention.to_v(queries))
    out = attention.to_out[0]
    through = out.weight.T.reshape(heads, -1, out.out_features)
    # A head's shares sum to one, so the output's bias can ride on the answers.
    answers = torch.matmul(values, through) + out.bias / heads
    projection = block.mlp_x.net[0].proj
    weights = projection.weight.to(dtype)
    biases = projection.bias.to(dtype)
    return PointUpdate(
        norm_attention=block.norm3,
        norm_perceptron=block.final_norm_x,
        to_query=attention.to_q.weight.to(dtype),
        keys=keys.transpose(1, 2) * keys.shape[-1] ** -0.5,
        answers=answers.reshape(heads * parts, -1).to(dtype),
        value=(weights[:middle], biases[:middle]),
        gate=(weights[middle:], biases[middle:]),
        out=(block.mlp_x.net[2].weight.to(dtype), block.mlp_x.net[2].bias),
    )


def _normed(points: Tensor, norm: Any, dtype: Any) -> Tensor:
    return F.layer_norm(points, norm.normalized_shape, norm.weight, norm.bias, norm.eps).to(dtype)


def _inverse_rms(heads: Tensor) -> Tensor:
    """Map [n, heads, head_width] to [n, heads]."""
    squares = torch.linalg.vector_norm(heads, dim=-1).square_()
    return squares.div_(heads.shape[-1]).add_(RMS_EPS).rsqrt_()


def _add_product(points: Tensor, left: Tensor, right: Tensor) -> None:
    if left.dtype == points.dtype:
        points.addmm_(left, right)
    else:
        points.add_(left @ right)
