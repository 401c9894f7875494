"""The articulator that looks: at parts that others propose, and for those that it alone sees."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from msgspec import structs

from ...articulation import Articulation, Joint
from ...errors import InputRejected
from ...geometry.posing import closed, posed, rotated
from ...geometry.welding import welded
from ...intake.stated import Hinge, Stated, StatedAlternative, StatedKind, StatedPart
from ...mesh import Mesh
from ...models.detector.canvas import Sort, look_at
from ...models.detector.detect import Detection, detect, detector_weights
from ...part import PartKind, Proposer
from ...views.raster import Side
from ..articulator import Articulator, HypothesisMaker
from ..closing import note_open, with_closed_hinges
from ..origin import MeshOrigin
from ..rigid import rigid_articulation
from ..stated import StatedArticulator
from ..stated.seen import SeenMesh
from ..straight import straightening
from .agreement import load_agreement
from .boxes import with_whole_drawers
from .facing import without_backs
from .merging import DetectedPart, likely_hinges, seen_parts
from .open_panels import open_panels, reopened, with_closed
from .panels import panels_of
from .rating import CARRIED, CellParts, by_rules, support_of_box
from .screens import open_screen

#: Lids of a side with a lower score are not looked at.
LEAST_SCORE = 0.5
#: What is thinner than this share of its longest extent holds nothing.
THINNEST = 0.005
#: Panels that are less probable are not told of.
LEAST_CHANCE = 0.05
#: Parts that whoever proposes them is so sure of move, seen or not: of ten that are not seen eight
#: are right.
BELIEVED = 0.85
#: Kinds of object of which the detector learned too little to fix anything.
STRANGE = frozenset({"gadget", "window", "box"})
#: Kinds of object whose rows of knobs are turned; on others, such as cabinets, they are pulled.
KNOBBED = frozenset({"oven", "microwave", "dishwasher", "washer"})
#: The line that a lid turns about is this far from its middle to its side.
AT_SIDE = 0.5
#: Of this kind the screen is looked for where it stands open.
LAPTOP = "laptop"
#: From this probability on the kind of the object is believed: of 102 held-out meshes 85 are.
SURE_KIND = 0.9
#: Parts that are told of those that are seen and left fixed.
MOST_TOLD = 4
#: The detector is asked about these kinds of part; others open nothing that it knows.
ASKED = frozenset({PartKind.PART, PartKind.DOOR, PartKind.DRAWER, PartKind.FLAP, PartKind.LID})


@dataclass(frozen=True)
class DetectedArticulator(HypothesisMaker):
    """Asks somebody else, fixes what the detector does not see, and adds what it sees beside it.

    Attributes:
        guess: who is asked.
        least: probability below which a part stays fixed; ``None``: the agreement's.
    """

    guess: Articulator
    least: float | None = None

    @property
    def name(self) -> str:
        """Return how whoever is asked is called."""
        return self.guess.name

    def hypotheses(self, mesh: Mesh) -> tuple[Articulation, ...]:
        """Return what may open, the likeliest first; all that is seen together comes first."""
        straight = straightening(mesh)
        if straight is None:
            return self._articulations(mesh)
        turned = self._articulations(mesh.turned(straight))
        return tuple(rotated(each, straight.T) for each in turned)

    def _articulations(self, mesh: Mesh) -> tuple[Articulation, ...]:
        """Return the articulations that a mesh may have whose sides look along the axes."""
        detection = detect(mesh)
        sure_kind = detection.kind if detection.kinds.max() >= SURE_KIND else None
        if sure_kind == LAPTOP and (made := _with_screen(mesh, float(detection.kinds.max()))):
            return tuple(self._noted(each, sure_kind) for each in made)
        least = load_agreement().least if self.least is None else self.least
        shell = MeshOrigin.of(mesh).is_shell
        seen = SeenMesh.of(mesh)
        drawn = open_panels(seen.views, detection, one_piece=shell)
        if drawn is not None:
            shut = closed(drawn)
            mesh = shut.mesh
            detection = detect(mesh)
            seen = SeenMesh.of(mesh)
        rated = self._rated(detection, seen, closed=shell)
        sure = [part for part in rated if part.probability >= least]
        guess = self.guess.articulate(mesh)
        if drawn is not None:
            guess = with_closed(guess, shut)
        faces = detection.faces if guess.mesh is mesh else look_at(guess.mesh).cells
        moves = bool(guess.movable_joints)
        if detection.kind not in STRANGE:
            cells = CellParts.of(guess, faces)
            guess, moves = self._agreed(guess, cells, detection, least, sure)
        left = [part for part in rated if part not in sure]
        cells = CellParts.of(guess, faces)
        gone = _misplaced(cells, sure)
        if shell:
            gone += _several_in_one(cells, sure)
        guess = welded(guess, gone)
        cells = CellParts.of(guess, faces)
        beside = [part for part in sure if not any(cells.has_moving(f) for f in part.found)]
        guess = welded(guess, _pulls(cells, beside))
        shown = seen if guess.mesh is mesh else SeenMesh.of(guess.mesh)
        made = [*self._with(guess, beside, shown), *([guess] if moves else [])]
        if not made or 0 < len(guess.movable_joints) < len(sure):
            made += self._with(rigid_articulation(mesh, self.name, ()), sure, seen)
        made = [without_backs(each, detection.kind) for each in made]
        moving = [with_closed_hinges(with_whole_drawers(e)) for e in made if e.movable_joints]
        told = moving or [self._still(mesh, guess, detection)]
        notes = tuple(_said(part, least) for part in left[:MOST_TOLD])
        if drawn is not None:
            told = [reopened(each, drawn) for each in told]
            notes += drawn.notes
        return tuple(self._noted(each, sure_kind, notes) for each in told)

    def _noted(
        self, made: Articulation, kind: str | None, notes: tuple[str, ...] = ()
    ) -> Articulation:
        """Return an articulation with who made it, what it looks like and notes."""
        return replace(
            made,
            articulator=self.name,
            notes=(*notes, *made.notes),
            weights=(*made.weights, detector_weights()),
            looks_like=kind,
        )

    def _rated(self, detection: Detection, seen: SeenMesh, *, closed: bool) -> list[DetectedPart]:
        """Return the parts that the detector sees alone, the surest first.

        ``closed``: look at every rectangle that seams close as well.
        """
        extents = seen.mesh.extents
        if not extents.min() > THINNEST * extents.max():
            return []
        dense = detection.dense
        panels = []
        for found, signs in panels_of(dense, seen, closed=closed):
            chance = load_agreement().panel.chance(signs)
            if chance >= LEAST_CHANCE:
                panels.append(replace(found, score=chance))
        # Where little is asked lids with a lower score are looked at, too.
        lowest = LEAST_SCORE if self.least is None else min(LEAST_SCORE, self.least)
        lids = [each for each in detection.parts(lowest) if each.sort is Sort.LID]
        rated = []
        for part in seen_parts([*panels, *lids], extents):
            stated = part.stated
            probability = part.found[0].score
            if stated.kind is StatedKind.LID:
                support = max(support_of_box(each, dense) for each in part.found)
                probability = load_agreement().lid.chance(np.array([support]))
                stated = stated if stated.hinge is not None else _hinged(part)
            rated.append(replace(part, stated=stated, probability=probability))
        return sorted(rated, key=lambda part: -part.probability)

    def _agreed(
        self,
        guess: Articulation,
        cells: CellParts,
        detection: Detection,
        least: float,
        sure: Sequence[DetectedPart],
    ) -> tuple[Articulation, bool]:
        """Return a guess without parts that a side shows and the detector does not see.

        Racks, knobs and parts that no side shows move where something else does; those that rules
        of shape find move alone as well, such as a cooktop's knobs. Whether anything moves that
        needs nothing else to is told, too.
        """
        fixed = []
        chances = {}
        alone = False
        for joint in guess.joints:
            part = guess.parts[joint.child]
            signs = cells.signs(joint.child, detection) if part.kind in ASKED else None
            if signs is None:
                if part.is_by(Proposer.SIDES) and detection.kind not in KNOBBED:
                    fixed.append(joint.name)
                else:
                    alone |= by_rules(part)
                continue
            chance = load_agreement().proposed.chance(signs)
            confidence = part.confidence or 0.0
            if confidence >= BELIEVED and not any(
                cells.hides(joint.child, f) for each in sure for f in each.found
            ):
                chance = max(chance, confidence)
            if chance >= least:
                chances[joint.child] = chance
            else:
                fixed.append(joint.name)
        return welded(_with_chances(guess, chances), fixed), alone or bool(chances)

    def _with(
        self, guess: Articulation, parts: Sequence[DetectedPart], seen: SeenMesh
    ) -> tuple[Articulation, ...]:
        """Return a guess with parts beside it; the least sure is left out where they do not fit."""
        for count in range(len(parts), 0, -1):
            chosen = parts[:count]
            stated = StatedArticulator(
                Stated(parts=tuple(each.stated for each in chosen)),
                proposer=Proposer.DETECTOR,
                chances=tuple(each.probability for each in chosen),
                seen=seen,
            )
            try:
                return stated.beside(guess)
            except InputRejected:
                continue
        return ()

    def _still(self, mesh: Mesh, guess: Articulation, detection: Detection) -> Articulation:
        """Return an articulation that moves nothing, with notes on all that was seen."""
        looks = f"it looks like a {detection.kind.replace('_', ' ')}"
        sure = f"with probability {detection.kinds.max():.2f}"
        opens = f"it has something to open with probability {detection.opens:.2f}"
        return rigid_articulation(mesh, self.name, (f"{looks} {sure}; {opens}", *guess.notes))


def _with_screen(mesh: Mesh, chance: float) -> list[Articulation]:
    """Return what a laptop with an open screen may be, in the pose that it is drawn in."""
    screen = open_screen(mesh)
    if screen is None:
        return []
    said = Stated(parts=(screen,))
    stated = StatedArticulator(said, proposer=Proposer.DETECTOR, chances=(chance,))
    try:
        hypotheses = stated.hypotheses(mesh)
    except InputRejected:
        return []
    assert isinstance(screen.drawn, float), "its angle is measured"  # noqa: S101
    notes = (note_open("its screen", screen.drawn),)
    made = []
    for each in hypotheses:
        (joint,) = each.joints
        drawn = {joint.name: min(float(np.radians(screen.drawn)), joint.upper)}
        made.append(replace(posed(each, drawn), notes=notes))
    return made


def _hinged(part: DetectedPart) -> StatedPart:
    """Return a lid hinged at the likeliest side, or at the next."""
    first, second, *_ = likely_hinges(part.found)
    other = StatedAlternative(hinge=Hinge(second))
    return structs.replace(part.stated, hinge=Hinge(first), alternatives=(other,))


def _with_chances(guess: Articulation, chances: Mapping[int, float]) -> Articulation:
    """Return a guess in which some parts, by number, and their joints have other probabilities."""
    parts = list(guess.parts)
    joints = list(guess.joints)
    for number, chance in chances.items():
        parts[number] = replace(parts[number], confidence=chance)
        joints[number - 1] = replace(joints[number - 1], confidence=chance)
    return replace(guess, parts=tuple(parts), joints=tuple(joints))


def _misplaced(cells: CellParts, sure: Sequence[DetectedPart]) -> list[str]:
    """Return the joints that are elsewhere than all sides of a lid in their place agree on."""
    guess = cells.articulation
    # One whose sides do not agree has another hinge to try.
    lids = [
        (part, Side(part.stated.hinge))
        for part in sure
        if part.stated.kind is StatedKind.LID and part.stated.hinge and not part.stated.alternatives
    ]
    return [
        joint.name
        for joint in guess.joints
        if any(
            cells.hides(joint.child, found) and not _hinged_at(guess, joint, side)
            for part, side in lids
            for found in part.found
        )
    ]


def _several_in_one(cells: CellParts, sure: Sequence[DetectedPart]) -> list[str]:
    """Return the joints of parts in whose place several panels are seen.

    That is right of shells only: pieces that somebody modelled are parts as they are.
    """
    panels = [part.found[0] for part in sure if part.stated.kind is not StatedKind.LID]
    return [
        joint.name
        for joint in cells.articulation.joints
        if sum(cells.hides(joint.child, found) for found in panels) > 1
    ]


def _hinged_at(guess: Articulation, joint: Joint, side: Side) -> bool:
    """Tell whether the place of a part's joint is at one side of its box."""
    outward = -side.frame[2]
    low, high = guess.part_mesh(joint.child).bounds
    half = float(np.abs(outward) @ (high - low)) / 2.0
    return float(outward @ (joint.origin - (low + high) / 2.0)) > AT_SIDE * half


def _pulls(cells: CellParts, beside: Sequence[DetectedPart]) -> list[str]:
    """Return the joints of knobs on panels that come beside a guess: these are pulled by them."""
    guess = cells.articulation
    panels = [f for part in beside for f in part.found if f.sort is not Sort.LID]
    return [
        joint.name
        for joint in guess.joints
        if guess.parts[joint.child].kind in CARRIED
        and any(cells.lies_in(joint.child, f) for f in panels)
    ]


def _said(part: DetectedPart, least: float) -> str:
    """Return a sentence about a part that was seen and is left fixed."""
    return (
        f"a {part.stated.kind} is seen on the {part.stated.side} and left fixed: it is there with "
        f"probability {part.probability:.2f}, want {least:.2f}"
    )
