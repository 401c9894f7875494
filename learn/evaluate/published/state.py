"""Two clouds in one state of their joints, compared part by part; and the paper's metrics."""

from __future__ import annotations

from ..score import Score
from .boxes import box_of, giou, iou
from .cloud import ScoredCloud
from .matched import Matching, chamfer, half_diagonal, matched

#: What a part without partner is given, by metric; Chamfer distances take half the diagonal.
PENALTIES = {"giou": -1.0, "miou": 0.0}


def compared(matching: Matching, share: float | None = None) -> dict[str, float]:
    """Return the agreement of boxes and points of parts matched at rest.

    Joints are at this share from lower to upper; ``None``: at rest.

    Returns:
        ``giou``, ``miou`` (of boxes along the axes), ``pc`` (Chamfer distance of parts), each also
        with ``_matched``, which leaves parts without partner out; ``oc`` (of the whole).
    """
    clouds = (matching.true, matching.predicted)
    at = [cloud.points if share is None else cloud.at(share) for cloud in clouds]
    theirs, ours = (cloud.parts(points) for cloud, points in zip(clouds, at, strict=True))
    their_boxes = [box_of(part) for part in theirs]
    our_boxes = [box_of(part) for part in ours]
    values = {
        "giou": matching.each(lambda i, j: giou(our_boxes[i], their_boxes[j])),
        "miou": matching.each(lambda i, j: iou(our_boxes[i], their_boxes[j])),
        "pc": matching.each(lambda i, j: chamfer(ours[i], theirs[j])),
    }
    penalties = {**PENALTIES, "pc": half_diagonal(matching.predicted)}
    scores = {"oc": chamfer(at[1], at[0])}
    for name, of_pair in values.items():
        scores[name] = matching.scored(of_pair, of_pair, penalties[name])
        scores[f"{name}_matched"] = matching.scored(of_pair, of_pair, None)
    return scores


def paper(true: ScoredCloud, predicted: ScoredCloud) -> Score:
    """Compare a prediction with the truth at rest and fully articulated.

    Boxes of the articulated state are around the articulated points. The paper does not say whether
    distances are squared, nor what an intersection over union of parts is; both are taken from the
    release: squared, and of boxes. Names are those of :func:`compared`, plain at rest and
    with ``articulated_`` at the upper limits.
    """
    matching = matched(true, predicted)
    full = compared(matching, 1.0)
    return Score(compared(matching) | {f"articulated_{name}": full[name] for name in full})
