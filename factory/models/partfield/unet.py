"""A U-Net over three planes, in which every plane hears of the other two."""

from __future__ import annotations

import itertools
from typing import Any

import torch  # noqa: TID253 - this module is only imported to make the encoder
import torch.nn.functional as F  # noqa: N812, TID253
from torch import nn  # noqa: TID253

from ..network.layers import named
from .shape import NORM_GROUPS

Tensor = Any
_EPS = 1e-6


def _norm(channels: int) -> Any:
    return nn.GroupNorm(min(NORM_GROUPS, channels), channels, eps=_EPS)


class PlaneExchange(nn.Module):  # type: ignore[misc]
    """A 1x1 convolution per plane that also sees the other two along its row and column.

    The planes lie on top of each other as one tall image, in the order xy, yz, xz.
    """

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.plane_convs = nn.ModuleList([nn.Conv2d(3 * channels, channels, 1) for _ in range(3)])

    def forward(self, stacked: Tensor) -> Tensor:
        """Map [1, channels, 3 n, n] to the same."""
        first, second, third = stacked.chunk(3, dim=2)
        # With the third plane turned over, each plane's second axis is the next one's first.
        planes = (first, second, third.transpose(2, 3))
        results = []
        for number, (plane, conv) in enumerate(zip(planes, self.plane_convs, strict=True)):
            of_columns = planes[(number + 1) % 3].mean(dim=3)[:, :, None, :].expand_as(plane)
            of_rows = planes[(number + 2) % 3].mean(dim=2)[:, :, :, None].expand_as(plane)
            results.append(conv(torch.cat([plane, of_columns, of_rows], dim=1)))
        return torch.cat([results[0], results[1], results[2].transpose(2, 3)], dim=2)


class ResBlock(nn.Module):  # type: ignore[misc]
    """Convolution, exchange between planes, convolution; plus what came in."""

    def __init__(self, inputs: int, outputs: int) -> None:
        super().__init__()
        self.norm1 = _norm(inputs)
        self.conv1 = nn.Conv2d(inputs, outputs, 3, padding=1)
        self.norm_mid = _norm(outputs)
        self.conv_3daware = PlaneExchange(outputs)
        self.norm2 = _norm(outputs)
        self.conv2 = nn.Conv2d(outputs, outputs, 3, padding=1)
        if inputs != outputs:
            self.nin_shortcut = nn.Conv2d(inputs, outputs, 1)

    def forward(self, image: Tensor) -> Tensor:
        """Map [1, inputs, 3 n, n] to [1, outputs, 3 n, n]."""
        inner = self.conv1(F.silu(self.norm1(image)))
        inner = self.conv_3daware(F.silu(self.norm_mid(inner)))
        inner = self.conv2(F.silu(self.norm2(inner)))
        return inner + (self.nin_shortcut(image) if hasattr(self, "nin_shortcut") else image)


class Up(nn.Module):  # type: ignore[misc]
    """One level on the way up: twice as fine, joined with what that level was on the way down."""

    def __init__(self, inputs: int, outputs: int) -> None:
        super().__init__()
        self.norm1 = _norm(inputs)
        self.block = ResBlock(inputs, outputs)

    def forward(self, image: Tensor, before: Tensor) -> Tensor:
        """Merge a coarse and a fine image into a fine one."""
        finer = F.interpolate(image, scale_factor=2.0, mode="nearest")
        return self.block(self.norm1(torch.cat([finer, before], dim=1)))


class PlaneUNet(nn.Module):  # type: ignore[misc]
    """The U-Net; 3x3 convolutions see across the seams of the stacked planes, as in the release.

    Args:
        levels: channels per level, finest first.
    """

    def __init__(self, channels: int, levels: tuple[int, ...]) -> None:
        super().__init__()
        pairs = zip((channels, *levels), levels, strict=False)
        self.down_convs = nn.ModuleList([named(block=ResBlock(*pair)) for pair in pairs])
        upward = list(reversed(levels))
        joined = itertools.pairwise(upward)
        self.up_convs = nn.ModuleList([Up(below + here, here) for below, here in joined])
        self.norm_out = _norm(levels[0])
        self.conv_final = nn.Conv2d(levels[0], channels, 1)

    def forward(self, planes: Tensor) -> Tensor:
        """Map [1, 3, channels, n, n] to the same."""
        image = planes.transpose(1, 2).flatten(2, 3)
        seen = []
        for number, down in enumerate(self.down_convs):
            image = down(F.avg_pool2d(image, 2) if number else image)
            seen.append(image)
        seen.pop()
        for up in self.up_convs:
            image = up(image, seen.pop())
        image = self.conv_final(F.silu(self.norm_out(image)))
        return image.unflatten(2, (3, -1)).transpose(1, 2)
