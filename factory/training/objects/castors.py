"""Wheels on fixed axles, and wheels in forks that swivel."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...mesh import Material, Mesh
from .rounds import lathe, turned
from .solids import box
from .trees import Limb, wheel

#: Between a wheel and its fork, and between a fork and what it swivels under [m].
PLAY = 0.0012


def disc(
    center: Sequence[float],
    radius: float,
    wide: float,
    rim: Material,
    hub: Material,
    axis: int = 0,
    sides: int = 24,
) -> list[Mesh]:
    """A wheel about a coordinate axis: a tyre with rounded shoulders and a hub that stands out a little [m]."""
    half, soft = wide / 2, min(0.25 * wide, 0.2 * radius)
    tyre = [
        (radius - soft, -half),
        (radius, -half + soft),
        (radius, half - soft),
        (radius - soft, half),
    ]
    core = [(0.35 * radius, -half - 0.0008), (0.35 * radius, half + 0.0008)]
    return [lathe(axis, center, tyre, rim, sides), lathe(axis, center, core, hub, 12)]


def castor(
    name: str, x: float, y: float, top: float, radius: float, wide: float, heading: float, rim: Material,
    metal: Material, parent: str = "body", twin: bool = False,
) -> list[Limb]:  # fmt: skip
    """A fork that swivels under ``top`` [m] and the wheel in it; both turn without end.

    Args:
        name: of the fork; the wheel is called ``<name>_wheel``.
        x: of the swivel axis [m].
        y: of the swivel axis [m].
        top: underside of what it is mounted on [m]; the wheel stands ``top`` below.
        radius: of the wheel, less than half of ``top`` [m].
        wide: of the wheel [m].
        heading: which way the fork trails [rad].
        rim: material of the tyre.
        metal: material of fork and hub.
        parent: part it is mounted on.
        twin: two wheels around a middle plate, as under office chairs, instead of one between two
            plates.
    """
    trail = 0.6 * radius
    apart = wide / 2 + 0.0008 + PLAY + 0.001
    plates = [0.0] if twin else [-apart, apart]
    crown = (2 * radius + 0.003, top - PLAY)
    reach = 0.002 if twin else apart + 0.001
    fork = [
        box((x - reach - 0.004, x + reach + 0.004), (y - 0.011, y + trail + 0.004), crown, metal),
        *(
            box(
                (x + p - 0.001, x + p + 0.001),
                (y + trail - 0.3 * radius, y + trail + 0.3 * radius),
                (0.6 * radius, crown[0]),
                metal,
            )
            for p in plates
        ),
    ]
    hub = (x, y + trail, radius)
    if twin:
        half = wide / 2
        solids = disc((x - half / 2 - 0.003, *hub[1:]), radius, half, rim, metal)
        solids += disc((x + half / 2 + 0.003, *hub[1:]), radius, half, rim, metal)
    else:
        solids = disc(hub, radius, wide, rim, metal)
    axis = (float(np.cos(heading)), float(np.sin(heading)), 0.0)
    pivot = np.array([x, y, 0.0])
    center = pivot + np.array([-np.sin(heading) * trail, np.cos(heading) * trail, radius])
    return [
        wheel(name, turned(fork, (0, 0, 1), heading, pivot), (0, 0, 1), (x, y, top), parent),
        wheel(f"{name}_wheel", turned(solids, (0, 0, 1), heading, pivot), axis,
              (float(center[0]), float(center[1]), float(center[2])), name),
    ]  # fmt: skip
