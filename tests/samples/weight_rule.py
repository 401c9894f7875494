"""Weights from names alone: the same numbers everywhere, so that no test has to store a network."""

import hashlib
import math

import numpy as np
import torch  # noqa: TID253


def weights(shapes, base, gains=None):
    """Name to tensor, for a mapping from name to shape."""
    return {
        name: torch.from_numpy(weight(name, tuple(shape), base, gains or {}))
        for name, shape in shapes.items()
    }


def weight(name, shape, base, gains):
    """One tensor's numbers: uniform, seeded by the tensor's name."""
    digest = hashlib.sha256(f"{base}:{name}".encode()).digest()
    source = np.random.RandomState(int.from_bytes(digest[:4], "little"))
    uniform = 2.0 * source.random_sample(math.prod(shape)).reshape(shape) - 1.0
    path = name.split(".")
    if path[-1] == "pos_embed":
        values = 0.05 * uniform
    elif len(shape) >= 2:
        gain = next((gain for start, gain in gains.items() if name.startswith(start)), 1.0)
        values = uniform * gain * np.sqrt(3.0 / math.prod(shape[1:]))
    elif path[-1] == "weight" and "norm" in path[-2]:
        values = 1.0 + 0.2 * uniform
    else:
        values = 0.1 * uniform
    return values.astype(np.float32)
