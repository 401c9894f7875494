"""Inputs that lie down as they are read: files that break glTF's rule that y is up, and others."""

from __future__ import annotations

from dataclasses import replace

from ..articulation import Articulation
from ..errors import InputRejected
from ..intake.intake import Intake
from ..intake.source import Source
from ..part import Proposer
from ..runtime.stages import Stages
from .stage import hypotheses

#: The axis that files have up instead, by the one assumed and who assumed it.
OTHER_UP = {("y", "format"): "z", ("z", "default"): "y"}
#: So many panels of its sides, the surest of them this sure, are no chance: a toilet turned over
#: shows one drawer.
FEWEST = 2
SURE = 0.6


def standing_hypotheses(
    intake: Intake, origin: Source, stages: Stages
) -> tuple[Intake, tuple[Articulation, ...]]:
    """Return an input and its hypotheses; stood up, if it opens only so.

    Where nothing moves and nobody gave an up axis for this very input, it is read with the one
    that other files have up. If that shows several doors or drawers, it lay.

    Args:
        intake: as loaded.
        origin: that it was loaded from.
        stages: with the settings and the cache.

    Raises:
        InputRejected: as :func:`~.stage.hypotheses` does of the input as it was loaded.
    """
    try:
        return intake, hypotheses(intake, origin.loaded_key, stages)
    except InputRejected as rejection:
        other = OTHER_UP.get((intake.provenance.up, intake.provenance.up_source))
        if rejection.code != "no_movable_joint" or other is None:
            raise
        stood = _stood_up(intake, origin.with_up(other), stages)
        if stood is None:
            raise
        return stood


def _stood_up(
    lying: Intake, origin: Source, stages: Stages
) -> tuple[Intake, tuple[Articulation, ...]] | None:
    """Load an input with another axis up, if its sides then show enough that opens."""
    try:
        with stages.clock.stage("load"):
            intake = origin.load()
        found = hypotheses(intake, origin.loaded_key, stages)
    except InputRejected:
        return None
    panels = _panels(found[0])
    if len(panels) < FEWEST or max(panels) < SURE:
        return None
    was = lying.provenance.up
    now = intake.provenance.up
    note = (
        f"With its {was} axis up nothing on it opens; with {now} up its sides show {len(panels)} "
        "doors or drawers: taken so. Set up to say otherwise."
    )
    provenance = replace(
        intake.provenance, up_source="sides", notes=(*intake.provenance.notes, note)
    )
    return replace(intake, provenance=provenance), found


def _panels(articulation: Articulation) -> list[float]:
    """Return how sure each door or drawer is that more than a network sees."""
    return [
        joint.confidence or 0.0
        for joint in articulation.movable_joints
        if (part := articulation.parts[joint.child]).kind.closes_side
        and part.source is not None
        and not part.is_by(Proposer.NETWORK)
    ]
