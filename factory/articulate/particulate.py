"""The articulator that asks the Part Articulation Transformer."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ..articulation import Articulation, Weights
from ..config import BuildConfig, ParticulateConfig
from ..geometry.posing import UP
from ..intake.annotation import AnnotatedJoint, Annotation
from ..intake.intake import Intake
from ..mesh import FloatArray, Mesh
from ..models.particulate.agreement import Consensus
from ..models.particulate.decoding import Decoded, DecodedPart
from ..models.particulate.inference import Network, infer
from ..models.particulate.loading import load_network, weight_files
from ..models.particulate.motion import PredictedMotion
from ..models.particulate.prediction import MotionClass
from ..models.service import identity_of, network_for
from ..models.weights.checkpoint import describe
from ..models.weights.sources import fetch
from ..part import Proposer
from ..runtime.store import digest_file
from .annotated import AnnotatedArticulator
from .locate import sourced
from .settings import require_torch, require_usable

#: Probabilities and agreements below this are told [-].
DOUBTFUL = 0.6
#: Axes whose votes scatter by more than this share of the object's longest side are told.
SCATTERED = 0.03


@dataclass(frozen=True)
class ParticulateArticulator:
    """Parts and joints as a trained network sees them, in the mesh's own metric frame.

    Attributes:
        network: answers for one cloud of points.
        weights: of that network and what it rests on, for the manifest.
        config: how the mesh is shown and the answer read.
    """

    name = "particulate"

    network: Network
    weights: tuple[Weights, ...]
    config: ParticulateConfig

    def articulate(self, mesh: Mesh) -> Articulation:
        """Return the predicted tree over ``mesh`` [m], z up, with a confidence per part and joint.

        Raises:
            InputRejected: ``empty``, ``zero_size``: no surface to see; ``prediction_not_finite``:
                broken weights.
        """
        found = infer(mesh.vertices, mesh.faces, self.network, self.config)
        annotated = AnnotatedArticulator(
            _annotation(found.chosen), found.chosen.box.outwards, np.arange(len(mesh.faces))
        )
        return self._with_confidence(annotated.articulate(mesh), found)

    def _with_confidence(self, plain: Articulation, found: Consensus) -> Articulation:
        sure = {
            _part_name(found.chosen, i): _part_confidence(found, i)
            for i in range(len(found.chosen.parts))
        }
        moved = {
            name: _joint_confidence(found, child)
            for _, child in found.chosen.edges
            for name in (f"joint_{child}", f"joint_{child}_turn", f"joint_{child}_slide")
        }

        rated = replace(
            plain,
            parts=tuple(replace(each, confidence=sure.get(each.name)) for each in plain.parts),
            joints=tuple(replace(each, confidence=moved.get(each.name)) for each in plain.joints),
            articulator=self.name,
            notes=(*_notes(found), *plain.notes),
            weights=self.weights,
        )
        return sourced(rated, Proposer.NETWORK)


def _annotation(reading: Decoded) -> Annotation:
    return Annotation(
        face_part=reading.face_part,
        part_names=tuple(_part_name(reading, index) for index in range(len(reading.parts))),
        joints=tuple(
            _joint(reading.parts[child].motion, parent, child) for parent, child in reading.edges
        ),
        source="particulate",
    )


def _part_name(reading: Decoded, index: int) -> str:
    return "base" if index == reading.root else f"part_{index}"


def _joint(motion: PredictedMotion, parent: int, child: int) -> AnnotatedJoint:
    """Return one joint in the network's frame."""
    slides_only = motion.kind is MotionClass.PRISMATIC
    axis = motion.axis
    slide = motion.slide_direction
    direction: FloatArray = UP
    if axis is not None:
        direction = axis.direction
    elif slide is not None:
        direction = slide
    lower, upper = motion.slide if slides_only else motion.turn
    both = motion.kind is MotionClass.BOTH
    return AnnotatedJoint(
        name=f"joint_{child}",
        kind=motion.kind.name.lower(),
        parent=parent,
        child=child,
        axis=direction,
        origin=axis.point if axis is not None else np.zeros(3),
        lower=lower,
        upper=upper,
        slide_axis=slide if both else None,
        slide_lower=motion.slide[0] if both else None,
        slide_upper=motion.slide[1] if both else None,
    )


def _part_confidence(found: Consensus, part: int) -> float:
    own = found.chosen.parts[part].confidence
    return own if found.part_agreement is None else min(own, found.part_agreement[part])


def _joint_confidence(found: Consensus, part: int) -> float:
    """Return the weakest link: that its part exists, hangs where it does, and moves as it does."""
    decoded = found.chosen.parts[part]
    hangs = 1.0 if decoded.parent_probability is None else decoded.parent_probability
    return min(_part_confidence(found, part), hangs, decoded.motion.margin)


def _notes(found: Consensus) -> tuple[str, ...]:
    reading = found.chosen
    notes = [] if reading.edges else ["the network sees a single part"]
    notes += [*reading.notes, *_sample_notes(found)]
    for index, part in enumerate(reading.parts):
        name = _part_name(reading, index)
        if index == reading.root:
            if part.motion.kind is not MotionClass.FIXED:
                notes.append(
                    f"{name!r} was predicted to move ({part.motion.kind.name.lower()}); "
                    "the root stays still"
                )
            continue
        notes += [f"{name!r} {note}" for note in part.motion.notes]
        notes += [f"{name!r} is doubtful: {doubt}" for doubt in _doubts(part)]
    return tuple(notes)


def _doubts(part: DecodedPart) -> list[str]:
    doubts = []
    if part.confidence < DOUBTFUL:
        doubts.append(f"its points belong to it with probability {part.confidence:.2f}")
    if part.motion.margin < 1.0 - DOUBTFUL:
        doubts.append(f"another kind of motion is only {part.motion.margin:.2f} less probable")
    if part.parent_probability is not None and part.parent_probability < DOUBTFUL:
        doubts.append(f"its parent has probability {part.parent_probability:.2f}")
    axis = part.motion.axis
    if axis is not None and axis.spread is not None and axis.spread > SCATTERED:
        doubts.append(f"votes for its axis scatter by {axis.spread:.3f} of the longest side")
    return doubts


def _sample_notes(found: Consensus) -> list[str]:
    if found.part_agreement is None:
        return []
    least = min(found.part_agreement)
    weakest = _part_name(found.chosen, found.part_agreement.index(least))
    said = f"the least agreed part is {weakest!r}, shared by {least:.2f}"
    return [f"{found.samples} samples were read; {said}"]


def articulator_for(intake: Intake, config: BuildConfig) -> ParticulateArticulator:
    """Return the same one for every input. Raises ConfigError, see :func:`load_articulator`."""
    return load_articulator(config.particulate)


def load_articulator(config: ParticulateConfig) -> ParticulateArticulator:
    """Return the articulator with the weights that a configuration names.

    The network of the job is asked where there is one (:mod:`..particulate.service`), else it is
    loaded here.

    Raises:
        ConfigError: no torch, or no checkpoint is named, or there is none of this network there.
    """
    require_torch()
    require_usable(config, needed=True)
    weights = tuple(_weights(file) for file in weight_files(config))
    identity = identity_of(config, tuple(each.digest for each in weights))
    return ParticulateArticulator(
        network_for(identity, partial(load_network, config)), weights, config
    )


def _weights(checkpoint: str) -> Weights:
    file = fetch(checkpoint)
    told = describe(file)
    return Weights(file.name, digest_file(file), told.terms, told.outputs or None)
