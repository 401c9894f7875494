"""Wheels on fixed axles, and wheels in forks that swivel."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.articulation import rotation_about
from asset_factory.factory.mesh import Material

from .assembly import Assembly, PartDraft
from .axes import RIGHT, UP, Point, X
from .looks import BLACK
from .shapes import Form, box, lathe
from .spans import PLAY, about, ends

#: How far a hub stands out of its tyre [m].
_HUB = 0.0008


def _add_tyre(part: PartDraft, center: Point, radius: float, wide: float, metal: Material) -> None:
    """Add a tyre with rounded shoulders about an axis along x, and a hub."""
    half = wide / 2
    soft = min(0.25 * wide, 0.2 * radius)
    round_off = radius - soft
    rim = [(round_off, -half), (radius, soft - half), (radius, half - soft), (round_off, half)]
    hub = [(0.35 * radius, -half - _HUB), (0.35 * radius, half + _HUB)]
    part.add(lathe(rim, center, X))
    part.add(lathe(hub, center, X, 12), look=metal)


def wheel(
    a: Assembly, name: str, at: Point, radius: float, wide: float, metal: Material,
    rim: Material = BLACK,
) -> PartDraft:  # fmt: skip
    """Return a wheel about an axis along x through ``at`` [m], that turns without end."""
    part = a.spin(name, RIGHT, at, look=rim)
    _add_tyre(part, at, radius, wide, metal)
    return part


def bracket(x: float, y: float, radius: float, wide: float, top: float) -> list[Form]:
    """Return two plates that hold a wheel at ``(x, y, radius)`` under ``top`` [m]."""
    thick = 0.003
    plates = ends(about(wide / 2 + _HUB + PLAY + thick, x), thick)
    return [box(plate, about(0.3 * radius, y), (0.7 * radius, top)) for plate in plates]


def castor(
    a: Assembly,
    name: str,
    at: Point,
    radius: float,
    wide: float,
    heading: float,
    metal: Material,
    twin: bool = False,
) -> None:
    """Build a fork that swivels under a body, and ``<name>_wheel`` in it; both turn without end.

    The swivel's axis meets what it is mounted on at ``at`` [m], the wheel stands on z = 0; the
    fork trails towards ``heading`` [rad]. ``twin`` wheels turn around a middle plate, as under
    office chairs, others between two.
    """
    x, y, top = at
    trail = 0.6 * radius
    half = wide / 2
    apart = half + _HUB + PLAY + 0.001
    crown = (2 * radius + 0.003, top - PLAY)
    reach = 0.006 if twin else apart + 0.005
    forms = [box(about(reach, x), (y - 0.011, y + trail + 0.004), crown)]
    deep = about(0.3 * radius, y + trail)
    for side in (0.0,) if twin else (-apart, apart):
        forms.append(box(about(0.001, x + side), deep, (0.6 * radius, crown[0])))
    # Described as it rolls straight ahead, on a face that heads elsewhere.
    ahead = np.eye(4)
    ahead[:3, :3] = rotation_about(UP, heading)
    ahead[:3, 3] = (x, y, 0.0) - ahead[:3, :3] @ (x, y, 0.0)
    fork = a.spin(name, UP, at, look=metal, place=ahead)
    fork.add(*forms)
    hub = (x, y + trail, radius)
    rolling = a.spin(f"{name}_wheel", RIGHT, hub, on=fork, look=BLACK, place=ahead)
    for shift in (-half / 2 - 0.003, half / 2 + 0.003) if twin else (0.0,):
        at_tyre = (x + shift, y + trail, radius)
        _add_tyre(rolling, at_tyre, radius, half if twin else wide, metal)
