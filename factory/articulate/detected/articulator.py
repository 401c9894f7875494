"""The articulator that looks: at parts that others propose, and for those that it alone sees."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ...articulation import Articulation, Weights
from ...errors import InputRejected
from ...intake.stated import Stated
from ...mesh import Mesh
from ...models.detector.canvas import OPENING, SORTS, look_at
from ...models.detector.decode import Dense, Found
from ...part import Part, PartKind, Proposer
from ..articulator import Articulator, make_hypotheses
from ..proposal import Hypothesis
from ..pruning import keep_parts
from ..rigid import rigid_articulation
from ..stated.articulator import StatedArticulator, seen_from
from .agreement import Agreement
from .merging import DetectedPart, seen_parts
from .rating import CellParts, support_of_box

if TYPE_CHECKING:
    from ...models.detector.detect import Detection

#: Parts of a side with a lower score are not looked at.
LEAST_SCORE = 0.5
#: What sides and network are so sure of moves, seen or not, as does what rules of shape find:
#: of the held-out parts none of these is wrong for want of being seen.
BELIEVED = 0.85
#: Kinds of object of which the detector learned too little to fix anything.
STRANGE = frozenset({"gadget", "window", "box", "door"})
#: Parts that are told of those that are seen and left fixed.
MOST_TOLD = 4
#: The detector is asked about these kinds of part; others open nothing that it knows.
ASKED = frozenset({PartKind.PART, PartKind.DOOR, PartKind.DRAWER, PartKind.FLAP, PartKind.LID})
#: These come and go with others that move.
CARRIED = frozenset({PartKind.KNOB, PartKind.BUTTON, PartKind.RACK, PartKind.TURNTABLE})


@dataclass(frozen=True)
class DetectedArticulator:
    """Asks somebody else, fixes what the detector does not see, and adds what it sees beside it.

    Attributes:
        guess: who is asked.
        agreement: how sure both must be.
        weights: of the detector.
        least: probability below which a part stays fixed; ``None``: the agreement's.
    """

    guess: Articulator
    agreement: Agreement
    weights: tuple[Weights, ...]
    least: float | None = None

    @property
    def name(self) -> str:
        """Return how whoever is asked is called."""
        return self.guess.name

    def articulate(self, mesh: Mesh) -> Articulation:
        """Return the likeliest hypothesis of ``mesh`` [m], z up."""
        return self.hypotheses(mesh)[0].articulation

    def hypotheses(self, mesh: Mesh) -> tuple[Hypothesis, ...]:
        """Return what may open, the likeliest first; all that is seen together comes first."""
        from ...models.detector.detect import detect

        detection = detect(mesh)
        least = self.agreement.least if self.least is None else self.least
        rated = self._rated(detection.parts(self._least_score), mesh, detection.dense)
        sure = [part for part in rated if part.probability >= least]
        left = [part for part in rated if part.probability < least]
        agreed = []
        faces = {id(mesh): detection.faces}
        for each in make_hypotheses(self.guess, mesh):
            guess = each.articulation
            if id(guess.mesh) not in faces:
                faces[id(guess.mesh)] = look_at(guess.mesh).cells
            cells = CellParts.of(guess, faces[id(guess.mesh)])
            strange = detection.kind in STRANGE
            agreed.append(guess if strange else self._agreed(guess, cells, detection.dense, least))
        first = max(agreed, key=lambda each: len(each.movable_joints) > 0)
        cells = CellParts.of(first, faces[id(first.mesh)])
        beside = [part for part in sure if not any(cells.has_moving(f) for f in part.found)]
        made = [*self._with(first, beside), *agreed]
        if len(sure) > len(first.movable_joints):
            made += self._with(rigid_articulation(mesh, self.name, ()), sure)
        open_ = [each for each in made if each.movable_joints] or [
            self._still(agreed[0], detection)
        ]
        notes = tuple(_said(part, least) for part in left[:MOST_TOLD])
        named = [
            replace(
                each,
                articulator=self.name,
                notes=(*notes, *each.notes),
                weights=(*each.weights, *self.weights),
            )
            for each in open_
        ]
        return tuple(Hypothesis.of(each) for each in _different(named))

    def _rated(self, found: Sequence[Found], mesh: Mesh, dense: Dense) -> list[DetectedPart]:
        """Return the parts that the detector sees alone, the surest first."""
        rated = []
        for part in seen_parts(found, mesh.extents):
            support = max(support_of_box(each, dense) for each in part.found)
            rated.append(replace(part, probability=self.agreement.of_alone(support)))
        return sorted(rated, key=lambda part: -part.probability)

    def _agreed(
        self, guess: Articulation, cells: CellParts, dense: Dense, least: float
    ) -> Articulation:
        """Return a guess without the parts that a side shows and the detector does not see.

        Racks, knobs and parts that no side shows move where something else does; those that rules
        of shape find move alone as well, such as a cooktop's knobs.
        """
        kept = []
        chances = {}
        alone = False
        for joint in guess.joints:
            part = guess.parts[joint.child]
            support = cells.support(joint.child, dense) if part.kind in ASKED else None
            if support is None:
                kept.append(joint.child)
                alone |= part.kind not in ASKED | CARRIED or _is_believed(part)
                continue
            confidence = 0.0 if part.confidence is None else part.confidence
            chance = self.agreement.of_proposed(support, confidence)
            if _is_believed(part):
                chance = max(chance, confidence, least)
            if chance >= least:
                kept.append(joint.child)
                chances[joint.child] = chance
        if not (chances or alone):
            kept = []
        return keep_parts(guess, kept, chances)

    def _with(self, guess: Articulation, parts: Sequence[DetectedPart]) -> list[Articulation]:
        """Return a guess with parts beside it; the least sure is left out where they do not fit."""
        seen = seen_from(guess.mesh, Stated().front)
        for count in range(len(parts), 0, -1):
            chosen = parts[:count]
            stated = StatedArticulator(
                Stated(parts=tuple(each.stated for each in chosen)),
                proposer=Proposer.DETECTOR,
                chances=tuple(each.probability for each in chosen),
                seen=seen,
            )
            try:
                return [each.articulation for each in stated.beside(guess)]
            except InputRejected:
                continue
        return []

    @property
    def _least_score(self) -> float:
        """Return the score from which parts of a side are looked at: less where little is asked."""
        return LEAST_SCORE if self.least is None else min(LEAST_SCORE, self.least)

    def _still(self, guess: Articulation, detection: Detection) -> Articulation:
        """Return a guess that moves nothing, with notes on what was seen."""
        looks = f"it looks like a {detection.kind.replace('_', ' ')}"
        sure = f"with probability {detection.kinds.max():.2f}"
        opens = f"it has something to open with probability {detection.opens:.2f}"
        opening = [each for each in detection.parts(0.0) if each.sort in SORTS[:OPENING]]
        surest = max(opening, key=lambda found: found.score, default=None)
        notes = [f"{looks} {sure}; {opens}"]
        if surest is not None and surest.score < self._least_score:
            notes.append(
                f"the surest part that its sides show is a {surest.sort.name.lower()} on the "
                f"{surest.side}, with a score of {surest.score:.2f}, want "
                f"{self._least_score:.2f}"
            )
        return rigid_articulation(guess.mesh, self.name, (*notes, *guess.notes))


def _is_believed(part: Part) -> bool:
    """Tell whether a part moves though the detector does not see it."""
    ruled = part.source is not None and part.source.proposer is Proposer.RULES
    return (ruled and part.kind is not PartKind.PART) or (part.confidence or 0.0) >= BELIEVED


def _said(part: DetectedPart, least: float) -> str:
    """Return a sentence about a part that was seen and is left fixed."""
    return (
        f"a {part.stated.kind} is seen on the {part.stated.side} and left fixed: it is there with "
        f"probability {part.probability:.2f}, want {least:.2f}"
    )


def _different(articulations: Sequence[Articulation]) -> list[Articulation]:
    """Return those that do not move as an earlier one does."""
    first: dict[str, Articulation] = {}
    for each in articulations:
        motions = [
            (
                j.kind,
                np.round(j.axis, 6).tolist(),
                np.round(j.origin, 6).tolist(),
                round(j.upper, 6),
            )
            for j in each.joints
        ]
        first.setdefault(repr(motions), each)
    return list(first.values())
