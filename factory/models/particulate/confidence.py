"""Which points belong to which part, how sure that is, and parts too doubtful to keep."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ...mesh import FloatArray, IntArray


@dataclass(frozen=True)
class Assignment:
    """Points by part.

    Attributes:
        parts: of each point, shape [point_count].
        confidence: of each part, 0 to 1: the geometric mean over its points of the probability that
            they belong to it, among the parts that there are; 0 for parts without points, shape
            [part_count].
    """

    parts: IntArray
    confidence: FloatArray

    @property
    def present(self) -> IntArray:
        """Return the parts with at least one point, ascending."""
        return np.unique(self.parts)


def assigned(mask_logits: npt.ArrayLike, least_confidence: float = 0.0) -> Assignment:
    """Give every point to its likeliest part; unsure parts dissolve, least confident first.

    A dissolved part's points go to their next likeliest parts and all confidences are computed anew
    before the next one is judged. The last part always stays.

    Args:
        mask_logits: finite, shape [point_count, part_count], at least one of each.
        least_confidence: 0 keeps all.
    """
    logits = np.array(mask_logits, dtype=np.float64)
    parts = logits.argmax(axis=1)
    while True:
        present = np.unique(parts)
        confidence = _confidence(logits, parts, present)
        doubtful = present[confidence[present].argmin()]
        if len(present) == 1 or confidence[doubtful] >= least_confidence:
            return Assignment(parts.astype(np.int64), confidence)
        left = present[present != doubtful]
        homeless = parts == doubtful
        parts[homeless] = left[logits[np.ix_(homeless, left)].argmax(axis=1)]


def _confidence(logits: FloatArray, parts: IntArray, present: IntArray) -> FloatArray:
    among = logits[:, present]
    highest = among.max(axis=1)
    own = logits[np.arange(len(parts)), parts]
    logarithm = own - highest - np.log(np.exp(among - highest[:, None]).sum(axis=1))
    count = np.bincount(parts, minlength=logits.shape[1])
    total = np.bincount(parts, weights=logarithm, minlength=logits.shape[1])
    return np.asarray(np.where(count > 0, np.exp(total / np.maximum(count, 1)), 0.0))
