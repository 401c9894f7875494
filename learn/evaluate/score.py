"""The numbers that one object got."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Score:
    """What one prediction is worth: numbers of the object and of its parts, by name.

    Over many objects the mean of ``values`` is taken; of ``pooled`` numbers all parts count alike.
    Shares are 0 or 1 per part.
    """

    values: Mapping[str, float]
    pooled: Mapping[str, tuple[float, ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        values = {name: float(value) for name, value in self.values.items()}
        pooled = {name: tuple(float(v) for v in each) for name, each in self.pooled.items()}
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "pooled", pooled)
