"""The fallbacks of an exact split: CoACD, V-HACD, one hull; each is reported."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

from manifold3d import Manifold

from asset_factory.sim_checks import Finding, Severity
from asset_factory.sim_checks.processes.isolation import Failure, Limits, Outcome, run_isolated
from asset_factory.sim_checks.report import KILLED, OUT_OF_TIME

from ...asset import Hull
from ...config import DecomposeConfig
from ...errors import Unjudged
from .child import Triangles, coacd_pieces, vhacd_pieces
from .convex import hull_of
from .pieces import NOTHING, SolidPieces
from .simplify import VOLUME_SHARE, simplified
from .solids import manifold_of_hull, triangles_of, union

#: CoACD is not asked of solids that keep more faces than this when simplified by the error. Its
#: time goes by the pieces it makes, 0.1 to 0.3 s each: a torus that keeps 1,234 took 5 s for 28,
#: blobs of 1,196 and 1,282 26 s for 101 and 172, one of 2,702 42 s for 515 with a sixth of the
#: search.
INTRICATE = 1300
#: V-HACD works on voxels: its hulls may lie outside by this many times the error asked for.
VOXEL_FACTOR = 2.0


@dataclass(frozen=True)
class _Attempt:
    """One engine that is asked.

    Attributes:
        name: of the engine and how it is asked.
        method: as in :class:`SolidPieces`.
        run: asks it, in a child process.
        outside_m: how far its pieces may lie outside the solid, on average [m].
        too_much: why it is not asked; empty if it is.
    """

    name: str
    method: str
    run: Callable[[], Outcome[list[Triangles]]]
    outside_m: float
    too_much: str = ""


def search(solid: Manifold, error_m: float, config: DecomposeConfig) -> SolidPieces:
    """Return the pieces of one connected solid by the first engine that gives acceptable ones.

    No concavity larger than ``error_m`` is left [m]. One convex hull where no engine does; nothing
    if the solid is so thin that not even that is a body. A sentence tells of each engine that
    failed.

    Raises ImportError: an engine is not installed. RuntimeError: child processes cannot be started
    at all, say because the main module runs on import. Unjudged: an engine hung, or somebody ended
    it; a clock makes no hulls coarser.
    """
    degraded: tuple[str, ...] = ()
    for attempt in _attempts(solid, error_m, config):
        found: list[Triangles] = []
        fault: str | None = attempt.too_much
        if not fault:
            found, fault = _answer(attempt)
        hulls = [hull for vertices, _ in found if (hull := hull_of(vertices)) is not None]
        fault = fault or complaint(solid, hulls, attempt.outside_m)
        if fault is None:
            return SolidPieces(tuple(hulls), attempt.method, degraded)
        degraded += (f"{attempt.name}: {fault}",)
    whole = hull_of(triangles_of(solid)[0])
    if whole is None:
        return NOTHING
    degraded += ("one convex hull stands for a solid that is not convex",)
    return SolidPieces((whole,), "hull", degraded)


def _answer(attempt: _Attempt) -> tuple[list[Triangles], str | None]:
    """Ask an engine: its pieces, or why it has none on any machine.

    Raises:
        ImportError, RuntimeError, Unjudged: as :func:`search`.
    """
    outcome = attempt.run()
    if outcome.failure is Failure.CRASHED and not (outcome.killed or outcome.exited):
        # Native code that dies of the same triangles twice dies of them.
        outcome = attempt.run()
    if isinstance(outcome.error, ImportError) or outcome.exited:
        # Not the mesh's doing: the engine is not installed, or the program cannot start children.
        outcome.unwrap()
    message = f"{attempt.name}: {outcome.detail}"
    if outcome.failure is Failure.TIMEOUT:
        raise Unjudged(Finding("decomposition_timeout", Severity.ERROR, message, cause=OUT_OF_TIME))
    if outcome.killed:
        raise Unjudged(Finding("decomposition_killed", Severity.ERROR, message, cause=KILLED))
    if outcome.failure is not None:
        return [], f"{outcome.failure}, {outcome.detail}"
    return outcome.value or [], None


def _attempts(solid: Manifold, error_m: float, config: DecomposeConfig) -> Iterator[_Attempt]:
    """Yield every engine, the more faithful first; CoACD is not asked of intricate parts."""
    limits = Limits(wall_s=config.wall_s, memory_bytes=config.memory_bytes)
    light = simplified(solid, config.max_faces, 0.1 * error_m)
    # One pass leaves what the next one takes away.
    within = solid.simplify(0.5 * error_m).simplify(0.5 * error_m)
    given = light if light.num_tri() <= config.max_faces else within
    too_much = ""
    if within.num_tri() > INTRICATE or not 0 < given.num_tri() <= config.max_faces:
        too_much = (
            f"simplified by {1000 * error_m:.3g} mm it has {within.num_tri()} faces, "
            f"want at most {INTRICATE}"
        )
    run = partial(run_isolated, coacd_pieces, triangles_of(given), error_m, config, limits=limits)
    yield _Attempt("CoACD", "coacd", run, error_m, too_much)
    most = min(config.max_hulls, 64)
    run = partial(run_isolated, vhacd_pieces, triangles_of(light), most, limits=limits)
    yield _Attempt("V-HACD", "vhacd", run, VOXEL_FACTOR * error_m)


def complaint(solid: Manifold, hulls: list[Hull], outside_m: float) -> str | None:
    """Return the fault of ``hulls`` as a cover of ``solid``; ``None`` if they have none.

    Averaged over the solid's surface they may lie ``outside_m`` outside [m].
    """
    if not hulls:
        return "no piece is a body"
    cover = union([manifold_of_hull(hull) for hull in hulls])
    bare = (solid - cover).volume() / solid.volume()
    if bare > VOLUME_SHARE:
        return (
            f"{100 * bare:.1f} % of the volume is left uncovered, "
            f"want at most {100 * VOLUME_SHARE:g} %"
        )
    outside = (cover - solid).volume() / solid.surface_area()
    if outside > outside_m:
        return (
            f"the pieces lie {1000 * outside:.2f} mm outside on average, "
            f"want at most {1000 * outside_m:.2f} mm"
        )
    return None
