"""The one interface behind which every physics engine stands."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from ..config import MotionConfig


@dataclass(frozen=True)
class LoadedLink:
    """A link as the simulator holds it: mass [kg], shape count, principal moments [kg m2] ascending, or None if static."""

    name: str
    mass: float
    shapes: int
    moments: tuple[float, float, float] | None


@dataclass(frozen=True)
class LoadedJoint:
    """A joint as the simulator holds it; limits [rad] or [m], infinite where it has none."""

    name: str
    kind: str
    lower: float
    upper: float
    damping: float | None
    friction: float | None


@dataclass(frozen=True)
class JointMotion:
    """What one joint did when driven from lower to upper and back.

    Attributes:
        joint: its name.
        reached: highest share of the range reached, 0..1.
        returned: share of the range left open after driving back, 0..1.
        overshoot: furthest beyond a limit [rad] or [m].
        others_moved: largest movement of any other joint, as a share of its own range.
        peak_speed: [rad/s] or [m/s].
        finite: False if a NaN or infinity appeared.
    """

    joint: str
    reached: float
    returned: float
    overshoot: float
    others_moved: float
    peak_speed: float
    finite: bool


@dataclass(frozen=True)
class LoadedModel:
    """Everything a loader kept, and what it said while loading."""

    links: tuple[LoadedLink, ...]
    joints: tuple[LoadedJoint, ...]
    warnings: tuple[str, ...]


class Simulator(Protocol):
    """One physics engine. Methods run inside a killable child process and import the engine there."""

    @property
    def name(self) -> str:
        """How it is chosen, e.g. ``sapien``."""

    @property
    def formats(self) -> tuple[str, ...]:
        """Description formats it loads: ``urdf``, ``mjcf``."""

    def version(self) -> str | None:
        """The installed engine's version, without importing it; ``None`` if it is not installed."""

    def load(self, path: Path) -> LoadedModel:
        """Load with the base fixed and count what arrived. Raises ValueError with the loader's own words."""

    def sweep(self, path: Path, config: MotionConfig) -> tuple[JointMotion, ...]:
        """Drive every movable joint from lower to upper and back by a bounded force, gravity on."""
