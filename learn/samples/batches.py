"""Samples side by side: arrays for one step of training."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from asset_factory.factory.mesh import IntArray

from .sample import Array, Sample

NO_PARENT = -1
#: What a sample has of each of its parts; the rest is of its points.
_OF_PARTS = (
    "parents", "motion", "revolute_direction", "revolute_range", "prismatic_direction",
    "prismatic_range",
)  # fmt: skip


@dataclass(frozen=True)
class Batch(Sample):
    """Samples with equally many points: their arrays, or tensors, with a first axis [batch].

    All have as many rows for parts; those without a part hold 0, and -1 for a parent. ``counts``
    are the parts of each sample, int64.
    """

    counts: Array

    def __len__(self) -> int:
        return len(self.points)

    @property
    def parts(self) -> int:
        """Return the rows for parts: the queries of the network."""
        return int(self.parents.shape[1])

    def split(self, size: int) -> Iterator[Batch]:
        """Yield the batches of at most ``size`` samples."""
        for start in range(0, len(self), size):
            yield self._map(lambda array, rows=slice(start, start + size): array[rows])

    def to(self, device: str) -> Batch:
        """Copy to tensors on a device; a GPU's copies run beside the work queued there."""
        import torch

        def moved(array: Array) -> Array:
            tensor = torch.as_tensor(array)
            return tensor if device == "cpu" else tensor.pin_memory().to(device, non_blocking=True)

        return self._map(moved)

    def _map(self, change: Any) -> Batch:
        return Batch(*(change(getattr(self, each.name)) for each in fields(self)))


def collate(samples: Sequence[Sample], parts: int) -> Batch:
    """Return samples of equally many points and at most ``parts`` parts as one batch of arrays."""
    found: dict[str, Array] = {}
    for each in fields(Sample):
        values = [getattr(sample, each.name) for sample in samples]
        if each.name not in _OF_PARTS:
            found[each.name] = np.stack(values)
            continue
        empty = NO_PARENT if each.name == "parents" else 0
        shape = (len(samples), parts, *values[0].shape[1:])
        found[each.name] = np.full(shape, empty, dtype=values[0].dtype)
        for row, value in zip(found[each.name], values, strict=True):
            row[: len(value)] = value
    return Batch(**found, counts=np.array([len(sample.parents) for sample in samples]))


def join(batches: Sequence[Batch], order: IntArray) -> Batch:
    """Return the batches of arrays, one after the other, their rows put in an order."""
    columns = ([getattr(batch, each.name) for batch in batches] for each in fields(Batch))
    return Batch(*(np.concatenate(each)[order] for each in columns))
