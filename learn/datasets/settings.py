"""What decides which sampled object is made of an object, and what making it may cost."""

from __future__ import annotations

from dataclasses import dataclass

from asset_factory.factory.errors import ConfigError

FRONTS = {"-y": 0, "x": -1, "y": 2, "-x": 1}
"""Where an object's front looks, and the quarter turns about the vertical that give -Y."""


@dataclass(frozen=True)
class SourceSettings:
    """How a dataset is read.

    Attributes:
        points: of the surface, per sampled object.
        front: where the objects' doors and drawers look: ``-y``, ``x``, ``y``, ``-x``, or ``auto``,
            which is ``-x`` for PartNet-Mobility and ``-y`` for everything else.
        skin: every object is made one closed skin first, as image-to-3D tools give it.
        wall_s: longest that one object may take [s].
    """

    points: int = 16_384
    front: str = "auto"
    skin: bool = False
    wall_s: float = 120.0

    def __post_init__(self) -> None:
        if self.front not in ("auto", *FRONTS):
            raise ConfigError(f"front {self.front!r}: want auto, {', '.join(FRONTS)}")
        if self.points < 1:
            raise ConfigError(f"points {self.points}: want at least 1")
