"""The stage: every part of an articulation as convex hulls."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from ...articulation import Articulation
from ...asset import Hull
from ...config import BuildConfig, DecomposeConfig
from ...errors import InputRejected
from ...mesh import Mesh
from ...runtime.keys import Stage
from ...runtime.store import Store
from .convex import aspect
from .part import PartPieces, split_part
from .room import Room, Rooms

DECOMPOSE = Stage(
    "decompose",
    code=(__name__,),
    settings=("decompose",),
    libraries=("coacd", "vhacdx", "manifold3d", "scipy"),
)
#: Hulls longer than this many times their thickness are refused by PhysX on the GPU.
OBLONG_ASPECT = 64.0
#: When a part needs too many hulls, the error is doubled this often before it is given up.
COARSER_ROUNDS = 2


@dataclass(frozen=True)
class PartHulls:
    """One part's collision geometry.

    Attributes:
        hulls: convex pieces, object frame at rest; empty for a carrier.
        method: the farthest any of its pieces had to go: ``none`` (carrier), ``exact``, ``cut``
            (along its own faces), ``single`` (one hull that fills only small dents), ``sheets``
            (slabs over open surfaces), ``coacd``, ``vhacd``, ``hull`` (one hull for what is not
            convex); ``built`` (made solid from a skin, not found in it).
        degraded: one sentence for each thing given up on the way; empty when all went well.
        exact: the hulls' union is the part's own volume, no more and no less.
        oblong: hulls more than 64 times as long as thin, which PhysX on the GPU refuses.
    """

    hulls: tuple[Hull, ...]
    method: str
    degraded: tuple[str, ...] = ()
    exact: bool = False
    oblong: int = 0


def decompose(
    articulation: Articulation,
    config: DecomposeConfig,
    store: Store | None = None,
    known: Sequence[PartHulls | None] = (),
    hollow: Collection[str] = (),
    rooms: Rooms | None = None,
) -> tuple[PartHulls, ...]:
    """Return the convex hulls for every part, in the parts' order.

    Args:
        articulation: whose parts are decomposed, in the object frame at rest, each where no other
            one is or passes.
        config: see :class:`DecomposeConfig`.
        store: results are kept here by content; without it everything is computed anew.
        known: hulls of parts that have them already, ``None`` for the others; empty: of none.
        hollow: names of parts whose open surfaces are walls, never closed or filled.
        rooms: of that articulation, where somebody else asks them, too.

    Raises:
        InputRejected: ``too_many_hulls``, or ``decomposition_failed`` where no body can be made of
            a part.
        Unjudged: an engine hung, or somebody ended it.
    """
    rooms = rooms or Rooms(articulation)
    results = []
    for index, part in enumerate(articulation.parts):
        given = known[index] if known else None
        if given is not None:
            results.append(given)
            continue
        if not len(part.faces):
            results.append(PartHulls((), "none", (), True))
            continue
        room = rooms.around(index)
        work = _Work(part.name, articulation.part_mesh(index), room, part.name in hollow)
        results.append(_cached(work, config, store))
    return tuple(results)


@dataclass(frozen=True)
class _Work:
    """One part to be decomposed.

    Attributes:
        name: of the part.
        mesh: what is seen of it.
        room: that other parts take.
        hollow: see :func:`decompose`.
    """

    name: str
    mesh: Mesh
    room: Room
    hollow: bool


def _cached(work: _Work, config: DecomposeConfig, store: Store | None) -> PartHulls:
    if store is None:
        return _decompose_part(work, config)
    build = BuildConfig(decompose=config)
    how = ("hollow",) if work.hollow else ()
    key = DECOMPOSE.key(build, work.mesh.vertices, work.mesh.faces, work.room.points, *how)
    kept = store.load(key)
    if kept is not None:
        return unpacked(kept)
    result = _decompose_part(work, config)
    store.save(key, packed(result))
    return result


def error_for(mesh: Mesh, config: DecomposeConfig) -> float:
    """How far hulls may be off a part's surface, away from others [m]: more on larger parts."""
    most = max(config.error_m, config.coarsest_m)
    return min(max(config.error_m, config.error_share * mesh.diagonal), most)


def _decompose_part(work: _Work, config: DecomposeConfig) -> PartHulls:
    name = work.name
    mesh = work.mesh
    degraded: list[str] = []
    error_m = error_for(mesh, config)
    count = 0
    for attempt in range(COARSER_ROUNDS + 1):
        pieces = split_part(mesh.vertices, mesh.faces, error_m, config, work.room, work.hollow)
        if pieces is None:
            raise InputRejected(
                "decomposition_failed",
                f"part {name!r}: none of its {len(mesh.faces)} faces makes a body to collide with; "
                "want a closed solid or a surface larger than a grain",
            )
        count = len(pieces.hulls)
        if count <= config.max_hulls:
            return _finished(pieces, degraded)
        if attempt < COARSER_ROUNDS:
            degraded.append(
                f"{count} hulls at an error of {1000 * error_m:g} mm, "
                f"more than {config.max_hulls}: "
                f"decomposed with {2000 * error_m:g} mm"
            )
            error_m *= 2.0
            config = replace(config, error_m=2.0 * config.error_m)
    raise InputRejected(
        "too_many_hulls",
        f"part {name!r}: needs {count} convex pieces even with an error of {1000 * error_m:g} mm; "
        f"want at most {config.max_hulls}: split the part or simplify its mesh",
        value=float(count),
        unit="hulls",
        limit=float(config.max_hulls),
    )


def _finished(pieces: PartPieces, degraded: list[str]) -> PartHulls:
    return PartHulls(
        hulls=pieces.hulls,
        method=pieces.method,
        degraded=(*degraded, *pieces.degraded),
        exact=pieces.exact and not degraded,
        oblong=sum(aspect(hull) > OBLONG_ASPECT for hull in pieces.hulls),
    )


def packed(result: PartHulls) -> dict[str, npt.NDArray[Any]]:
    """As arrays, for the store."""
    return {
        "vertices": np.concatenate([h.vertices for h in result.hulls]),
        "vertex_counts": np.array([len(h.vertices) for h in result.hulls], dtype=np.int64),
        "faces": np.concatenate([h.faces for h in result.hulls]),
        "face_counts": np.array([len(h.faces) for h in result.hulls], dtype=np.int64),
        "method": np.array(result.method),
        "degraded": np.array(result.degraded, dtype=np.str_),
        "exact": np.array(result.exact),
        "oblong": np.array(result.oblong),
    }


def unpacked(kept: Mapping[str, npt.NDArray[Any]]) -> PartHulls:
    """Return the inverse of :func:`packed`."""
    vertices = np.split(kept["vertices"], np.cumsum(kept["vertex_counts"])[:-1])
    faces = np.split(kept["faces"], np.cumsum(kept["face_counts"])[:-1])
    return PartHulls(
        hulls=tuple(Hull(v, f) for v, f in zip(vertices, faces, strict=True)),
        method=str(kept["method"]),
        degraded=tuple(str(s) for s in kept["degraded"]),
        exact=bool(kept["exact"]),
        oblong=int(kept["oblong"]),
    )
