"""The detector's network: a picture backbone per side, attention between sides, dense answers."""

from __future__ import annotations

from typing import Any

import torch  # noqa: TID253 - loaded by whoever runs the network
from torch import nn  # noqa: TID253
from torch.nn import functional  # noqa: TID253

from .canvas import CANVAS, DEPTH_STEPS, LONGEST, NOTHING, SIDES, SORTS, WAYS
from .decode import Dense

Tensor = Any
#: Channels of what the network is given.
CUES = 9
#: Length of a dent or a bump that counts as one [pixels], and the highest that is told apart.
DENT = 9
DEEPEST = 4.0
#: Blocks of EfficientNet-Lite0: kernel, stride, expansion, width, repeats (Tan and Le 2019).
_BLOCKS = (
    (3, 1, 1, 16, 1),
    (3, 2, 6, 24, 2),
    (5, 2, 6, 40, 2),
    (3, 2, 6, 80, 3),
    (5, 1, 6, 112, 3),
    (5, 2, 6, 192, 4),
    (3, 1, 6, 320, 1),
)
#: After these blocks pictures are given on: strides 4, 8, 16 and 32.
_TAPS = (1, 2, 4, 6)
_WIDE = 96
_TOKEN = 256
_HEADS = 8
_LAYERS = 3


def cues_of(color: Tensor, depth: Tensor) -> Tensor:
    """Return what the network is given of canvases.

    Args:
        color: uint8, [n, rows, columns, 3].
        depth: as kept, int16, [n, rows, columns].
    """
    seen = depth != NOTHING
    height = heights_of(depth, seen)
    return stacked_cues(color.permute(0, 3, 1, 2).float() / 255.0, height, seen)


def heights_of(depth: Tensor, seen: Tensor) -> Tensor:
    """Return how far pixels stand out [pixels]; where nothing is seen a little under the lowest."""
    height = depth.float() / -DEPTH_STEPS
    lowest = torch.where(seen, height, 0.0).amin((1, 2), keepdim=True)
    return torch.where(seen, height, lowest - DEEPEST)


def stacked_cues(color: Tensor, height: Tensor, seen: Tensor) -> Tensor:
    """Return colours, slopes, height, dents, bumps and coverage, [n, CUES, rows, columns].

    Args:
        color: sRGB in [0, 1], [n, 3, rows, columns].
        height: how far pixels stand out [pixels], [n, rows, columns].
        seen: [n, rows, columns].
    """
    shown = seen[:, None].float()
    nearest = torch.where(seen, height, -1e9).amax((1, 2), keepdim=True)
    slopes = []
    for axis in (2, 1):
        slope = torch.zeros_like(height)
        inner = slope.narrow(axis, 1, CANVAS - 2)
        inner.copy_(height.narrow(axis, 2, CANVAS - 2) - height.narrow(axis, 0, CANVAS - 2))
        slopes.append((slope / 2.0).clamp(-3.0, 3.0) / 3.0)
    raised = height[:, None]
    dents = (closed(raised, DENT) - raised).clamp(0.0, DEEPEST) / DEEPEST
    bumps = (raised + closed(-raised, DENT)).clamp(0.0, DEEPEST) / DEEPEST
    low = ((height - nearest) / LONGEST).clamp(-1.5, 0.0)[:, None]
    shape = torch.stack(slopes, 1)
    return torch.cat(
        [torch.cat([2.0 * color - 1.0, shape, low, dents, bumps], 1) * shown, shown], 1
    )


def closed(values: Tensor, size: int) -> Tensor:
    """Return pictures [n, 1, rows, columns] whose dents of less than ``size`` pixels are filled."""
    filled = functional.max_pool2d(values, size, 1, size // 2)
    return -functional.max_pool2d(-filled, size, 1, size // 2)


class Detector(nn.Module):  # type: ignore[misc]
    """Reads five sides of an object at once, and tells so many kinds of object apart."""

    def __init__(self, kinds: int) -> None:
        super().__init__()
        self.backbone = Backbone(CUES)
        widths = [_BLOCKS[tap][3] for tap in _TAPS]
        side = CANVAS // 32
        self.tokens = nn.Conv2d(widths[-1], _TOKEN, 1)
        self.place = nn.Parameter(torch.zeros(1, len(SIDES), side * side, _TOKEN))
        layer = nn.TransformerEncoderLayer(
            _TOKEN, _HEADS, 4 * _TOKEN, 0.0, "gelu", batch_first=True, norm_first=True
        )
        self.between = nn.TransformerEncoder(layer, _LAYERS, enable_nested_tensor=False)
        self.back = nn.Conv2d(_TOKEN, _WIDE, 1)
        self.across = nn.ModuleList(nn.Conv2d(width, _WIDE, 1) for width in widths[:-1])
        self.smooth = nn.ModuleList(_smoothing() for _ in widths[:-1])
        self.last = nn.Sequential(_smoothing(), _smoothing())
        self.answer = nn.Conv2d(_WIDE, len(SORTS) + 4 + len(WAYS) + 2, 1)
        self.whole = nn.Linear(_TOKEN, kinds + 1)
        self.front = nn.Linear(_TOKEN, 1)
        nn.init.normal_(self.place, std=0.02)
        with torch.no_grad():
            self.answer.bias[: len(SORTS)] = -4.0
            self.answer.bias[len(SORTS) : len(SORTS) + 4] = 3.0

    def forward(self, cues: Tensor) -> Dense:
        """Return the detections; ``cues`` [n, 5, CUES, 256, 256]."""
        count, views = cues.shape[:2]
        levels = self.backbone(cues.flatten(0, 1))
        deep = self.tokens(levels.pop())
        rows, columns = deep.shape[2:]
        tokens = deep.flatten(2).transpose(1, 2).reshape(count, views, rows * columns, _TOKEN)
        tokens = self.between((tokens + self.place).flatten(1, 2))
        tokens = tokens.reshape(count, views, rows * columns, _TOKEN)
        inner = self.back(tokens.flatten(0, 1).transpose(1, 2).unflatten(2, (rows, columns)))
        for across, smooth in zip(reversed(self.across), reversed(self.smooth), strict=True):
            inner = functional.interpolate(inner, scale_factor=2.0, mode="nearest")
            inner = smooth(inner + across(levels.pop()))
        dense = self.answer(self.last(inner)).unflatten(0, (count, views))
        sort, edges, way, quality, opened = dense.split((len(SORTS), 4, len(WAYS), 1, 1), 2)
        sides = tokens.mean(2)
        whole = self.whole(sides.mean(1))
        return Dense(
            sort,
            edges.float().clamp(-1.0, 6.0).exp(),
            way,
            quality[:, :, 0],
            opened[:, :, 0],
            whole[:, :-1],
            whole[:, -1],
            self.front(sides[:, :4])[..., 0],
        )


class Backbone(nn.Module):  # type: ignore[misc]
    """EfficientNet-Lite0 without its classifier, for any number of channels."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.stem = _Layer(channels, 32, 3, 2)
        blocks: list[nn.Module] = []
        self.ends = []
        width = 32
        for kernel, stride, expansion, out, repeats in _BLOCKS:
            for number in range(repeats):
                blocks.append(
                    _Inverted(width, out, kernel, stride if number == 0 else 1, expansion)
                )
                width = out
            self.ends.append(len(blocks) - 1)
        self.blocks = nn.ModuleList(blocks)

    def forward(self, picture: Tensor) -> list[Tensor]:
        """Return pictures at strides 4, 8, 16 and 32."""
        taps = {self.ends[tap] for tap in _TAPS}
        inner = self.stem(picture)
        found = []
        for number, block in enumerate(self.blocks):
            inner = block(inner)
            if number in taps:
                found.append(inner)
        return found


class _Layer(nn.Module):  # type: ignore[misc]
    """A convolution padded as TensorFlow does, normalised, and cut off at 6 if so wished."""

    def __init__(
        self, given: int, width: int, kernel: int, stride: int, groups: int = 1, cut: bool = True
    ) -> None:
        super().__init__()
        total = kernel - stride
        self.pads = (total // 2, total - total // 2) * 2 if total % 2 else None
        even = 0 if self.pads else total // 2
        self.conv = nn.Conv2d(given, width, kernel, stride, even, bias=False, groups=groups)
        self.norm = nn.BatchNorm2d(width, eps=1e-3, momentum=0.05)
        self.cut = cut

    def forward(self, picture: Tensor) -> Tensor:
        """Return the layer's picture."""
        if self.pads:
            picture = functional.pad(picture, self.pads)
        inner = self.norm(self.conv(picture))
        return functional.relu6(inner) if self.cut else inner


class _Inverted(nn.Module):  # type: ignore[misc]
    """An inverted residual block (Sandler et al. 2018)."""

    def __init__(self, given: int, width: int, kernel: int, stride: int, expansion: int) -> None:
        super().__init__()
        inner = given * expansion
        layers = [_Layer(given, inner, 1, 1)] if expansion > 1 else []
        layers.append(_Layer(inner, inner, kernel, stride, inner))
        layers.append(_Layer(inner, width, 1, 1, cut=False))
        self.layers = nn.Sequential(*layers)
        self.adds = stride == 1 and given == width

    def forward(self, picture: Tensor) -> Tensor:
        """Return the block's picture."""
        inner = self.layers(picture)
        return picture + inner if self.adds else inner


def _smoothing() -> nn.Sequential:
    return nn.Sequential(
        nn.Conv2d(_WIDE, _WIDE, 3, padding=1, bias=False),
        nn.GroupNorm(8, _WIDE),
        nn.ReLU(inplace=True),
    )
