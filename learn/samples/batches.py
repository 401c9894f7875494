"""Samples side by side: arrays for one step of training."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from .sample import Sample

Array = Any
NO_PARENT = -1
_PER_PART = {
    "parents": ((), np.int64, NO_PARENT),
    "motion": ((), np.int64, 0),
    "revolute_direction": ((3,), np.float32, 0),
    "revolute_range": ((2,), np.float32, 0),
    "prismatic_direction": ((3,), np.float32, 0),
    "prismatic_range": ((2,), np.float32, 0),
}


@dataclass(frozen=True)
class Batch:
    """Samples with equally many points, as arrays or tensors, network frame; root part first.

    Attributes:
        points, normals: shape [batch, n, 3], float32.
        features: shape [batch, n, channels], float32, or ``None``.
        part_ids: part of each point, shape [batch, n], int64.
        counts: parts of each sample, shape [batch], int64.
        parents: part each part hangs on, -1 for none, shape [batch, parts], int64.
        motion: class of each part, shape [batch, parts], int64.
        revolute_direction, prismatic_direction: zero where it does not, [batch, parts, 3].
        revolute_range, prismatic_range: from the pose [rad, longest side], [batch, parts, 2].
        closest_points: on the part's axis, nearest to each point; zero without, [batch, n, 3].
    """

    points: Array
    normals: Array
    features: Array | None
    part_ids: Array
    counts: Array
    parents: Array
    motion: Array
    revolute_direction: Array
    revolute_range: Array
    prismatic_direction: Array
    prismatic_range: Array
    closest_points: Array

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
        values = (getattr(self, each.name) for each in fields(self))
        return Batch(*(None if value is None else change(value) for value in values))


def collate(samples: Sequence[Sample], parts: int) -> Batch:
    """Return samples of equally many points and at most ``parts`` parts as one batch of arrays."""
    rows: dict[str, Array] = {}
    for name, (shape, dtype, empty) in _PER_PART.items():
        rows[name] = np.full((len(samples), parts, *shape), empty, dtype=dtype)
        for row, sample in zip(rows[name], samples, strict=True):
            row[: len(sample.parents)] = getattr(sample, name)
    featured = samples[0].features is not None
    return Batch(
        points=_stacked(samples, "points", np.float32),
        normals=_stacked(samples, "normals", np.float32),
        features=_stacked(samples, "features", np.float32) if featured else None,
        part_ids=_stacked(samples, "part_ids", np.int64),
        counts=np.array([len(sample.parents) for sample in samples], dtype=np.int64),
        closest_points=_stacked(samples, "closest_points", np.float32),
        **rows,
    )


def join(batches: Sequence[Batch], order: Sequence[int]) -> Batch:
    """Return the batches of arrays, one after the other, their rows put in an order."""
    rows = np.asarray(order, dtype=np.int64)
    columns = ([getattr(batch, each.name) for batch in batches] for each in fields(Batch))
    return Batch(*(None if each[0] is None else np.concatenate(each)[rows] for each in columns))


def _stacked(samples: Sequence[Sample], name: str, dtype: Any) -> Array:
    return np.stack([np.asarray(getattr(sample, name), dtype=dtype) for sample in samples])
