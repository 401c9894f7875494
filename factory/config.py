"""One frozen configuration per stage; the defaults are here, presets in ``configs/`` state differences."""

from __future__ import annotations

from dataclasses import dataclass, field

from asset_factory.sim_checks.config import CheckConfig


@dataclass(frozen=True)
class IntakeConfig:
    """Mesh intake.

    Attributes:
        up: axis of the input that points up: ``x y z -x -y -z``, or ``auto`` (glTF: y, by its
            specification; everything else: z).
        height: real height [m] to scale to; ``None``: sidecar, else the table by category, else as is.
        max_bytes: largest input file, its buffers and textures included [bytes].
        max_faces: most triangles.
        max_texture_pixels: largest texture [pixels].
    """

    up: str = "auto"
    height: float | None = None
    max_bytes: int = 512 * 1024 * 1024
    max_faces: int = 1_000_000
    max_texture_pixels: int = 8192 * 8192


@dataclass(frozen=True)
class DecomposeConfig:
    """Convex decomposition of each part.

    Attributes:
        error_m: largest concavity CoACD leaves [m]; tied to joint clearances of a few millimetres.
        near_convex: a part that fills this share of its convex hull is one hull.
        max_faces: simplify to this many triangles before CoACD.
        max_hulls: a part that needs more is rejected, never merged: merging fills cavities.
        seed: of CoACD's search.
        cpu_s, wall_s, memory_bytes: limits of one child process [s], [s], [bytes].
    """

    error_m: float = 0.005
    near_convex: float = 0.98
    max_faces: int = 2000
    max_hulls: int = 256
    seed: int = 0
    cpu_s: float = 120.0
    wall_s: float = 240.0
    memory_bytes: int = 3 * 1024**3


@dataclass(frozen=True)
class InertiaConfig:
    """Masses.

    Attributes:
        density: of the material [kg/m3]; the default is that of chipboard and plywood.
        shell_thickness_m: wall assumed for surfaces that enclose no volume [m].
    """

    density: float = 650.0
    shell_thickness_m: float = 0.004


@dataclass(frozen=True)
class RepairConfig:
    """The loop from a rejected verdict back to the stage that can mend it: most rounds."""

    max_rounds: int = 3


@dataclass(frozen=True)
class BuildConfig:
    """One build: every stage's settings.

    Attributes:
        articulator: which method says what moves.
        simulators: who judges.
    """

    articulator: str = "auto"
    simulators: tuple[str, ...] = ("sapien",)
    intake: IntakeConfig = field(default_factory=IntakeConfig)
    decompose: DecomposeConfig = field(default_factory=DecomposeConfig)
    inertia: InertiaConfig = field(default_factory=InertiaConfig)
    checks: CheckConfig = field(default_factory=CheckConfig)
    repair: RepairConfig = field(default_factory=RepairConfig)
