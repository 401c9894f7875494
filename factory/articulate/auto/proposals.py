"""Everything that might move: what the rules of shape find, and what the network sees."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...geometry.triangles import face_areas
from ...mesh import FloatArray, Mesh
from ...part import PartKind, Proposer
from ..evidence import MotionEvidence, Partition, best_motion
from ..proposal import Motion, Proposal
from .partition import share_out
from .parts import LearnedPart, shared
from .trust import log_odds

#: Two proposals are for the same part if they share so much of the area that both cover.
SAME_PART = 0.5
#: And for the same motion if their axes agree to this cosine.
SAME_AXIS = 0.98
#: Two parts are copies if their sizes agree to this share of the largest.
SAME_SIZE = 0.02
#: A slide that agrees with the axis of its turn to this cosine goes along it.
ALONG = 0.9


@dataclass(frozen=True)
class _Judged:
    """A learned part with what the geometry makes of its motion."""

    part: LearnedPart
    guided: MotionEvidence
    unguided: MotionEvidence


def propose(
    mesh: Mesh,
    areas: FloatArray,
    ruled: tuple[Proposal, ...],
    learned: tuple[LearnedPart, ...],
) -> tuple[Proposal, ...]:
    """Return every part that either says moves; one proposal where both mean the same part.

    Args:
        mesh: metres, z up.
        areas: of its faces, shape [face_count].
        ruled: what the rules of shape make of it.
        learned: what the network sees, best first.
    """
    judged = _judged(mesh, areas, learned)
    left = list(judged)
    found = []
    for said in ruled:
        overlaps = [shared(said.faces, each.part.faces, areas) for each in left]
        mate = (
            left.pop(int(np.argmax(overlaps))) if max(overlaps, default=0.0) > SAME_PART else None
        )
        motion = None if mate is None else mate.guided.motion
        seen = motion if _alike(said.motion, motion) else None
        signs = _signs(said.faces, areas, mate, len(judged))
        signs |= {
            "geometric": float(mate is None),
            "shared": float(mate is not None),
            "alike": float(seen is not None),
        }
        found.append(replace(said, motion=_as_open(said.motion, seen), signs=signs))
    for each in left:
        motion = each.guided.motion
        if motion is not None:
            signs = _signs(each.part.faces, areas, each, len(judged)) | {"learned": 1.0}
            found.append(
                Proposal(
                    PartKind.PART,
                    each.part.faces,
                    motion,
                    signs,
                    slide=_slide_with(motion, each.part),
                    proposer=Proposer.NETWORK,
                )
            )
    return tuple(found)


def copies_of(mesh: Mesh, proposals: Sequence[Proposal]) -> list[list[int]]:
    """Return the copies of each proposal's part that move alike, itself among them, by number."""
    corners = mesh.vertices[mesh.faces]
    areas = face_areas(mesh)
    parts = [each.faces for each in proposals]
    sizes = [[*np.ptp(corners[part], axis=(0, 1)), np.sqrt(areas[part].sum())] for part in parts]
    whole = np.reshape(sizes, (-1, 4))
    alike = np.abs(whole[:, None] - whole).max(axis=2) <= SAME_SIZE * whole.max(axis=1)
    motions = [each.motion for each in proposals]
    return [
        [int(n) for n in np.flatnonzero(row) if n == number or _alike(motion, motions[n])]
        for number, (row, motion) in enumerate(zip(alike, motions, strict=True))
    ]


def _judged(mesh: Mesh, areas: FloatArray, learned: tuple[LearnedPart, ...]) -> list[_Judged]:
    sharing = share_out([part.faces for part in learned], areas)
    partition = Partition(mesh, sharing.face_part, np.array([-1, *sharing.hosts]))
    return [
        _Judged(
            part=replace(learned[index], faces=sharing.face_part == number),
            guided=best_motion(partition, number, learned[index].guess),
            unguided=best_motion(partition, number),
        )
        for number, index in enumerate(sharing.chosen, start=1)
    ]


def _signs(
    faces: np.ndarray, areas: FloatArray, seen: _Judged | None, rivals: int
) -> dict[str, float]:
    signs = {"area": float(np.log10(max(areas[faces].sum() / max(areas.sum(), 1e-300), 1e-6)))}
    signs["rivals"] = float(np.log2(1 + rivals))
    if seen is not None:
        signs |= {
            "agreement": seen.part.agreement,
            "confidence": log_odds(seen.part.confidence),
            "moves": log_odds(seen.part.moves),
            "hangs": log_odds(seen.part.hangs),
            "evidence": log_odds(seen.guided.confidence),
            "unguided": log_odds(seen.unguided.confidence),
        }
    return signs


def _as_open(motion: Motion, seen: Motion | None) -> Motion:
    """Return the rules' motion, with the evidence's limits where it sees the part stand open.

    The rules never see that.
    """
    if seen is None or seen.kind != "prismatic" or not seen.lower < 0.0:
        return motion
    ahead = float(seen.axis @ motion.axis) > 0.0
    lower, upper = (seen.lower, seen.upper) if ahead else (-seen.upper, -seen.lower)
    return replace(motion, lower=lower, upper=upper)


def _alike(one: Motion, other: Motion | None) -> bool:
    """Tell whether two motions are of one kind and direction."""
    if other is None or (other.kind == "prismatic") != (one.kind == "prismatic"):
        return False
    return abs(float(other.axis @ one.axis)) > SAME_AXIS


def _slide_with(motion: Motion, part: LearnedPart) -> Motion | None:
    """Return the slide of a part that also turns: along that axis unless surely not."""
    if part.slide is None or motion.kind == "prismatic" or not part.slide.upper > part.slide.lower:
        return None
    along = float(part.slide.axis @ motion.axis)
    return (
        part.slide if abs(along) < ALONG else replace(part.slide, axis=np.sign(along) * motion.axis)
    )
