"""The layers, named as in the release, so that its checkpoints load key by key."""

from __future__ import annotations

import math
from collections import OrderedDict
from typing import Any

import torch  # noqa: TID253 - this module is only imported to make a network
import torch.nn.functional as F  # noqa: N812, TID253
from torch import nn  # noqa: TID253

from .shape import FREQUENCIES, NetworkShape

Tensor = Any
RMS_EPS = 1e-6
_SPREAD = 1000.0
_BASE = 10000.0


class SinusoidEmbedding(nn.Module):  # type: ignore[misc]
    """Coordinates as sines and cosines of many wavelengths, then a two-layer perceptron.

    Args:
        inputs: numbers after the expansion.
        width: of the result.
        raw_coords: whether the plain coordinates are appended.
    """

    def __init__(self, inputs: int, width: int, raw_coords: bool) -> None:
        super().__init__()
        self.raw_coords = raw_coords
        self.mlp = two_layers(inputs, width, width)

    def forward(self, coordinates: Tensor) -> Tensor:
        """Embed coordinates, shape [..., k] to [..., width]."""
        return self.mlp(self.expand(coordinates))

    def expand(self, coordinates: Tensor) -> Tensor:
        """Return sines, then cosines per coordinate; [..., k] to [..., 64 k] or [..., 65 k]."""
        # In this order of operations: the angles reach 500 rad, where float32 has few digits left,
        # and the weights were trained on these.
        steps = torch.arange(FREQUENCIES, dtype=torch.float32, device=coordinates.device)
        frequencies = torch.exp(-math.log(_BASE) * steps / FREQUENCIES)
        angles = _SPREAD * coordinates.float()[..., None] * frequencies
        waves = torch.cat([angles.sin(), angles.cos()], dim=-1).flatten(-2)
        return torch.cat([waves, coordinates], dim=-1) if self.raw_coords else waves


class Attention(nn.Module):  # type: ignore[misc]
    """Multi-head attention, its queries and keys normalised per head; heads divide ``width``."""

    def __init__(self, width: int, heads: int, dropout: float) -> None:
        super().__init__()
        self.heads = heads
        self.to_q = nn.Linear(width, width, bias=False)
        self.to_k = nn.Linear(width, width, bias=False)
        self.to_v = nn.Linear(width, width, bias=False)
        self.norm_q = nn.RMSNorm(width // heads, eps=RMS_EPS)
        self.norm_k = nn.RMSNorm(width // heads, eps=RMS_EPS)
        self.to_out = nn.Sequential(nn.Linear(width, width), nn.Dropout(dropout))

    def forward(self, asking: Tensor, asked: Tensor) -> Tensor:
        """Let ``asking`` [..., n, width] attend to ``asked`` [..., m, width]; as ``asking``."""
        query = self.norm_q(self.split(self.to_q(asking)))
        key = self.norm_k(self.split(self.to_k(asked)))
        found = F.scaled_dot_product_attention(query, key, self.split(self.to_v(asked)))
        return self.to_out(found.transpose(-3, -2).flatten(-2))

    def split(self, tensor: Tensor) -> Tensor:
        """Split [..., n, width] into [..., heads, n, width / heads]."""
        return tensor.unflatten(-1, (self.heads, -1)).transpose(-3, -2)


class GatedLinear(nn.Module):  # type: ignore[misc]
    """A linear layer, half of which gates the other half."""

    def __init__(self, inputs: int, outputs: int) -> None:
        super().__init__()
        self.proj = nn.Linear(inputs, 2 * outputs)

    def forward(self, tensor: Tensor) -> Tensor:
        """Map [..., inputs] to [..., outputs]."""
        value, gate = self.proj(tensor).chunk(2, dim=-1)
        return value * F.gelu(gate)


class Block(nn.Module):  # type: ignore[misc]
    """Queries look at each other and at the points; then the points look at the queries.

    There is no attention among points, so the cost grows linearly with their number.
    """

    def __init__(self, shape: NetworkShape, dropout: float) -> None:
        super().__init__()
        width = shape.hidden
        heads = shape.heads
        self.norm1, self.norm2, self.norm3 = (nn.LayerNorm(width) for _ in range(3))
        self.final_norm_x = nn.LayerNorm(width)
        self.final_norm_q = nn.LayerNorm(width)
        self.attn1, self.attn2, self.attn3 = (Attention(width, heads, dropout) for _ in range(3))
        self.mlp_x = gated_perceptron(width, shape.mlp, dropout)
        self.mlp_q = gated_perceptron(width, shape.mlp, dropout)

    def forward(self, points: Tensor, queries: Tensor) -> tuple[Tensor, Tensor]:
        """Return both sides after one round: [batch, n, width] and [batch, m, width]."""
        queries = self.among_queries(queries)
        queries = queries + self.attn2(self.norm2(queries), points)
        points = points + self.attn3(self.norm3(points), queries)
        points = points + self.mlp_x(self.final_norm_x(points))
        return points, self.finish_queries(queries)

    def among_queries(self, queries: Tensor) -> Tensor:
        """Let queries attend to one another; the release adds to *normalised* queries only here."""
        queries = self.norm1(queries)
        return queries + self.attn1(queries, queries)

    def finish_queries(self, queries: Tensor) -> Tensor:
        """Return the queries' own perceptron."""
        return queries + self.mlp_q(self.final_norm_q(queries))


def named(**layers: Any) -> Any:
    """Return layers that follow one another, each under its name in the release."""
    return nn.Sequential(OrderedDict(layers))


def gated_perceptron(width: int, middle: int, dropout: float) -> Any:
    """Return a gated layer and a linear one."""
    gated = GatedLinear(width, middle)
    return named(net=nn.Sequential(gated, nn.Dropout(dropout), nn.Linear(middle, width)))


def two_layers(inputs: int, middle: int, outputs: int) -> Any:
    """Return a perceptron with one hidden layer."""
    return nn.Sequential(nn.Linear(inputs, middle), nn.SiLU(), nn.Linear(middle, outputs))


def split_first_layer(head: Any, tensor: Tensor, first: bool) -> Tensor:
    """Return the share of a pair head's first layer that comes from one side of the pair.

    A head on concatenated pairs would need n m rows; its first layer is linear, so the shares of
    both sides are computed once each, n + m rows, and added.

    Args:
        head: perceptron on [a, b] concatenated, both of one width.
        tensor: all a (``first``, with the bias) or all b, shape [..., width].
        first: which side ``tensor`` is.
    """
    layer = head[0]
    width = head[0].in_features // 2
    if first:
        return F.linear(tensor, layer.weight[:, :width], layer.bias)
    return F.linear(tensor, layer.weight[:, width:])
