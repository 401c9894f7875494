"""Parts that are stated without a place: found by whoever guesses, and counted."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np

from ...articulation import Articulation
from ...errors import InputRejected
from ...geometry.triangles import face_areas
from ...geometry.welding import welded
from ...intake.stated import StatedPart
from ...part import PartKind, Proposer
from ..proposal import Motion, Proposal
from ..seams.cutting import CutMesh, inside
from .boxed import NOT_FOUND, StatedBox


def proposals_on(cut: CutMesh, guess: Articulation) -> list[Proposal]:
    """Return the parts of a guess as proposals on a mesh that was cut out of the guess's."""
    return [
        Proposal(
            part.kind,
            np.isin(cut.source, part.faces),
            Motion(joint.kind, joint.axis, joint.origin, joint.lower, joint.upper),
            proposer=Proposer.RULES if part.source is None else part.source.proposer,
            panel=part.panel,
            existence=part.confidence,
            probability=joint.confidence,
        )
        for joint, part in zip(guess.joints, guess.parts[1:], strict=True)
    ]


def count_expected(parts: Sequence[StatedPart]) -> Counter[PartKind]:
    """Return how many parts of each kind are stated without a place."""
    wanted: Counter[PartKind] = Counter()
    for part in parts:
        if part.view is None:
            wanted[part.kind.part] += part.count
    return wanted


def require_some(found: Sequence[Articulation], wanted: Counter[PartKind]) -> list[int]:
    """Return the places of guesses that have as many parts of each kind as are wanted.

    Raises:
        InputRejected: ``stated_part_not_found``: none has.
    """
    counted = [Counter(part.kind for part in each.parts[1:]) for each in found]
    fit = [place for place, kinds in enumerate(counted) if kinds == wanted]
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


def keep_expected(
    guess: Articulation, placed: Sequence[StatedBox], wanted: Counter[PartKind]
) -> Articulation:
    """Return a guess in which only wanted parts move, most of each not where a placed part is.

    The others stay fixed to what holds them.

    Args:
        guess: a whole articulation.
        placed: the stated parts that have a place, found on the guess's mesh.
        wanted: kinds of parts.
    """
    taken = np.zeros(len(guess.mesh.faces), dtype=np.bool_)
    for each in placed:
        taken |= inside(guess.mesh, each.ways[0].mover.region)
    areas = face_areas(guess.mesh)
    fixed = []
    for joint in guess.joints:
        part = guess.parts[joint.child]
        own = float(areas[part.faces].sum())
        shared = float(areas[part.faces[taken[part.faces]]].sum())
        if part.kind not in wanted or not shared < own / 2.0:
            fixed.append(joint.name)
    return welded(guess, fixed)
