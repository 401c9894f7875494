"""Tensors that lie in a file, not yet read."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

Tensor = Any
Shape = tuple[int, ...]


@dataclass(frozen=True)
class StoredTensor:
    """One tensor of a file.

    Attributes:
        dtype: its type, as the safetensors format names it, e.g. ``F32``.
        shape: elements per dimension.
        load: reads it: a torch tensor, contiguous, in memory of its own. Raises ConfigError if the
            file ends before the tensor does.
    """

    dtype: str
    shape: Shape
    load: Callable[[], Tensor] = field(repr=False, compare=False)


@dataclass(frozen=True)
class Checkpoint:
    """A file of tensors.

    Attributes:
        file: where.
        tensors: by name.
        metadata: what the file says about itself.
    """

    file: Path
    tensors: Mapping[str, StoredTensor]
    metadata: Mapping[str, str] = field(default_factory=dict)

    @property
    def shapes(self) -> dict[str, Shape]:
        """Name to shape."""
        return {name: tensor.shape for name, tensor in self.tensors.items()}
