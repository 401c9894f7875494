"""Labels as a network gives them, a lost handle or a drawer without its box, and rough guesses."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.articulate.evidence import Guess, Partition
from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.geometry.triangles import areas_of
from asset_factory.factory.mesh import BoolArray, FloatArray, IntArray

#: Share of the parts that are spoilt.
SPOILT = 0.5
#: Components are lost with this probability, come along up to this share of the part's area.
LOST = 0.3
COMPANION = 0.4
#: Radius of a bite as a share of the part's diagonal.
BITE = 0.2
#: How wrong made-up guesses are: of the axis [rad], of its place as a share of the longest side.
ANGLE_SPREAD = np.radians(15.0)
PLACE_SPREAD = 0.1
#: How often their sense is wrong, and their probability of the true kind (mean and spread).
WRONG_WAY = 0.3
KIND = (0.8, 0.25)


def spoilt(partition: Partition, rng: np.random.Generator) -> Partition:
    """Give about half of an object's parts wrong labels; every part keeps some faces."""
    labels = np.array(partition.face_part)
    for part in range(1, len(partition.parents)):
        if rng.random() < SPOILT and (labels == part).any():
            parent = partition.parents[part]
            choose, gains = _WAYS[int(rng.integers(len(_WAYS)))]
            giver, taker = (parent, part) if gains else (part, parent)
            moved = choose(partition, labels, part, rng) & (labels == giver)
            tried = np.where(moved, taker, labels)
            if len(np.unique(tried)) == len(np.unique(labels)):
                labels = tried
    return Partition(partition.mesh, labels, partition.parents)


def made_up_guess(joint: Joint, middle: FloatArray, size: float, rng: np.random.Generator) -> Guess:
    """Return what somebody might believe who has a rough idea of the truth.

    ``middle`` is the part's [m], shape [3], ``size`` the object's longest side [m].
    """
    aside = rng.normal(size=3)
    aside -= float(aside @ joint.axis) * joint.axis
    aside /= np.linalg.norm(aside)
    angle = abs(rng.normal(0.0, ANGLE_SPREAD))
    direction = np.cos(angle) * joint.axis + np.sin(angle) * aside
    if rng.random() < WRONG_WAY:
        direction = -direction
    nearest = joint.origin + joint.axis * float(joint.axis @ (middle - joint.origin))
    right = float(np.clip(rng.normal(*KIND), 0.03, 0.97))
    return Guess(
        turns=1.0 - right if joint.kind is JointKind.PRISMATIC else right,
        direction=direction,
        point=nearest + rng.normal(0.0, PLACE_SPREAD * size, 3),
    )


def _pieces(partition: Partition, rows: IntArray) -> tuple[IntArray, FloatArray]:
    """Return the components among some faces and their areas [m2], largest first."""
    ids, index = np.unique(partition.components[rows], return_inverse=True)
    areas = np.bincount(index, weights=areas_of(partition.triangles)[rows]).astype(np.float64)
    order = np.argsort(-areas, kind="stable")
    return ids[order], areas[order]


def _small_pieces(
    partition: Partition, labels: IntArray, part: int, rng: np.random.Generator
) -> BoolArray:
    """Return some of the part's components, never the largest."""
    ids, _ = _pieces(partition, np.flatnonzero(labels == part))
    return np.isin(partition.components, ids[1:][rng.random(len(ids) - 1) < LOST])


def _all_but_largest(
    partition: Partition, labels: IntArray, part: int, _rng: np.random.Generator
) -> BoolArray:
    ids, _ = _pieces(partition, np.flatnonzero(labels == part))
    return np.asarray(partition.components != ids[0])


def _nearest_piece(
    partition: Partition, labels: IntArray, part: int, _rng: np.random.Generator
) -> BoolArray:
    """Return the nearest small component of the parent, if there is one."""
    mine = labels == part
    theirs = labels == partition.parents[part]
    ids, areas = _pieces(partition, np.flatnonzero(theirs))
    small = ids[areas < COMPANION * float(areas_of(partition.triangles)[mine].sum())]
    centres = partition.triangles.mean(axis=1)
    candidates = theirs & np.isin(partition.components, small)
    if not candidates.any():
        return np.asarray(candidates)
    low = centres[mine].min(axis=0)
    high = centres[mine].max(axis=0)
    away = np.linalg.norm(np.maximum(np.maximum(low - centres, centres - high), 0.0), axis=1)
    nearest = partition.components[np.flatnonzero(candidates)[int(np.argmin(away[candidates]))]]
    return np.asarray(candidates & (partition.components == nearest))


def _bite(partition: Partition, labels: IntArray, part: int, rng: np.random.Generator) -> BoolArray:
    """Return the faces near a random face of the part."""
    centres = partition.triangles.mean(axis=1)
    mine = centres[labels == part]
    radius = BITE * float(np.linalg.norm(np.ptp(mine, axis=0)))
    at = mine[int(rng.integers(len(mine)))]
    return np.asarray(np.linalg.norm(centres - at, axis=1) < radius)


#: Which faces change hands, and whether the part gains them from its parent or loses them to it.
_WAYS = (
    (_small_pieces, False), (_all_but_largest, False), (_nearest_piece, True), (_bite, False),
    (_bite, True),
)  # fmt: skip
