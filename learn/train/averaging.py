"""The running mean of a network's weights, which is shipped."""

from __future__ import annotations

from typing import Any

import torch  # noqa: TID253 - this module is only imported to train


def follow(mean: Any, network: Any, decay: float) -> None:
    """Move the weights of one network towards another's; its share of ``decay`` stays.

    Weights that are whole numbers stay as they are.
    """
    now = network.state_dict()
    moved = {name: each for name, each in mean.state_dict().items() if each.is_floating_point()}
    with torch.no_grad():
        torch._foreach_lerp_(list(moved.values()), [now[name] for name in moved], 1.0 - decay)
