"""Parts that are stated without a place: found by whoever guesses, and counted."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...articulation import Articulation, Joint
from ...errors import InputRejected
from ...geometry.triangles import face_areas
from ...intake.stated import StatedPart
from ...part import PartKind, Proposer
from ..proposal import Motion, Proposal
from ..seams.cutting import CutMesh, centred_in
from .boxed import NOT_FOUND
from .placing import Placed


@dataclass(frozen=True, eq=False)
class Expected:
    """A guess that has as many parts of each kind as are stated, beside those that are placed.

    Attributes:
        guess: the articulation that was guessed.
        placed: the stated parts that have a place, found on its mesh.
        joints: of its parts that are wanted.
    """

    guess: Articulation
    placed: Sequence[Placed]
    joints: tuple[Joint, ...]

    @property
    def kinds(self) -> Counter[PartKind]:
        """Return how many parts of each kind were found."""
        return Counter(self.guess.parts[joint.child].kind for joint in self.joints)

    @property
    def is_whole(self) -> bool:
        """Tell whether nothing is placed, and the guess has only wanted parts."""
        return not self.placed and len(self.joints) == len(self.guess.movable_joints)

    @property
    def hosts(self) -> list[int]:
        """Return the place, from 1, of what carries each wanted part; 0: the body."""
        places = {joint.child: place for place, joint in enumerate(self.joints, start=1)}
        return [places.get(joint.parent, 0) for joint in self.joints]

    def proposals(self, cut: CutMesh) -> list[Proposal]:
        """Return the wanted parts as proposals on a mesh that was cut out of the guess's."""
        made = []
        for joint in self.joints:
            part = self.guess.parts[joint.child]
            made.append(
                Proposal(
                    part.kind,
                    np.isin(cut.source, part.faces),
                    Motion(joint.kind, joint.axis, joint.origin, joint.lower, joint.upper),
                    proposer=Proposer.RULES if part.source is None else part.source.proposer,
                    panel=part.panel,
                    existence=part.confidence,
                    probability=joint.confidence,
                )
            )
        return made


def count_expected(parts: Sequence[StatedPart]) -> Counter[PartKind]:
    """Return how many parts of each kind are stated without a place."""
    wanted: Counter[PartKind] = Counter()
    for part in parts:
        if part.view is None:
            wanted[part.kind.part] += part.count
    return wanted


def require_some(found: Sequence[Expected], wanted: Counter[PartKind]) -> list[Expected]:
    """Return those guesses that have as many parts of each kind as are wanted.

    Raises:
        InputRejected: ``stated_part_not_found``: none has.
    """
    counted = [each.kinds for each in found]
    fit = [each for each, kinds in zip(found, counted, strict=True) if kinds == wanted]
    if fit:
        return fit
    nearest = max(counted, key=lambda kinds: (kinds & wanted).total() - (kinds - wanted).total())
    sentences = [f"found {nearest[kind]} of {wanted[kind]} {kind}s" for kind in wanted]
    raise InputRejected(
        NOT_FOUND,
        f"{', '.join(sentences)}; state a side and a box for each",
        value=float((nearest & wanted).total()),
        unit="parts",
        limit=float(wanted.total()),
    )


def find_expected(
    guess: Articulation, wanted: Counter[PartKind], placed: Sequence[Placed]
) -> Expected:
    """Return the wanted parts of a guess, most of whose surface is not where a placed part is.

    The others stay fixed.

    Args:
        guess: a whole articulation.
        wanted: kinds of parts.
        placed: the stated parts that have a place, found on the guess's mesh.
    """
    taken = np.zeros(len(guess.mesh.faces), dtype=np.bool_)
    for each in placed:
        taken |= centred_in(guess.mesh, each.ways[0].mover.region)
    areas = face_areas(guess.mesh)
    joints = []
    for joint in guess.movable_joints:
        part = guess.parts[joint.child]
        own = float(areas[part.faces].sum())
        shared = float(areas[part.faces[taken[part.faces]]].sum())
        if part.kind in wanted and own > 0.0 and shared < own / 2.0:
            joints.append(joint)
    return Expected(guess, placed, tuple(joints))
