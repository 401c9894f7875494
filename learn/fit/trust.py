"""Fits the trust in each source of ``auto`` on objects of known truth."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from asset_factory.factory.articulate.auto.articulator import AutoArticulator
from asset_factory.factory.articulate.auto.parts import shared
from asset_factory.factory.articulate.auto.trust import NAME, SIGNS, Trust, signs_of
from asset_factory.factory.articulate.proposal import Proposal
from asset_factory.factory.articulation import Articulation, Joint, JointKind
from asset_factory.factory.geometry.posing import closed, turned
from asset_factory.factory.geometry.triangles import face_areas
from asset_factory.factory.mesh import FloatArray
from asset_factory.factory.models.perceptron import Perceptron
from asset_factory.factory.models.shipped import Arrays

from ..evaluate.physical import physical
from .perceptron import FitSettings, Weighing, cross_entropy, fit_perceptron
from .writing import networks_stored

#: A proposal is right if it is for a true moving part by this much of the area that both cover, of
#: its kind, with its axis to this cosine and its place to this share of the object's longest side.
SAME_PART = 0.5
SAME_AXIS = np.cos(np.radians(10.0))
SAME_PLACE = 0.05
PENALTY = 1.0
STEPS = 1000
#: Thresholds that score less than the best by no more than this are as good: the highest is taken.
NEARLY = 0.02
LEAST = np.round(np.arange(0.1, 0.75, 0.05), 2)
#: Surfaces of generated objects, each as frequent.
CHARACTERS = ("artist", "artist", "generated", "plain")


@dataclass(frozen=True)
class TrustTrial:
    """One object with all proposals for it, and whether each is right, shape [proposal_count]."""

    truth: Articulation
    proposals: tuple[Proposal, ...]
    right: FloatArray


def turned_at_random(objects: Iterable[tuple[str, Articulation]]) -> Iterator[Articulation]:
    """Yield objects closed and turned about z: half of them by quarters, others by any angle."""
    for number, (_, made) in enumerate(objects):
        rng = np.random.default_rng(number)
        quarters = float(rng.integers(4)) * np.pi / 2.0
        anywhere = float(rng.uniform(0.0, 2.0 * np.pi))
        yield turned(closed(made), quarters if rng.random() < 0.5 else anywhere)


def tried(articulator: AutoArticulator, objects: Iterable[Articulation]) -> Iterator[TrustTrial]:
    """Yield what the articulator proposes for each object, and what of it is right."""
    for truth in objects:
        if not truth.movable_joints:
            continue
        areas = face_areas(truth.mesh)
        proposals = articulator.proposals(truth.mesh)
        right = np.array([is_right(each, truth, areas) for each in proposals], dtype=np.float64)
        yield TrustTrial(truth, proposals, right)


def is_right(proposal: Proposal, truth: Articulation, areas: FloatArray) -> bool:
    """Return whether there is such a part that moves so, whichever way round and however far."""

    def overlap(joint: Joint) -> float:
        faces = np.zeros(len(areas), dtype=np.bool_)
        faces[truth.parts[joint.child].faces] = True
        return shared(proposal.faces, faces, areas)

    joint = max(truth.movable_joints, key=overlap)
    size = float(truth.mesh.extents.max())
    return overlap(joint) > SAME_PART and _moves_alike(proposal, joint, size)


def _moves_alike(proposal: Proposal, joint: Joint, size: float) -> bool:
    motion = proposal.motion
    slides = joint.kind is JointKind.PRISMATIC
    alike = (motion.kind is JointKind.PRISMATIC) == slides
    parallel = abs(float(motion.axis @ joint.axis)) >= SAME_AXIS
    offset = motion.origin - joint.origin
    aside = float(np.linalg.norm(offset - (offset @ joint.axis) * joint.axis))
    return alike and parallel and (slides or aside < SAME_PLACE * size)


def fit_signs(trials: Sequence[TrustTrial]) -> Perceptron:
    """Return the logistic model of the signs, fitted with a quadratic penalty."""
    signs = np.array([signs_of(each.signs) for trial in trials for each in trial.proposals])
    right = np.concatenate([trial.right for trial in trials])
    decay = {"direct": Weighing(0.0, PENALTY / len(right))}
    settings = FitSettings(0, decay, STEPS)
    return fit_perceptron(signs, cross_entropy(right[:, None]), settings)


def best_threshold(
    articulator: AutoArticulator, trials: Sequence[TrustTrial], network: Perceptron
) -> float:
    """Return the highest threshold that comes nearly as close to the truth as the best one."""
    scores = []
    for least in LEAST:
        trusting = replace(articulator, trust=Trust(network, float(least)))
        near = []
        for trial in trials:
            answer = trusting.decide(trial.truth.mesh, trial.proposals)
            values = physical(trial.truth, answer).values
            near.append(values["part_miou"] + values["articulated_iou"])
        scores.append(np.mean(near))
    return float(LEAST[np.flatnonzero(np.array(scores) >= max(scores) - NEARLY)[-1]])


def fit_trust(articulator: AutoArticulator, trials: Sequence[TrustTrial]) -> Arrays:
    """Fit the trust in every source of proposals, and the probability to ask for."""
    network = fit_signs(trials)
    least = np.array([best_threshold(articulator, trials, network)])
    return networks_stored({NAME: network}, {NAME: SIGNS}, {"least": least})
