"""Parts that several views agree on, made one."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from ...mesh import BoolArray, FloatArray, freeze
from ..evidence import Guess
from ..proposal import Motion
from .views import NetworkView, SeenPart

#: Parts of two views are the same if they share so much of the area that both cover.
SAME = 0.6
#: Parts less likely to move are not looked at.
LEAST_MOVING = 0.3


@dataclass(frozen=True)
class LearnedPart:
    """One part as the network sees it on average.

    Attributes:
        faces: those that most of its views agree on, shape [face_count].
        agreement: share of the views that have it, 0 to 1.
        confidence, moves, hangs: means over those views, see :class:`.views.SeenPart`.
        guess: where and which way it moves, on average.
        slide: how it slides besides, if turning and sliding is more probable than either alone;
            ``None`` if not.
    """

    faces: BoolArray = field(repr=False)
    agreement: float
    confidence: float
    moves: float
    hangs: float
    guess: Guess
    slide: Motion | None = None

    def __post_init__(self) -> None:
        freeze(self, "faces", dtype=np.bool_)


@dataclass(frozen=True)
class _Seen:
    view: int
    faces: BoolArray
    part: SeenPart


def agreed_parts(views: tuple[NetworkView, ...], areas: FloatArray) -> tuple[LearnedPart, ...]:
    """Return parts that move in some view, surest first; a view's part is in one at most.

    Args:
        views: of one mesh.
        areas: of its faces [m2], shape [face_count].
    """
    seen = [
        _Seen(number, view.face_part == index, part)
        for number, view in enumerate(views)
        for index, part in enumerate(view.parts)
        if part.moves >= LEAST_MOVING
    ]
    seen.sort(key=lambda each: -each.part.confidence * each.part.moves)
    found = []
    while seen:
        first = seen[0]
        group = [first]
        taken = {first.view}
        for other in seen[1:]:
            if other.view not in taken and shared(first.faces, other.faces, areas) > SAME:
                group.append(other)
                taken.add(other.view)
        seen = [each for each in seen if not any(each is member for member in group)]
        found.append(_one(group, len(views)))
    return tuple(sorted(found, key=lambda part: -part.agreement * part.confidence * part.moves))


def shared(one: BoolArray, other: BoolArray, areas: FloatArray) -> float:
    """Return the area that two sets of faces share over the area that they cover, 0 to 1."""
    covered = float(areas[one | other].sum())
    return float(areas[one & other].sum()) / covered if covered > 0.0 else 0.0


def _one(group: list[_Seen], views: int) -> LearnedPart:
    parts = [each.part for each in group]
    weights = np.array([part.confidence * part.moves for part in parts])
    turns = float(np.average([part.turns for part in parts], weights=weights))
    both = float(np.average([part.both for part in parts], weights=weights))
    # Turning without sliding, and sliding without turning, are what is left of the two.
    slide = _mean_slide(parts) if both > max(turns - both, 1.0 - turns) else None
    alike = [
        part
        for part in parts
        if part.direction is not None and (part.point is not None) == (turns >= 0.5)
    ]
    direction = _mean_direction([part.direction for part in alike if part.direction is not None])
    points = [part.point for part in alike if part.point is not None]
    lower = float(np.median([part.lower for part in alike])) if alike else 0.0
    upper = float(np.median([part.upper for part in alike])) if alike else 0.0
    votes = np.mean([each.faces for each in group], axis=0)
    return LearnedPart(
        faces=votes >= 0.5,
        agreement=len(group) / views,
        confidence=float(np.mean([part.confidence for part in parts])),
        moves=float(np.mean([part.moves for part in parts])),
        hangs=float(np.mean([part.hangs for part in parts])),
        guess=Guess(
            turns=1.0 if slide is not None else min(max(turns, 0.0), 1.0),
            direction=direction,
            point=np.median(points, axis=0) if points and direction is not None else None,
            upper=upper - lower if upper > lower else None,
        ),
        slide=slide,
    )


def _mean_slide(parts: list[SeenPart]) -> Motion | None:
    slides = [part.slide for part in parts if part.slide is not None]
    direction = _mean_direction([slide.axis for slide in slides])
    if direction is None:
        return None
    ends = [np.median([getattr(slide, end) for slide in slides]) for end in ("lower", "upper")]
    axis = direction / float(np.linalg.norm(direction))
    return replace(slides[0], axis=axis, lower=float(ends[0]), upper=float(ends[1]))


def _mean_direction(directions: list[FloatArray]) -> FloatArray | None:
    """Return the mean of directions turned to one side; ``None`` if none or they cancel."""
    if not directions:
        return None
    sides = np.where(np.array(directions) @ directions[0] >= 0.0, 1.0, -1.0)
    # Which side is the majority's opinion.
    sign = 1.0 if sides.sum() >= 0.0 else -1.0
    mean = sign * np.mean(sides[:, None] * directions, axis=0)
    return mean if float(np.linalg.norm(mean)) > 1e-6 else None
