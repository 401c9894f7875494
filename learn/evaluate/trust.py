"""Fits the trust in each source of ``auto`` on objects of known truth, for ``configs/auto.toml``.

``python -m asset_factory.learn.evaluate.trust --help``
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from asset_factory.factory.articulate.auto.articulator import AutoArticulator, load_auto
from asset_factory.factory.articulate.auto.parts import shared
from asset_factory.factory.articulate.auto.sides import sightings
from asset_factory.factory.articulate.auto.trust import SIGNS, Trust, signs_of
from asset_factory.factory.articulate.proposal import Proposal
from asset_factory.factory.articulation import Articulation, Joint, JointKind
from asset_factory.factory.config import AutoConfig, BuildConfig, IntakeConfig, ParticulateConfig
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.geometry.components import connected_components
from asset_factory.factory.geometry.posing import closed, turned
from asset_factory.factory.geometry.triangles import face_areas
from asset_factory.factory.mesh import FloatArray
from asset_factory.factory.runtime.store import write_whole
from asset_factory.factory.runtime.terminal import say

from ..objects.catalog import CATEGORIES, make_object
from ..objects.mixture import in_character
from .physical import physical
from .transfer import on_mesh

#: A proposal is right if it is for a true moving part by this much of the area that both cover, of
#: its kind, with its axis to this cosine and its place to this share of the object's longest side.
SAME_PART = 0.5
SAME_AXIS = np.cos(np.radians(10.0))
SAME_PLACE = 0.05
PENALTY = 1.0
#: Thresholds whose score is lower than the best by no more than this are as good: the one that
#: moves less is taken.
NEARLY = 0.02
LEAST = np.round(np.arange(0.1, 0.75, 0.05), 2)
CHARACTERS = ("artist", "artist", "generated", "plain")


@dataclass(frozen=True)
class TrustTrial:
    """One object with everything that was proposed for it.

    Attributes:
        truth: what is.
        proposals: what was said.
        right: whether each is, shape [proposal_count].
    """

    truth: Articulation
    proposals: tuple[Proposal, ...]
    right: FloatArray


def procedural(seeds: Iterable[int]) -> Iterator[Articulation]:
    """Objects that training never sees, of every kind and character, turned about the vertical."""
    for seed in seeds:
        for number, category in enumerate(CATEGORIES):
            rng = np.random.default_rng((seed, number))
            character = CHARACTERS[(seed + number) % len(CHARACTERS)]
            made, _ = in_character(make_object(category, seed), character, seed)
            yield _turned_at_random(made, rng)


def described(folder: Path, names: Sequence[str]) -> Iterator[Articulation]:
    """The objects of folders with a URDF each, closed, turned about z; unusable ones left out."""
    from asset_factory.factory.articulate.stage import articulate
    from asset_factory.factory.intake.load import load

    for number, name in enumerate(names):
        for file in sorted((folder / name).glob("*.urdf")):
            try:
                made = closed(
                    articulate(load(file, IntakeConfig()), BuildConfig(articulator="annotated"))
                )
            except InputRejected:
                continue
            yield _turned_at_random(made, np.random.default_rng(number))


def _turned_at_random(made: Articulation, rng: np.random.Generator) -> Articulation:
    """By quarters half of the time, else by any angle."""
    quarters = float(rng.integers(4)) * np.pi / 2.0
    return turned(made, quarters if rng.random() < 0.5 else float(rng.uniform(0.0, 2.0 * np.pi)))


def tried(articulator: AutoArticulator, objects: Iterable[Articulation]) -> Iterator[TrustTrial]:
    """Yield what the articulator proposes for each object, and what of it is right."""
    for truth in objects:
        if not truth.movable_joints:
            continue
        areas = face_areas(truth.mesh)
        proposals = articulator.proposals(truth.mesh, areas)
        yield TrustTrial(
            truth,
            proposals,
            np.array([is_right(each, truth, areas) for each in proposals], dtype=np.float64),
        )


def sighted(objects: Iterable[Articulation]) -> Iterator[TrustTrial]:
    """Yield what the sides of each object show, which the articulator adds to its proposals."""
    for truth in objects:
        for seen in sightings(truth.mesh, connected_components(truth.mesh))[:1]:
            over = on_mesh(truth, seen.mesh)
            areas = face_areas(seen.mesh)
            right = [is_right(each, over, areas) for each in seen.found]
            yield TrustTrial(over, seen.found, np.array(right, dtype=np.float64))


def is_right(proposal: Proposal, truth: Articulation, areas: FloatArray) -> bool:
    """Return whether there is such a part that moves so, whichever way round and however far."""
    best = 0.0
    joint = None
    for candidate in truth.movable_joints:
        faces = np.zeros(len(areas), dtype=np.bool_)
        faces[truth.parts[candidate.child].faces] = True
        overlap = shared(proposal.faces, faces, areas)
        if overlap > best:
            best = overlap
            joint = candidate
    return (
        joint is not None
        and best > SAME_PART
        and _moves_alike(proposal, joint, float(truth.mesh.extents.max()))
    )


def _moves_alike(proposal: Proposal, joint: Joint, size: float) -> bool:
    motion = proposal.motion
    slides = joint.kind is JointKind.PRISMATIC
    if (motion.kind is JointKind.PRISMATIC) != slides or abs(
        float(motion.axis @ joint.axis)
    ) < SAME_AXIS:
        return False
    offset = motion.origin - joint.origin
    return (
        slides
        or float(np.linalg.norm(offset - (offset @ joint.axis) * joint.axis)) < SAME_PLACE * size
    )


def fitted(trials: Sequence[TrustTrial]) -> FloatArray:
    """Weights of the signs, by logistic regression with a quadratic penalty, shape [len(SIGNS)]."""
    from scipy.optimize import minimize

    signs = np.array([signs_of(each.signs) for trial in trials for each in trial.proposals])
    right = np.concatenate([trial.right for trial in trials])

    def loss(weights: FloatArray) -> tuple[float, FloatArray]:
        score = signs @ weights
        value = np.sum(np.logaddexp(0.0, score) - right * score) + 0.5 * PENALTY * weights @ weights
        return float(value), signs.T @ (1.0 / (1.0 + np.exp(-score)) - right) + PENALTY * weights

    return np.asarray(minimize(loss, np.zeros(len(SIGNS)), jac=True, method="L-BFGS-B").x)


def best_threshold(
    articulator: AutoArticulator, trials: Sequence[TrustTrial], weights: FloatArray
) -> float:
    """The highest of a few thresholds that comes nearly as close to the truth as the best."""
    scores = []
    for least in LEAST:
        trusting = replace(articulator, trust=Trust(weights, float(least)))
        values = [
            physical(t.truth, trusting.decide(t.truth.mesh, t.proposals)).values for t in trials
        ]
        scores.append(np.mean([v["part_miou"] + v["articulated_iou"] for v in values]))
    return float(LEAST[np.flatnonzero(np.array(scores) >= max(scores) - NEARLY)[-1]])


def text_of(trust: Trust) -> str:
    """Return the settings file."""
    rows = "\n".join(
        f"{name} = {weight:.4f}" for name, weight in zip(SIGNS, trust.weights, strict=True)
    )
    return (
        "# How auto weighs what speaks for a part that may move "
        "(a logistic model, see articulate/auto/trust.py), and\n"
        "# the probability below which the part stays fixed. Made by: "
        "python -m asset_factory.learn.evaluate.trust\n"
        f"least = {trust.least:g}\n\n[weights]\n{rows}\n"
    )


def main(arguments: list[str] | None = None) -> int:
    """Parse, fit, write."""
    parser = argparse.ArgumentParser(prog="trust", description="Fit how auto weighs proposals.")
    parser.add_argument(
        "--data", type=Path, action="append", default=[], help="folder of folders with a URDF each"
    )
    parser.add_argument(
        "--split",
        type=Path,
        action="append",
        default=[],
        help="names in each of those folders to use",
    )
    parser.add_argument("--seeds", type=int, default=2, help="procedural objects of each kind")
    parser.add_argument(
        "--least", type=float, help="the probability to ask for; by default one is looked for"
    )
    parser.add_argument(
        "--output", type=Path, required=True, help="file to write, as configs/auto.toml"
    )
    asked = parser.parse_args(arguments)
    articulator = load_auto(ParticulateConfig(), AutoConfig(), Trust(np.zeros(len(SIGNS)), 0.5))
    trials = list(tried(articulator, procedural(range(asked.seeds))))
    for folder, split in zip(asked.data, asked.split, strict=True):
        names = [
            line.strip()
            for line in split.read_text().splitlines()
            if line.strip() and not line.startswith("#")
        ]
        trials += tried(articulator, described(folder, names))
    # They share no sign with the others, so that each side is fitted as if alone.
    weights = fitted([*trials, *sighted(procedural(range(asked.seeds)))])
    least = best_threshold(articulator, trials, weights) if asked.least is None else asked.least
    trust = Trust(weights, least)
    write_whole(asked.output, text_of(trust).encode())
    right = np.concatenate([trial.right for trial in trials])
    say(
        f"{len(trials)} objects, {len(right)} proposals, {right.mean():.2f} of them right; "
        f"least {trust.least:g}"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
