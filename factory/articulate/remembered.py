"""The articulation of an input, remembered: the network that it takes is not asked twice the same."""

from __future__ import annotations

from dataclasses import dataclass

from ..articulation import Articulation, Joint, Part, Weights
from ..keys import articulate_key
from ..mesh.intake import Intake
from ..stages import Stages
from .choose import articulate


@dataclass(frozen=True)
class _Tree:
    """An articulation without its mesh, which the input still says."""

    parts: tuple[Part, ...]
    joints: tuple[Joint, ...]
    articulator: str
    notes: tuple[str, ...]
    weights: tuple[Weights, ...]


def articulated(intake: Intake, loaded: str, stages: Stages) -> Articulation:
    """As :func:`~.choose.articulate`, with the settings of ``stages``.

    Args:
        intake: the loaded input.
        loaded: key of all that it was loaded from.
        stages: with the settings, and what is remembered.

    Raises:
        InputRejected: as the articulator does, or did.
    """
    config = stages.config

    def tree() -> _Tree:
        made = articulate(intake, config.articulator, config.particulate, config.auto)
        if made.mesh is not intake.mesh:
            raise ValueError(f"articulator {made.articulator!r}: speaks of another mesh than the one it was given")
        return _Tree(made.parts, made.joints, made.articulator, made.notes, made.weights)

    kept = stages.recall("articulate", _Tree, articulate_key(loaded, config), tree)
    return Articulation(intake.mesh, kept.parts, kept.joints, kept.articulator, kept.notes, kept.weights)
