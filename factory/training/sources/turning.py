"""A specimen turned about the vertical."""

from __future__ import annotations

from dataclasses import replace

from ...articulation import rotation_about
from ...geometry.posing import UP
from ..specimen import Specimen


def turned_specimen(specimen: Specimen, yaw: float) -> Specimen:
    """The object turned about the vertical through the origin by ``yaw`` [rad], with joints."""
    turn = rotation_about(UP, yaw).T
    return replace(
        specimen,
        points=specimen.points @ turn,
        normals=specimen.normals @ turn,
        axis=specimen.axis @ turn,
        origin=specimen.origin @ turn,
        slide_direction=specimen.slide_direction @ turn,
    )
