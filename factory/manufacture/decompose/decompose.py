"""The stage: every part of an articulation as convex hulls."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from functools import partial

from ...articulation import Articulation
from ...config import DecomposeConfig
from ...errors import InputRejected
from ...mesh import Mesh
from ...runtime.keys import Stage
from ...runtime.stages import Stages
from .part import split_part
from .pieces import SolidPieces
from .room import Room

DECOMPOSE = Stage(
    "decompose",
    code=(__name__,),
    settings=("decompose",),
    libraries=("coacd", "manifold3d", "scipy"),
)


def decompose(
    articulation: Articulation,
    stages: Stages,
    room_of: Callable[[int], Room],
    known: Sequence[SolidPieces | None] = (),
    hollow: Collection[str] = (),
) -> tuple[SolidPieces, ...]:
    """Return the convex hulls for every part, in the parts' order.

    Args:
        articulation: whose parts are decomposed, in the object frame at rest, each where no other
            one is or passes.
        stages: with the settings and the cache.
        room_of: what others take of each part's, see :func:`~.room.rooms_of`.
        known: hulls of parts that have them already, ``None`` for the others; empty: of none.
        hollow: names of parts whose open surfaces are walls, never closed or filled.

    Raises:
        InputRejected: ``decomposition_failed`` where no body can be made of a part.
        Unjudged: an engine hung, or somebody ended it.
    """
    config = stages.config.decompose
    results = []
    for index, part in enumerate(articulation.parts):
        given = known[index] if known else None
        if given is not None:
            results.append(given)
            continue
        if not len(part.faces):
            results.append(SolidPieces((), "none"))
            continue
        mesh = articulation.part_mesh(index)
        room = room_of(index)
        how = ("hollow",) if part.name in hollow else ()
        key = DECOMPOSE.key(stages.config, mesh.vertices, mesh.faces, room.points, *how)
        make = partial(_decompose_part, part.name, mesh, config, room, bool(how))
        results.append(stages.recall("decompose", SolidPieces, key, make))
    return tuple(results)


def error_for(mesh: Mesh, config: DecomposeConfig) -> float:
    """Return how far hulls may be off a part's surface, away from others [m]: more on larger."""
    most = max(config.error_m, config.coarsest_m)
    return min(max(config.error_m, config.error_share * mesh.diagonal), most)


def _decompose_part(
    name: str, mesh: Mesh, config: DecomposeConfig, room: Room, hollow: bool
) -> SolidPieces:
    """Return the hulls of one part."""
    error_m = error_for(mesh, config)
    pieces = split_part(mesh.vertices, mesh.faces, error_m, config, room, hollow)
    if pieces is None:
        raise InputRejected(
            "decomposition_failed",
            f"part {name!r}: none of its {len(mesh.faces)} faces makes a body to collide with; "
            "want a closed solid or a surface larger than a grain",
        )
    return pieces
