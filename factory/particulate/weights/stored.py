"""Tensors that lie in a file, not yet read."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import ConfigError

Tensor = Any
Shape = tuple[int, ...]

# Names as in the safetensors format. numpy has no bfloat16; its bytes travel as 16-bit integers.
ITEM_BYTES = {
    "F64": 8,
    "F32": 4,
    "F16": 2,
    "BF16": 2,
    "I64": 8,
    "I32": 4,
    "I16": 2,
    "I8": 1,
    "U8": 1,
    "BOOL": 1,
}
_TORCH = {
    "F64": "float64",
    "F32": "float32",
    "F16": "float16",
    "BF16": "bfloat16",
    "I64": "int64",
    "I32": "int32",
    "I16": "int16",
    "I8": "int8",
    "U8": "uint8",
    "BOOL": "bool",
}


@dataclass(frozen=True)
class StoredTensor:
    """Where one tensor's bytes lie.

    Attributes:
        file: that holds them.
        name: of the tensor.
        dtype: a key of ``ITEM_BYTES``.
        shape: elements per dimension.
        strides: elements from one index to the next, per dimension.
        start: of the first element in the file [byte].
    """

    file: Path
    name: str
    dtype: str
    shape: Shape
    strides: Shape
    start: int

    @property
    def item_bytes(self) -> int:
        """Bytes of one element."""
        return ITEM_BYTES[self.dtype]

    @property
    def span(self) -> int:
        """Elements from the first to the last, both included."""
        if math.prod(self.shape) == 0:
            return 0
        return 1 + sum(
            (size - 1) * stride for size, stride in zip(self.shape, self.strides, strict=True)
        )

    @property
    def nbytes(self) -> int:
        """Bytes the tensor takes in the file."""
        return self.span * self.item_bytes

    def load(self) -> Tensor:
        """The tensor, contiguous, in memory of its own.

        Raises:
            ConfigError: the file ends before the tensor does.
        """
        import torch

        with self.file.open("rb") as file:
            file.seek(self.start)
            data = np.fromfile(file, dtype=np.uint8, count=self.nbytes)
        if data.size != self.nbytes:
            raise ConfigError(
                f"{self.file}: {self.name} is cut off: {data.size} of {self.nbytes} bytes are there"
            )
        if self.nbytes == 0:
            return torch.empty(self.shape, dtype=getattr(torch, _TORCH[self.dtype]))
        flat = torch.from_numpy(data).view(getattr(torch, _TORCH[self.dtype]))
        return flat.as_strided(self.shape, self.strides).contiguous()


@dataclass(frozen=True)
class Checkpoint:
    """A file of tensors.

    Attributes:
        file: where.
        tensors: by name, in the file's order.
        metadata: what the file says about itself.
    """

    file: Path
    tensors: Mapping[str, StoredTensor]
    metadata: Mapping[str, str] = field(default_factory=dict)

    @property
    def shapes(self) -> dict[str, Shape]:
        """Name to shape."""
        return {name: tensor.shape for name, tensor in self.tensors.items()}


def dense_strides(shape: Shape) -> Shape:
    """Strides of a contiguous tensor, last index fastest [element]."""
    return tuple(math.prod(shape[axis + 1 :]) for axis in range(len(shape)))


def dtype_name(tensor: Tensor) -> str:
    """The format's name for a torch tensor's type.

    Raises:
        ConfigError: the format has none.
    """
    plain = str(tensor.dtype).removeprefix("torch.")
    names = [name for name, torch_name in _TORCH.items() if torch_name == plain]
    if not names:
        raise ConfigError(
            f"tensors of {plain} cannot be saved; there are {', '.join(_TORCH.values())}"
        )
    return names[0]
