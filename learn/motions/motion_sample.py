"""One part's sample: evidence and worth of every candidate."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from asset_factory.factory.articulate.evidence.body import Partition, body_of
from asset_factory.factory.articulate.evidence.candidates import (
    Candidates,
    LineSource,
    find_candidates,
)
from asset_factory.factory.articulate.evidence.numbers import GUESS, measure
from asset_factory.factory.articulation import Articulation, Joint, JointKind
from asset_factory.factory.geometry.posing import closed, turned
from asset_factory.factory.mesh import BoolArray, FloatArray

from ..bodies import bodies_of
from .spoiling import made_up_guess, spoilt

#: Parts of one object that teach; the rest say the same again.
MOST_PARTS = 5
#: What turns so far has no way that is the wrong one [rad].
ROUND = 6.0
#: Errors of axis [deg] and of place that count for none, and that divide a worth by e.
ANGLE_FREE = 0.5
ANGLE_WORTH = 4.0
PLACE_FREE = 0.004
PLACE_WORTH = 0.025
#: Right is an axis to this angle [deg], and to this share of the object's longest side.
RIGHT_ANGLE = 5.0
RIGHT_PLACE = 0.05


@dataclass(frozen=True)
class MotionSample:
    """Of one part.

    Attributes:
        name: of the object.
        numbers: evidence of every candidate, a guess included, shape [n, len(NAMES)].
        guessed: candidates there would not be without the guess, shape [n].
        worth: how good each candidate is, 0 to 1, shape [n].
        right: whether each is right but for the sense, shape [n].
        alike: for each candidate, which others are the same motion but for the sense, shape [n, n].
    """

    name: str
    numbers: FloatArray
    guessed: BoolArray
    worth: FloatArray
    right: BoolArray
    alike: BoolArray

    def unguided(self) -> MotionSample:
        """Return the same part if nobody had guessed."""
        keep = ~self.guessed
        numbers = self.numbers[keep].copy()
        numbers[:, -len(GUESS) :] = 0.0
        kept = {name: getattr(self, name)[keep] for name in ("guessed", "worth", "right")}
        return replace(self, numbers=numbers, alike=self.alike[np.ix_(keep, keep)], **kept)


def motion_samples(
    name: str, articulation: Articulation, rng: np.random.Generator
) -> Iterator[MotionSample]:
    """Yield an object's samples, closed, turned at random, some of its labels spoilt."""
    whole, joints = known_motions(articulation, float(rng.uniform(0.0, 2.0 * np.pi)))
    size = float(whole.mesh.extents.max())
    partition = spoilt(whole, rng)
    parts = rng.permutation(sorted(joints))[:MOST_PARTS]
    for part in sorted(int(p) for p in parts):
        body = body_of(partition, part)
        joint = joints[part]
        if body is None:
            continue
        middle = (body.corners.min(axis=0) + body.corners.max(axis=0)) / 2.0
        guess = made_up_guess(joint, middle, size, rng)
        candidates = find_candidates(body, guess)
        numbers = measure(body, candidates, guess)
        worth, right = _judged(candidates, joint, middle, size)
        yield MotionSample(
            name=name,
            numbers=numbers.astype(np.float32),
            guessed=candidates.source == LineSource.GUESSED,
            worth=worth,
            right=right,
            alike=_alike(candidates, size),
        )


def known_motions(articulation: Articulation, yaw: float) -> tuple[Partition, dict[int, Joint]]:
    """Return the parts that have faces, and the joints of those with just one, by part.

    The object is closed, and turned about the vertical by ``yaw`` [rad].
    """
    bodies = bodies_of(turned(closed(articulation), yaw))
    mesh = bodies.articulation.mesh
    single = {body: own[0] for body, own in enumerate(bodies.joints) if len(own) == 1}
    return Partition(mesh, bodies.labels, np.array(bodies.parents)), single


def _judged(
    candidates: Candidates, joint: Joint, middle: FloatArray, size: float
) -> tuple[FloatArray, BoolArray]:
    """Return what each candidate is worth, and whether it is right but for the sense."""
    cosine = candidates.axis @ joint.axis
    angle = np.degrees(np.arccos(np.clip(np.abs(cosine), 0.0, 1.0)))
    slides = joint.kind is JointKind.PRISMATIC
    nearest = joint.origin + joint.axis * float(joint.axis @ (middle - joint.origin))
    aside = np.linalg.norm(np.cross(nearest - candidates.origin, candidates.axis), axis=1)
    place = np.where(candidates.slides | slides, 0.0, aside / size)
    same_kind = candidates.slides == slides
    either_way = joint.kind is JointKind.CONTINUOUS or (joint.turns and joint.range > ROUND)
    worth = same_kind * ((cosine > 0.0) | either_way)
    worth = worth * np.exp(-np.maximum(angle - ANGLE_FREE, 0.0) / ANGLE_WORTH)
    worth = worth * np.exp(-np.maximum(place - PLACE_FREE, 0.0) / PLACE_WORTH)
    return worth, same_kind & (angle < RIGHT_ANGLE) & (place < RIGHT_PLACE)


def _alike(candidates: Candidates, size: float) -> BoolArray:
    aligned = np.abs(candidates.axis @ candidates.axis.T) > np.cos(np.radians(RIGHT_ANGLE))
    alike = aligned & (candidates.slides[:, None] == candidates.slides[None])
    offset = candidates.origin[None] - candidates.origin[:, None]
    apart = np.linalg.norm(np.cross(offset, candidates.axis[None]), axis=2)
    return np.asarray(alike & (candidates.slides[:, None] | (apart < RIGHT_PLACE * size)))
