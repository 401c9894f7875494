"""A transformer over the cells of three planes."""

from typing import Any

import torch  # noqa: TID253 - this module is only imported to make the encoder
import torch.nn.functional as F  # noqa: N812, TID253
from torch import nn  # noqa: TID253

from .shape import PartFieldShape

Tensor = Any
_EPS = 1e-6


class SelfAttention(nn.Module):  # type: ignore[misc]
    """Attention among all cells, without biases, with torch's names for its tensors.

    Torch's own module multiplies a batch of one in a layout that takes bfloat16 element by element.
    """

    def __init__(self, width: int, heads: int) -> None:
        super().__init__()
        self.heads = heads
        self.in_proj_weight = nn.Parameter(torch.zeros(3 * width, width))
        self.out_proj = nn.Linear(width, width, bias=False)

    def forward(self, tokens: Tensor) -> Tensor:
        """Map [n, width] to the same."""
        sides = (
            F.linear(tokens, self.in_proj_weight)
            .unflatten(1, (3, self.heads, -1))
            .permute(1, 2, 0, 3)
        )
        found = F.scaled_dot_product_attention(*sides[:, None].unbind(0))
        return self.out_proj(found[0].transpose(0, 1).flatten(1))


class Layer(nn.Module):  # type: ignore[misc]
    """Attention among all cells and a perceptron, each on normalised tokens."""

    def __init__(self, width: int, heads: int) -> None:
        super().__init__()
        self.norm1 = nn.LayerNorm(width, eps=_EPS)
        self.norm2 = nn.LayerNorm(width, eps=_EPS)
        self.self_attn = SelfAttention(width, heads)
        # The third place is a dropout's, which has no tensors; it keeps the last layer's number.
        self.mlp = nn.Sequential(
            nn.Linear(width, 4 * width), nn.GELU(), nn.Identity(), nn.Linear(4 * width, width)
        )

    def forward(self, tokens: Tensor) -> Tensor:
        """Map [n, width] to the same."""
        tokens = tokens + self.self_attn(self.norm1(tokens))
        return tokens + self.mlp(self.norm2(tokens))


class Stack(nn.Module):  # type: ignore[misc]
    """The layers and a last normalisation."""

    def __init__(self, shape: PartFieldShape) -> None:
        super().__init__()
        self.layers = nn.ModuleList([Layer(shape.width, shape.heads) for _ in range(shape.layers)])
        self.norm = nn.LayerNorm(shape.width, eps=_EPS)

    def forward(self, tokens: Tensor) -> Tensor:
        """Map [n, width] to the same."""
        for layer in self.layers:
            tokens = layer(tokens)
        return self.norm(tokens)


class TriplaneTransformer(nn.Module):  # type: ignore[misc]
    """Planes four times coarser, through the transformer, upsampled and added to the input."""

    def __init__(self, shape: PartFieldShape) -> None:
        super().__init__()
        wide = shape.width
        planes = shape.plane_channels
        self.shape = shape
        self.pos_embed = nn.Parameter(torch.zeros(1, 3 * shape.coarse**2, wide))
        self.downsampler = nn.Sequential(
            nn.Conv2d(shape.channels, wide, 3, padding=1),
            nn.ReLU(inplace=True),
            nn.MaxPool2d(2),
            nn.Conv2d(wide, wide, 3, padding=1),
            nn.ReLU(inplace=True),
            nn.MaxPool2d(2),
        )
        self.transformer = Stack(shape)
        self.upsampler = nn.ConvTranspose2d(wide, planes, 4, stride=4)
        self.mlp = nn.Sequential(
            nn.Linear(shape.channels, planes), nn.ReLU(inplace=True), nn.Linear(planes, planes)
        )

    def forward(self, planes: Tensor) -> Tensor:
        """Map [1, 3, channels, n, n] to [1, 3, plane_channels, n, n]."""
        # One plane at a time: the first layer's result takes 67 MB per plane at the released size.
        coarse = torch.cat([self.downsampler(plane) for plane in planes.unbind(1)])
        tokens = coarse.flatten(2).transpose(1, 2).reshape(-1, self.shape.width)
        tokens = self.transformer(tokens + self.pos_embed[0])
        coarse = (
            tokens.reshape(3, -1, self.shape.width)
            .transpose(1, 2)
            .unflatten(2, (self.shape.coarse, -1))
        )
        cells = self.mlp(planes[0].permute(0, 2, 3, 1).contiguous()).permute(0, 3, 1, 2)
        return (self.upsampler(coarse) + cells)[None]
