"""The network of ``factory/models/picture_network.py``, to be trained."""

from typing import Any

import torch  # noqa: TID253 - this module is only imported to train
from torch import nn  # noqa: TID253
from torch.nn import functional  # noqa: TID253

from asset_factory.factory.articulate.seams.sight import ANSWERS, CUES
from asset_factory.factory.mesh import FloatArray
from asset_factory.factory.models.picture_network import HALVINGS

Tensor = Any
#: Channels at each size, the full one first.
WIDTHS = (12, 20, 32, 48, 64)


class PictureNetwork(nn.Module):  # type: ignore[misc]
    """As :func:`~asset_factory.factory.models.picture_network.picture_scores` has it."""

    def __init__(self) -> None:
        super().__init__()
        self.first = _layer(len(CUES), WIDTHS[0], 5, 2)
        self.down = nn.ModuleList(
            _pair(WIDTHS[number], WIDTHS[number + 1]) for number in range(HALVINGS)
        )
        self.up = nn.ModuleList(
            _pair(WIDTHS[number + 1] + WIDTHS[number], WIDTHS[number])
            for number in range(1, HALVINGS)
        )
        self.last = _layer(WIDTHS[1] + WIDTHS[0], WIDTHS[0], 3, 1)
        self.answer = nn.Conv2d(WIDTHS[0], len(ANSWERS), 1)

    def forward(self, cues: Tensor) -> Tensor:
        """Return log-odds, [n, answer_count, rows / 2, columns / 2]; cues [n, cue_count, ...]."""
        levels = [self.first(cues)]
        for down in self.down:
            levels.append(down(functional.max_pool2d(levels[-1], 2)))
        inner = levels.pop()
        for up in reversed(self.up):
            inner = up(torch.cat([_doubled(inner), levels.pop()], 1))
        answer: Tensor = self.answer(self.last(torch.cat([_doubled(inner), levels.pop()], 1)))
        return answer

    def folded(self) -> dict[str, FloatArray]:
        """Return the weights and biases by layer, the normalisations folded in."""
        layers = {"first": self.first, "last": self.last}
        for way, pairs, start in (("down", self.down, 0), ("up", self.up, 1)):
            for number, pair in enumerate(pairs, start=start):
                layers |= {f"{way}_{number}.{k}": layer for k, layer in enumerate(pair)}
        found: dict[str, FloatArray] = {}
        for name, (convolution, norm, _) in layers.items():
            gain = norm.weight / torch.sqrt(norm.running_var + norm.eps)
            found[f"{name}.weight"] = _array(convolution.weight * gain.view(-1, 1, 1, 1))
            found[f"{name}.bias"] = _array(norm.bias - norm.running_mean * gain)
        found["answer.weight"] = _array(self.answer.weight)
        found["answer.bias"] = _array(self.answer.bias)
        return found


def _pair(given: int, width: int) -> nn.Sequential:
    return nn.Sequential(_layer(given, width, 3, 1), _layer(width, width, 3, 1))


def _layer(given: int, width: int, size: int, step: int) -> nn.Sequential:
    return nn.Sequential(
        nn.Conv2d(given, width, size, step, size // 2, bias=False),
        nn.BatchNorm2d(width),
        nn.ReLU(inplace=True),
    )


def _doubled(values: Tensor) -> Tensor:
    return functional.interpolate(values, scale_factor=2, mode="nearest")


def _array(values: Any) -> FloatArray:
    found: FloatArray = values.detach().numpy()
    return found
