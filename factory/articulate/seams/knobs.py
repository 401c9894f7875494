"""Knobs of a one-piece mesh: small things of one size in a row, which are turned."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...mesh import Mesh
from ...part import PartKind, Proposer
from ...views.raster import Side
from ...views.view import Views
from ..proposal import Motion
from ..rigid import rigid_articulation
from .handles import FEWEST, Face, Protrusion, cleared
from .placing import OpeningPart, box_before, cut_out
from .relief import Relief, relief_of

#: A knob covers so much of its box: a disc 0.79.
FULL = 0.65
#: It stands off by this share of its width; a button less.
PROUD = 0.25
#: More in a row are studs.
MOST = 10
#: Where a knob ends, before what carries it, and around it [pixels].
MARGIN = 1.0
#: Probability that small things in a row are knobs and turn.
LIKELY = 0.63


def knobs_of(mesh: Mesh, articulator: str) -> Articulation:
    """Return a one-piece mesh with the knobs of the side that has most; else one rigid part.

    Args:
        mesh: metres, z up.
        articulator: who is asked.
    """
    views = Views(mesh)
    sides = [relief_of(views[side]) for side in Side if side is not Side.BOTTOM]
    movers = max((knobs_on(side, cleared(side)) for side in sides), key=len)
    if not movers:
        return rigid_articulation(mesh, articulator, ())
    return cut_out(mesh, movers, articulator, Proposer.SIDES, LIKELY)


def knobs_on(relief: Relief, face: Face) -> tuple[OpeningPart, ...]:
    """Return the knobs of one side, if it has a row of them.

    Args:
        relief: the side.
        face: it without knobs and handles.
    """
    found = [
        handle
        for handle in face.handles
        if handle.control and handle.fill >= FULL and handle.height >= PROUD * handle.size.min()
    ]
    if not FEWEST <= len(found) <= MOST:
        return ()
    return tuple(_mover(relief, face, knob) for knob in found)


def _mover(relief: Relief, face: Face, knob: Protrusion) -> OpeningPart:
    """Return a knob that turns clockwise without end: where it stops is not seen."""
    raster = relief.raster
    right, up, away = raster.side.frame
    rows, columns = (slice(int(a), int(b) + 1) for a, b in zip(knob.low, knob.high, strict=True))
    carrier = float(np.median(face.height[rows, columns]))
    back = raster.near - (carrier + MARGIN) * raster.pixel
    low = raster.low + (knob.low[::-1] - MARGIN) * raster.pixel
    high = raster.low + (knob.high[::-1] + MARGIN) * raster.pixel
    across, height = (low + high) / 2.0
    return OpeningPart(
        kind=PartKind.KNOB,
        region=box_before(raster.side, low, high, back),
        motion=Motion.endless(away, across * right + height * up + back * away),
    )
