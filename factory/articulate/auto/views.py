"""What the network sees of an object from several sides, in the object's own frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...articulation import JointKind, rotation_about
from ...config import ParticulateConfig
from ...geometry.posing import UP
from ...mesh import FloatArray, IntArray, Mesh
from ...models.particulate.decoding import DecodedPart
from ...models.particulate.frames import UnitBox
from ...models.particulate.inference import Network, infer
from ..geometric.scene import level_yaw
from ..proposal import Motion

MOST_VIEWS = 4
"""Quarter turns in a whole one."""


@dataclass(frozen=True)
class SeenPart:
    """One part in one view.

    Attributes:
        confidence: in its points, 0 to 1.
        moves: probability that it moves at all; 0 of what carries the others.
        turns: if it moves, probability that it turns.
        both: if it moves, probability that it turns and slides.
        hangs: probability that it hangs on the part it does.
        direction: of its axis or slide, object frame, shape [3]; ``None`` if it has none.
        point: on its axis [m], shape [3]; ``None`` unless it turns.
        lower, upper: limits from the pose seen [rad] or [m].
        slide: how it slides, in the views that say so; ``None`` in others.
    """

    confidence: float
    moves: float
    turns: float
    both: float
    hangs: float
    direction: FloatArray | None
    point: FloatArray | None
    lower: float
    upper: float
    slide: Motion | None = None


@dataclass(frozen=True)
class NetworkView:
    """What the network sees of the object from one side.

    Attributes:
        face_part: index into ``parts`` of every face, shape [face_count].
        parts: those seen.
    """

    face_part: IntArray
    parts: tuple[SeenPart, ...]


def look_around(
    mesh: Mesh, network: Network, config: ParticulateConfig, views: int
) -> tuple[NetworkView, ...]:
    """Return the mesh as the network sees it: levelled, then turned by quarters between views.

    A network that knows what it sees says the same from every side; where it does not, it guesses.

    Args:
        mesh: metres, z up.
        network: answers for one cloud of points.
        config: how the mesh is shown.
        views: how many, 1 to 4.

    Raises:
        InputRejected: ``empty``, ``zero_size``, ``prediction_not_finite``.
    """
    level = -level_yaw(mesh.vertices[mesh.faces])
    return tuple(
        _view(mesh, network, config, level + quarter * np.pi / 2.0, quarter)
        for quarter in range(views)
    )


def _view(
    mesh: Mesh, network: Network, config: ParticulateConfig, yaw: float, number: int
) -> NetworkView:
    turn = rotation_about(UP, yaw)
    shown = ParticulateConfig(
        points=config.points,
        context_points=config.context_points,
        max_faces=config.max_faces,
        seed=config.seed + number,
        fused_share=config.fused_share,
    )
    found = infer(mesh.vertices @ turn.T, mesh.faces, network, shown).chosen
    return NetworkView(
        found.face_part, tuple(_seen(part, found.box, turn.T) for part in found.parts)
    )


def _seen(part: DecodedPart, box: UnitBox, back: FloatArray) -> SeenPart:
    motion = part.motion
    fixed, turning, _, both = motion.probabilities
    held = part.parent_probability
    slide = None
    moves = max(1.0 - fixed, np.finfo(np.float64).tiny)
    direction = None
    point = None
    limits = (0.0, 0.0)
    if motion.slide_direction is not None:
        ends = (motion.slide[0] * box.size, motion.slide[1] * box.size)
        axis = back @ motion.slide_direction
        slide = Motion(JointKind.PRISMATIC, axis, np.zeros(3), *ends)
    if motion.axis is not None:
        direction = back @ motion.axis.direction
        point = back @ (box.outwards[:3, :3] @ motion.axis.point + box.outwards[:3, 3])
        limits = motion.turn
    elif slide is not None:
        direction = slide.axis
        limits = (slide.lower, slide.upper)
    return SeenPart(
        confidence=part.confidence,
        moves=0.0 if held is None else 1.0 - fixed,
        turns=(turning + both) / moves,
        both=both / moves,
        hangs=held or 0.0,
        direction=direction,
        point=point,
        lower=limits[0],
        upper=limits[1],
        slide=slide,
    )
