"""Pieces of a surface: what connected components are to modelled meshes, on one-piece meshes too.

A component that is most of the object says nothing of its parts: it is cut along creases, where
the smoothed normals of two neighbours turn, and where the colour jumps. A piece too small to be a
part goes on to the neighbour that it is parted from least.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix

from ..mesh import FloatArray, IntArray
from .edges import label_linked

#: A component with more of the area is cut.
WHOLE_SHARE = 0.9
#: Neighbours whose smoothed normals turn by more lie in different pieces [deg]. Of 33 real objects
#: made skins at 160 to 288 cells, pieces at 4 degrees lie each in one part to a mean IoU of 0.81
#: (median 0.93); 7 degrees: 0.77; 3 degrees: 0.82 with half as many pieces again.
CREASE_DEG = 4.0
#: So do neighbours whose colours differ by more, in any channel in [0, 1].
COLOR_STEP = 0.2
#: How often a face takes the mean normal of itself and its neighbours; once more loses 0.03.
ROUNDS = 2
#: A face with more of the area counts for more than one of its neighbours: large flat faces do not
#: bend.
FINE_SHARE = 1.0 / 100_000
#: A piece with less of the area goes to a neighbour.
SMALL_SHARE = 0.001
#: By shared length, which counts for less the sharper the crease [deg]: without that the mean IoU
#: is 0.73.
SOFT_DEG = 3.0
#: Rounds of merging at most; each about halves what is small.
_MERGES = 40


@dataclass(frozen=True)
class Sheet:
    """A surface as its pieces are seen.

    Attributes:
        areas: of the faces, shape [face_count].
        normals: unit, zero for faces without area, shape [face_count, 3].
        neighbours: pairs of faces that border on one another, shape [pair_count, 2].
        borders: length that each pair shares, shape [pair_count].
        colors: of the faces, in [0, 1], shape [face_count, 3]; ``None`` where nothing is known.
    """

    areas: FloatArray
    normals: FloatArray
    neighbours: IntArray
    borders: FloatArray
    colors: FloatArray | None = None


def pieces(sheet: Sheet) -> IntArray:
    """Return the number of each face's piece, shape [face_count].

    Components are pieces; but one of most of the area is cut, and with it all that is as large.
    """
    count = len(sheet.areas)
    components = label_linked(count, sheet.neighbours)
    area = np.bincount(components, weights=sheet.areas)
    whole = area > WHOLE_SHARE * float(area.sum())
    if not whole.any():
        return components
    turn = _turns(sheet)
    parted = turn > CREASE_DEG
    if sheet.colors is not None:
        steps = sheet.colors[sheet.neighbours]
        parted |= np.abs(steps[:, 0] - steps[:, 1]).max(axis=1) > COLOR_STEP
    parted &= whole[components[sheet.neighbours[:, 0]]]
    joined = sheet.neighbours[~parted]
    return _merged(sheet, label_linked(count, joined), sheet.borders * np.exp(-turn / SOFT_DEG))


def _turns(sheet: Sheet) -> FloatArray:
    """Return the angle between neighbours' smoothed normals [deg], shape [pair_count]."""
    one, other = sheet.neighbours.T
    count = len(sheet.areas)
    ends = (np.concatenate([one, other]), np.concatenate([other, one]))
    around = csr_matrix((np.ones(len(ends[0])), ends), shape=(count, count))
    own = np.maximum(sheet.areas / (FINE_SHARE * float(sheet.areas.sum())), 1.0)[:, None]
    normals = sheet.normals
    for _ in range(ROUNDS):
        normals = own * normals + around @ normals
        length = np.linalg.norm(normals, axis=1, keepdims=True)
        normals = normals / np.maximum(length, np.finfo(np.float64).tiny)
    cosines = np.einsum("ij,ij->i", normals[one], normals[other])
    return np.asarray(np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0))))


def _merged(sheet: Sheet, piece: IntArray, ties: FloatArray) -> IntArray:
    """Return the pieces of which none is small, but for those that border on nothing.

    Args:
        sheet: the surface.
        piece: of each face, shape [face_count].
        ties: how much each pair of neighbours holds together, shape [pair_count].
    """
    small = SMALL_SHARE * float(sheet.areas.sum())
    for _ in range(_MERGES):
        count = int(piece.max(initial=-1)) + 1
        area = np.bincount(piece, weights=sheet.areas, minlength=count)
        one, other = piece[sheet.neighbours].T
        leaving = (area < small)[one] & (one != other)
        coming = (area < small)[other] & (one != other)
        ends = (
            np.concatenate([one[leaving], other[coming]]),
            np.concatenate([other[leaving], one[coming]]),
        )
        weights = np.concatenate([ties[leaving], ties[coming]])
        table = coo_matrix((weights, ends), shape=(count, count)).tocsr()
        table.sum_duplicates()
        rows = np.flatnonzero(np.diff(table.indptr))
        if not len(rows):
            break
        target = np.asarray(table[rows].argmax(axis=1)).ravel()
        piece = label_linked(count, np.stack([rows, target], axis=1))[piece]
    return piece
