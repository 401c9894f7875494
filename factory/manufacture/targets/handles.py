"""What of a moving part is called its handle: found in its shape, never in a name."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...articulation import Articulation
from ...asset import Handle
from .poses import far_side, fronts, on_protrusions, on_side
from .shape import Moving, shape_of


def find_handle(articulation: Articulation, part: int) -> Handle | None:
    """Return the geometry of a part, at rest, that is called its handle.

    See :func:`handle_of`. Pieces on fixed joints below the part count as its own. ``None`` where no
    joint moves the part, or it has no geometry.
    """
    joint = articulation.parent_joint(part)
    if joint is None or not joint.movable:
        return None
    shape = shape_of(articulation, part)
    if not len(shape.faces):
        return None
    handle = handle_of(Moving(joint, shape))
    own = np.isin(shape.faces, articulation.parts[part].faces)
    if not own.any() or np.isin(handle.faces, shape.faces[own]).any():
        return handle
    # Whoever looks for a handle looks on the link that moves, not on those fixed to it.
    side = next(on_side(Moving(joint, shape.only(own)), handle.normal))
    return replace(handle, faces=np.union1d(handle.faces, side.faces))


def handle_of(moving: Moving) -> Handle:
    """Return the best thing that sticks out of a part, or else where one would pull if one could.

    That is the edge far from the hinge, the rim of what turns on the spot, or the middle of the
    front; the handle then is the flat patch around that place, so that everybody who looks for a
    handle's geometry finds some on every moving part. ``source`` says how it was found:
    ``protrusion``, ``far_edge``, ``rim`` or ``front``.
    """
    found = None if moving.spins else next(on_protrusions(moving, fronts(moving)[0]), None)
    place = found or next(on_side(moving, far_side(moving)))
    otherwise = "rim" if moving.spins else "far_edge" if moving.joint.turns else "front"
    pull = moving.pull(place.point)
    return Handle(
        place.point,
        place.normal,
        pull if pull.any() else moving.joint.axis,
        place.faces,
        "protrusion" if found else otherwise,
    )
