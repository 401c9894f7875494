"""Labels as a network gives them: a lost handle, a drawer without its box, some neighbour."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.articulate.evidence import Partition
from asset_factory.factory.mesh import FloatArray, IntArray

#: Share of the parts that are spoilt.
SPOILT = 0.5
#: Components are lost with this probability, come along up to this share of the part's area.
LOST = 0.3
COMPANION = 0.4
#: Radius of a bite as a share of the part's diagonal.
BITE = 0.2


def spoilt(partition: Partition, rng: np.random.Generator) -> Partition:
    """Give about half of an object's parts wrong labels; every part keeps some faces."""
    labels = np.array(partition.face_part)
    ways = (_lose_pieces, _keep_largest, _gain_piece, _lose_bite, _gain_bite)
    for part in range(1, len(partition.parents)):
        if rng.random() < SPOILT and (labels == part).any():
            tried = ways[int(rng.integers(len(ways)))](partition, labels, part, rng)
            if len(np.unique(tried)) == len(np.unique(labels)):
                labels = tried
    return Partition(partition.mesh, labels, partition.parents)


def _areas(partition: Partition) -> FloatArray:
    sides = partition.triangles[:, 1:] - partition.triangles[:, :1]
    return np.asarray(np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) / 2.0)


def _pieces(partition: Partition, rows: IntArray) -> tuple[IntArray, FloatArray]:
    """Return the components among some faces and their areas [m2], largest first."""
    ids, index = np.unique(partition.components[rows], return_inverse=True)
    areas = np.bincount(index, weights=_areas(partition)[rows]).astype(np.float64)
    order = np.argsort(-areas, kind="stable")
    return ids[order], areas[order]


def _lose_pieces(
    partition: Partition, labels: IntArray, part: int, rng: np.random.Generator
) -> IntArray:
    ids, _ = _pieces(partition, np.flatnonzero(labels == part))
    lost = ids[1:][rng.random(len(ids) - 1) < LOST]
    gone = (labels == part) & np.isin(partition.components, lost)
    return np.where(gone, partition.parents[part], labels)


def _keep_largest(
    partition: Partition, labels: IntArray, part: int, _rng: np.random.Generator
) -> IntArray:
    ids, _ = _pieces(partition, np.flatnonzero(labels == part))
    gone = (labels == part) & (partition.components != ids[0])
    return np.where(gone, partition.parents[part], labels)


def _gain_piece(
    partition: Partition, labels: IntArray, part: int, _rng: np.random.Generator
) -> IntArray:
    """Return the nearest small component of what the part hangs on comes along."""
    mine = labels == part
    theirs = labels == partition.parents[part]
    if not theirs.any():
        return labels
    ids, areas = _pieces(partition, np.flatnonzero(theirs))
    small = ids[areas < COMPANION * float(_areas(partition)[mine].sum())]
    centres = partition.triangles.mean(axis=1)
    candidates = theirs & np.isin(partition.components, small)
    if not candidates.any():
        return labels
    low = centres[mine].min(axis=0)
    high = centres[mine].max(axis=0)
    away = np.linalg.norm(np.maximum(np.maximum(low - centres, centres - high), 0.0), axis=1)
    nearest = partition.components[np.flatnonzero(candidates)[int(np.argmin(away[candidates]))]]
    return np.where(candidates & (partition.components == nearest), part, labels)


def _lose_bite(
    partition: Partition, labels: IntArray, part: int, rng: np.random.Generator
) -> IntArray:
    bitten = (labels == part) & _bite(partition, labels, part, rng)
    return np.where(bitten, partition.parents[part], labels)


def _gain_bite(
    partition: Partition, labels: IntArray, part: int, rng: np.random.Generator
) -> IntArray:
    bitten = (labels == partition.parents[part]) & _bite(partition, labels, part, rng)
    return np.where(bitten, part, labels)


def _bite(
    partition: Partition, labels: IntArray, part: int, rng: np.random.Generator
) -> np.ndarray:
    """Return the faces near a random face of the part."""
    centres = partition.triangles.mean(axis=1)
    mine = centres[labels == part]
    radius = BITE * float(np.linalg.norm(np.ptp(mine, axis=0)))
    at = mine[int(rng.integers(len(mine)))]
    return np.asarray(np.linalg.norm(centres - at, axis=1) < radius)
