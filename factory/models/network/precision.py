"""In which type to multiply."""

from enum import StrEnum
from typing import Any


class Precision(StrEnum):
    """Type of the products over points; norms, softmax, sums and part heads are float32 regardless.

    Nothing here chooses by the machine: the same input shall give the same numbers on every one.
    """

    FLOAT32 = "float32"
    BFLOAT16 = "bfloat16"


def product_dtype(precision: Precision | str) -> Any:
    """Return the torch type that ``precision`` means."""
    import torch

    return torch.bfloat16 if Precision(precision) is Precision.BFLOAT16 else torch.float32
