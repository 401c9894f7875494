"""The network's answer on points -> the part of each face, the tree, and each part's motion."""

from __future__ import annotations

from dataclasses import dataclass, fields
from enum import StrEnum

import numpy as np

from ...errors import InputRejected
from ...mesh import IntArray, read_only
from .arborescence import Edge, induced, spanning_arborescence
from .confidence import assigned
from .frames import UnitBox
from .labels import Refinement, refined, voted, with_gaps_filled
from .motion import PredictedMotion, read_motion
from .prediction import Prediction
from .proxy import Proxy, carried_back
from .sampling import CloudSample
from .surface import Surface


class TreeOver(StrEnum):
    """Which parts compete for the tree before it is narrowed to those that own faces.

    ``present``: those with a point, as the released code has it. ``all``: all of the network's, as
    the paper has it; those that mean nothing for this object then take part too.
    """

    PRESENT = "present"
    ALL = "all"


@dataclass(frozen=True)
class DecodeRules:
    """How an answer is read.

    Attributes:
        least_confidence: parts below it are dissolved, see :func:`~.confidence.assigned`.
        refinement: see :class:`~.labels.Refinement`.
        fused_share: see :func:`~.labels.fused_components`.
        tree: see :class:`TreeOver`.
    """

    least_confidence: float = 0.0
    refinement: Refinement = Refinement.AUTO
    fused_share: float = 0.1
    tree: TreeOver = TreeOver.PRESENT


@dataclass(frozen=True)
class DecodedPart:
    """A part that owns faces.

    Attributes:
        query: its number in the network's answer.
        confidence: in its points, 0 to 1.
        parent_probability: that its parent is the one it has; ``None`` for the root.
        motion: relative to its parent, network frame; what the network said also for the root,
            which stays still.
    """

    query: int
    confidence: float
    parent_probability: float | None
    motion: PredictedMotion


@dataclass(frozen=True)
class Decoded:
    """One decoded answer for one mesh.

    Attributes:
        face_part: index into ``parts`` of every face, shape [face_count].
        parts: by ascending query.
        edges: (parent, child), indices into ``parts``: one tree, by child.
        box: object frame to the network's.
        notes: what a person should know of, one sentence each.
    """

    face_part: IntArray
    parts: tuple[DecodedPart, ...]
    edges: tuple[Edge, ...]
    box: UnitBox
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "face_part", read_only(self.face_part, np.int64))

    @property
    def root(self) -> int:
        """Return the part without a parent."""
        children = {child for _, child in self.edges}
        return next(part for part in range(len(self.parts)) if part not in children)


def decode(
    surface: Surface, proxy: Proxy, sample: CloudSample, prediction: Prediction, rules: DecodeRules
) -> Decoded:
    """Read the network's answer for one sample of one mesh.

    Args:
        surface: the whole mesh, object frame [m].
        proxy: the surface sampled in its stead.
        sample: what the network was shown; row ``i`` of the answer is about its point ``i``.
        prediction: the answer, network frame.
        rules: how to read it.

    Raises:
        InputRejected: ``prediction_not_finite``, naming the field.
    """
    require_finite(prediction)
    points = assigned(prediction.mask_logits, rules.least_confidence)
    labels = voted(sample.cloud.faces, points.parts, len(proxy.surface.faces))
    labels = carried_back(proxy, labels, surface.faces)
    labels = with_gaps_filled(surface, labels, sample.cloud.points, points.parts)
    labels, fused = refined(surface, labels, rules.refinement, rules.fused_share)
    owners, face_part = np.unique(labels, return_inverse=True)
    tree = _tree(prediction, owners, points.present, rules.tree)
    row = {int(query): index for index, query in enumerate(owners)}
    above = {child: parent for parent, child in tree}
    parts = tuple(
        DecodedPart(
            query=query,
            confidence=float(points.confidence[query]),
            parent_probability=_sigmoid(prediction.hierarchy_logits[above[query], query])
            if query in above
            else None,
            motion=read_motion(prediction, query, points.parts),
        )
        for query in row
    )
    return Decoded(
        face_part=face_part.reshape(-1),
        parts=parts,
        edges=tuple((row[parent], row[child]) for parent, child in tree),
        box=sample.box,
        notes=_notes(len(points.present) - len(owners), fused, proxy, surface),
    )


def require_finite(prediction: Prediction) -> None:
    """Refuse an answer with NaN or infinity in it.

    Raises:
        InputRejected: ``prediction_not_finite``, naming the field.
    """
    for each in fields(prediction):
        value = getattr(prediction, each.name)
        if isinstance(value, np.ndarray) and not np.isfinite(value).all():
            bad = int((~np.isfinite(value)).sum())
            raise InputRejected(
                "prediction_not_finite",
                f"{bad} of {value.size} numbers in the network's {each.name} are not finite; "
                "check its weights",
                value=float(bad),
                unit="numbers",
                limit=0.0,
            )


def _tree(
    prediction: Prediction, owners: IntArray, present: IntArray, over: TreeOver
) -> tuple[Edge, ...]:
    """Return one tree over the parts with faces; recomputed where the predicted root has none."""
    competing = present if over is TreeOver.PRESENT else np.arange(prediction.part_count)
    tree = induced(spanning_arborescence(prediction.hierarchy_logits, competing), owners)
    return (
        tree
        if len(tree) == len(owners) - 1
        else spanning_arborescence(prediction.hierarchy_logits, owners)
    )


def _sigmoid(logit: float) -> float:
    return float(np.exp(-np.logaddexp(0.0, -float(logit))))


def _notes(lost: int, fused: int, proxy: Proxy, surface: Surface) -> tuple[str, ...]:
    notes = []
    if proxy.vertex is not None:
        seen = len(proxy.surface.faces)
        whole = len(surface.faces)
        notes.append(f"the network saw {seen} faces in place of {whole}; labels were carried back")
    if lost:
        notes.append(
            f"{lost} predicted {'part' if lost == 1 else 'parts'} lost every face to others"
        )
    if fused:
        what = "1 connected surface holds" if fused == 1 else f"{fused} connected surfaces hold"
        notes.append(f"{what} more than one part: cut along the predicted borders")
    return tuple(notes)
