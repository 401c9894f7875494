"""The network's answer on points -> the part of each face, the tree, and each part's motion."""

from __future__ import annotations

from dataclasses import dataclass, fields
from enum import StrEnum

import numpy as np
import numpy.typing as npt
from scipy.special import log_softmax

from ...config import ParticulateConfig
from ...mesh import FloatArray, IntArray, read_only
from .frames import UnitBox
from .labels import Refinement, refined, voted, with_gaps_filled
from .motion import PredictedMotion, read_motion, require_finite_numbers
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
    surface: Surface,
    proxy: Proxy,
    sample: CloudSample,
    prediction: Prediction,
    config: ParticulateConfig,
) -> Decoded:
    """Read the network's answer for one sample of one mesh.

    Args:
        surface: the whole mesh, object frame [m].
        proxy: the surface sampled in its stead.
        sample: what the network was shown; row ``i`` of the answer is about its point ``i``.
        prediction: the answer, network frame.
        config: how to read it: parts that are less sure than ``least_confidence`` are dissolved,
            see :func:`assigned`; :class:`~.labels.Refinement`; :func:`~.labels.fused_components`;
            :class:`TreeOver`.

    Raises:
        InputRejected: ``prediction_not_finite``, naming the field.
    """
    for each in fields(prediction):
        value = getattr(prediction, each.name)
        # Votes are looked at where a part counts them.
        if value is not None and each.name != "closest_points":
            require_finite_numbers(value, each.name)
    points = assigned(prediction.mask_logits, config.least_confidence)
    labels = voted(sample.cloud.faces, points.parts, len(proxy.surface.faces))
    labels = carried_back(proxy, labels, surface.faces)
    labels = with_gaps_filled(surface, labels, sample.cloud.points, points.parts)
    labels, fused = refined(surface, labels, Refinement(config.refinement), config.fused_share)
    owners, face_part = np.unique(labels, return_inverse=True)
    tree = _tree(prediction, owners, points.present, TreeOver(config.tree))
    row = {int(query): index for index, query in enumerate(owners)}
    logits = prediction.hierarchy_logits
    held = {child: _sigmoid(logits[parent, child]) for parent, child in tree}
    parts = tuple(
        DecodedPart(
            query=query,
            confidence=float(points.confidence[query]),
            parent_probability=held.get(query),
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


def _tree(
    prediction: Prediction, owners: IntArray, present: IntArray, over: TreeOver
) -> tuple[Edge, ...]:
    """Return one tree over the parts with faces; recomputed where the predicted root has none."""
    competing = present if over is TreeOver.PRESENT else np.arange(prediction.part_count)
    tree = induced(spanning_arborescence(prediction.hierarchy_logits, competing), owners)
    whole = len(tree) == len(owners) - 1
    return tree if whole else spanning_arborescence(prediction.hierarchy_logits, owners)


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


Edge = tuple[int, int]


def spanning_arborescence(logits: npt.ArrayLike, parts: IntArray) -> tuple[Edge, ...]:
    """Return the edges (parent, child) of the tree with most ``log sigmoid(logit)``, by child.

    Edmonds' algorithm over all pairs; every part may be the root, and the best one is.

    Args:
        logits: ``logits[i, j]``: that ``i`` is the parent of ``j``; finite, shape [n, n]. The
            diagonal is not read.
        parts: distinct indices; none or one give no edges.
    """
    import networkx as nx

    if len(parts) < 2:
        return ()
    weights = -np.logaddexp(0.0, -np.asarray(logits, dtype=np.float64))
    graph = nx.DiGraph()
    graph.add_nodes_from(int(part) for part in parts)
    graph.add_weighted_edges_from(
        (int(i), int(j), float(weights[i, j])) for i in parts for j in parts if i != j
    )
    tree = nx.maximum_spanning_arborescence(graph)
    return tuple(sorted(((int(i), int(j)) for i, j in tree.edges), key=lambda edge: edge[1]))


def induced(edges: tuple[Edge, ...], parts: IntArray) -> tuple[Edge, ...]:
    """Return the tree's edges among ``parts``, by child; orphans go to the nearest kept ancestor.

    Where the root is lost this may be several trees.
    """
    alive = {int(part) for part in parts}
    parent = {child: above for above, child in edges}
    found: dict[int, int] = {}
    for part in sorted(alive):
        above = parent.get(part)
        while above is not None and above not in alive:
            above = parent.get(above)
        if above is not None:
            found[part] = above
    return tuple((above, part) for part, above in sorted(found.items()))


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
    among = log_softmax(logits[:, present], axis=1)
    logarithm = among[np.arange(len(parts)), np.searchsorted(present, parts)]
    count = np.bincount(parts, minlength=logits.shape[1])
    total = np.bincount(parts, weights=logarithm, minlength=logits.shape[1])
    return np.asarray(np.where(count > 0, np.exp(total / np.maximum(count, 1)), 0.0))
