"""The fallbacks of an exact split: CoACD, coarser CoACD, V-HACD, one hull; each is reported."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from manifold3d import Manifold

from asset_factory.sim_checks.processes.isolation import Limits, Outcome, run_isolated

from ...asset import Hull
from ...config import DecomposeConfig
from .child import Search, Triangles, coacd_pieces, vhacd_pieces
from .convex import hull_of
from .simplify import simplified
from .solids import manifold_of_hull, triangles_of, union

#: A decomposition may leave this share of the solid uncovered; simplifying shaves some off.
BARE_LIMIT = 0.02
#: V-HACD works on voxels: its hulls may lie outside by this many times the error asked for.
VOXEL_FACTOR = 2.0


@dataclass(frozen=True)
class Rung:
    """What one solid came to.

    Attributes:
        hulls: pieces that together cover the solid.
        method: ``coacd``, ``vhacd`` or ``hull``.
        degraded: a sentence for each attempt before this one that failed, and for what was given
            up.
        repeatable: False when a clock decided, so that another run might end elsewhere.
    """

    hulls: tuple[Hull, ...]
    method: str
    degraded: tuple[str, ...] = ()
    repeatable: bool = True


@dataclass(frozen=True)
class _Attempt:
    name: str
    method: str
    run: Callable[[], Outcome[list[Triangles]]]
    outside_m: float


def climb_down(solid: Manifold, error_m: float, config: DecomposeConfig) -> Rung | None:
    """Hulls of one connected solid by the first method that gives acceptable ones.

    Args:
        solid: a closed manifold [m], too curved to be cut along its own faces.
        error_m: largest concavity left [m].
        config: limits of the child processes, the search's seed and the face limit.

    Returns:
        ``None`` if the solid is so thin that not even its convex hull is a body.

    Raises:
        ImportError: an engine is not installed.
        RuntimeError: child processes cannot be started at all, say because the main module runs on
            import.
    """
    degraded: list[str] = []
    repeatable = True
    for attempt in _attempts(solid, error_m, config):
        outcome = attempt.run()
        if isinstance(outcome.error, ImportError) or outcome.exited:
            # Not the mesh's doing: the engine is not installed, or the program cannot start
            # children.
            outcome.unwrap()
        if outcome.failure is not None:
            repeatable = False
            degraded.append(f"{attempt.name}: {outcome.failure}, {outcome.detail}")
            continue
        hulls = [
            hull for vertices, _ in outcome.value or [] if (hull := hull_of(vertices)) is not None
        ]
        fault = complaint(solid, hulls, attempt.outside_m)
        if fault is None:
            return Rung(tuple(hulls), attempt.method, tuple(degraded), repeatable)
        degraded.append(f"{attempt.name}: {fault}")
    whole = hull_of(triangles_of(solid)[0])
    if whole is None:
        return None
    return Rung(
        (whole,),
        "hull",
        (*degraded, "one convex hull stands for a solid that is not convex"),
        repeatable,
    )


def _attempts(solid: Manifold, error_m: float, config: DecomposeConfig) -> Iterator[_Attempt]:
    limits = Limits(wall_s=config.wall_s, cpu_s=config.cpu_s, memory_bytes=config.memory_bytes)
    search = Search(
        error_m=error_m,
        resolution=config.resolution,
        iterations=config.iterations,
        nodes=config.nodes,
        depth=config.search_depth,
        seed=config.seed,
    )
    fine = triangles_of(simplified(solid, config.max_faces, 0.1 * error_m))
    yield _Attempt(
        "CoACD", "coacd", lambda: run_isolated(coacd_pieces, fine, search, limits=limits), error_m
    )
    coarse = triangles_of(simplified(solid, config.max_faces // 4, 0.5 * error_m))
    doubled = replace(search, error_m=2.0 * error_m)
    yield _Attempt(
        "CoACD on a coarser mesh with twice the error",
        "coacd",
        lambda: run_isolated(coacd_pieces, coarse, doubled, limits=limits),
        2.0 * error_m,
    )
    yield _Attempt(
        "V-HACD",
        "vhacd",
        lambda: run_isolated(vhacd_pieces, fine, min(config.max_hulls, 64), limits=limits),
        VOXEL_FACTOR * error_m,
    )


def complaint(solid: Manifold, hulls: list[Hull], outside_m: float) -> str | None:
    """What is wrong with ``hulls`` as a cover of ``solid``; ``None`` if nothing is.

    Args:
        solid: what they should cover.
        hulls: convex pieces.
        outside_m: how far they may lie outside, averaged over the solid's surface [m].
    """
    if not hulls:
        return "no piece is a body"
    cover = union([manifold_of_hull(hull) for hull in hulls])
    bare = (solid - cover).volume() / solid.volume()
    if bare > BARE_LIMIT:
        return (
            f"{100 * bare:.1f} % of the volume is left uncovered, "
            f"want at most {100 * BARE_LIMIT:g} %"
        )
    outside = (cover - solid).volume() / solid.surface_area()
    if outside > outside_m:
        return (
            f"the pieces lie {1000 * outside:.2f} mm outside on average, "
            f"want at most {1000 * outside_m:.2f} mm"
        )
    return None
