"""What decides which sampled object is made of an object, and what making it may cost."""

from __future__ import annotations

from dataclasses import dataclass

from asset_factory.factory.config import IntakeConfig
from asset_factory.factory.errors import ConfigError
from asset_factory.sim_checks.processes.isolation import Limits

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
        max_bytes: most that the files of one object may hold together [bytes].
        max_faces: most triangles of one object.
        wall_s: longest that one object may take [s].
        memory_bytes: most address space of the process that reads it [bytes].
    """

    points: int = 16_384
    front: str = "auto"
    skin: bool = False
    max_bytes: int = 512 * 1024 * 1024
    max_faces: int = 1_000_000
    wall_s: float = 120.0
    memory_bytes: int = 8 * 1024**3

    def __post_init__(self) -> None:
        if self.front not in ("auto", *FRONTS):
            raise ConfigError(f"front {self.front!r}: want auto, {', '.join(FRONTS)}")
        if self.points < 1:
            raise ConfigError(f"points {self.points}: want at least 1")

    @property
    def intake(self) -> IntakeConfig:
        """Return the limits as mesh intake wants them."""
        return IntakeConfig(max_bytes=self.max_bytes, max_faces=self.max_faces)

    @property
    def limits(self) -> Limits:
        """Return what the process that reads one object may use."""
        return Limits(wall_s=self.wall_s, memory_bytes=self.memory_bytes)

    @property
    def decisive(self) -> dict[str, int | str]:
        """Return the settings that decide the output, for the key: patience and memory do not."""
        free = ("wall_s", "memory_bytes")
        return {name: value for name, value in vars(self).items() if name not in free}
