"""The fallbacks of an exact split: CoACD, halves, one hull; each is reported."""

from __future__ import annotations

from functools import partial

from manifold3d import Manifold

from asset_factory.sim_checks import Finding, Severity
from asset_factory.sim_checks.processes.isolation import Failure, Limits, run_isolated
from asset_factory.sim_checks.report import KILLED, OUT_OF_TIME

from ...asset import Hull
from ...config import DecomposeConfig
from ...errors import Unjudged
from .child import Triangles, coacd_pieces
from .convex import hull_of
from .cut import halve
from .pieces import NOTHING, SolidPieces
from .simplify import VOLUME_SHARE, smoothed
from .solids import manifold_of_hull, triangles_of, union

#: CoACD is not asked of solids that keep more faces than this when simplified by the error. Its
#: time goes by the pieces it makes, 0.1 to 0.3 s each: a torus that keeps 1,234 took 5 s for 28,
#: blobs of 1,196 and 1,282 26 s for 101 and 172, one of 2,702 42 s for 515 with a sixth of the
#: search.
INTRICATE = 1300
#: Halves are no more than this, and may lie outside by so many times the error asked for.
MOST_HALVES = 64
HALVED_FACTOR = 2.0


def search(solid: Manifold, error_m: float, config: DecomposeConfig) -> SolidPieces:
    """Return the pieces of one connected solid by the first way that gives acceptable ones.

    CoACD leaves no concavity larger than ``error_m`` [m]; halves of it may fill more. One convex
    hull where neither does; nothing if the solid is so thin that not even that is a body. A
    sentence tells of each way that failed.

    Raises ImportError: CoACD is not installed. RuntimeError: child processes cannot be started
    at all, say because the main module runs on import. Unjudged: CoACD hung, or somebody ended
    it; a clock makes no hulls coarser.
    """
    light = smoothed(solid, error_m, config)
    found, fault = _asked(solid, light, error_m, config)
    hulls = [hull for vertices, _ in found if (hull := hull_of(vertices)) is not None]
    fault = fault or complaint(solid, hulls, error_m)
    if fault is None:
        return SolidPieces(tuple(hulls), "coacd")
    degraded = (f"CoACD: {fault}",)
    # As fine as may be: nothing splits them again.
    fine = min(error_m, config.error_m)
    hulls = halve(light, fine, min(config.max_hulls, MOST_HALVES))
    fault = complaint(solid, hulls, HALVED_FACTOR * error_m)
    if fault is None:
        return SolidPieces(tuple(hulls), "halved", degraded)
    whole = hull_of(triangles_of(solid)[0])
    if whole is None:
        return NOTHING
    said = "one convex hull stands for a solid that is not convex"
    return SolidPieces((whole,), "hull", (*degraded, f"halves: {fault}", said))


def _asked(
    solid: Manifold, light: Manifold, error_m: float, config: DecomposeConfig
) -> tuple[list[Triangles], str | None]:
    """Ask CoACD for pieces of a solid, if it is simple; else, say why there are none.

    It is given the solid with fewer faces, ``light``, unless that has too many.

    Raises:
        ImportError, RuntimeError, Unjudged: as :func:`search`.
    """
    limits = Limits(wall_s=config.wall_s, memory_bytes=config.memory_bytes)
    # One pass leaves what the next one takes away.
    within = solid.simplify(0.5 * error_m).simplify(0.5 * error_m)
    given = light if light.num_tri() <= config.max_faces else within
    if within.num_tri() > INTRICATE or not 0 < given.num_tri() <= config.max_faces:
        simpler = f"simplified by {1000 * error_m:.3g} mm it has {within.num_tri()} faces"
        return [], f"{simpler}, want at most {INTRICATE}"
    ask = partial(run_isolated, coacd_pieces, triangles_of(given), error_m, config, limits=limits)
    outcome = ask()
    if outcome.failure is Failure.CRASHED and not (outcome.killed or outcome.exited):
        # Native code that dies of the same triangles twice dies of them.
        outcome = ask()
    if isinstance(outcome.error, ImportError) or outcome.exited:
        # Not the mesh's doing: it is not installed, or the program cannot start children.
        outcome.unwrap()
    message = f"CoACD: {outcome.detail}"
    if outcome.failure is Failure.TIMEOUT:
        raise Unjudged(Finding("decomposition_timeout", Severity.ERROR, message, cause=OUT_OF_TIME))
    if outcome.killed:
        raise Unjudged(Finding("decomposition_killed", Severity.ERROR, message, cause=KILLED))
    if outcome.failure is not None:
        return [], f"{outcome.failure}, {outcome.detail}"
    return outcome.value or [], None


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
