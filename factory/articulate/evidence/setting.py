"""The setting that a moving part is in: what, besides its own evidence, tells how far it goes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...mesh import FloatArray, freeze
from .body import Body
from .candidates import Candidates
from .numbers import NAMES, SLIDE, TURN
from .travel import displaced

#: What every number of :class:`Setting` beyond the evidence is.
ABOUT = (
    "share", "tall", "thin", "whole_tall", "whole_deep", "high", "count", "alike", "hangs",
    "carries", "span", "axis_high",
)  # fmt: skip
#: Names of the numbers of what turns, and of what slides.
TURN_SETTING = (*TURN, *ABOUT)
SLIDE_SETTING = (*SLIDE, *ABOUT)
#: What slides is tried to so many of its lengths, what turns to half a turn, in so many steps.
FARTHEST_SLIDE = 1.5
STEPS = 36
#: Steps among which the part comes free of what it touches at rest.
AT_REST = 5
#: Share of the points that may meet something on the way in all: a wrong label is not yet a wall.
SLACK = 0.1
#: A part shorter than this share of the object, as seen along its way, is a front: it goes as deep
#: as the object.
FRONT = 0.15


@dataclass(frozen=True)
class Setting:
    """Of one candidate.

    Attributes:
        slides: whether it slides (else it turns).
        unit: what ranges are counted in: 1 rad, or what the part's way is measured by [m].
        stop: where it meets what holds it, in units; infinite if it does not.
        numbers: shape [len(TURN_SETTING)] or [len(SLIDE_SETTING)].
    """

    slides: bool
    unit: float
    stop: float
    numbers: FloatArray

    def __post_init__(self) -> None:
        freeze(self, "numbers")


def is_small(evidence: FloatArray) -> bool:
    """Return whether what slides is a button rather than a drawer, by its evidence."""
    return bool(evidence[NAMES.index("slide_small")] > 0.4)


def setting_of(body: Body, chosen: Candidates, evidence: FloatArray) -> Setting:
    """Return the setting of exactly one candidate, whose evidence has shape [len(NAMES)]."""
    slides = bool(chosen.slides[0])
    axis = chosen.axis[0]
    unit = _way(body, axis, evidence) if slides else 1.0
    farthest = FARTHEST_SLIDE * unit if slides else np.pi
    share = free_way(body, chosen, farthest)
    names = SLIDE if slides else TURN
    own = [float(evidence[NAMES.index(name)]) for name in names]
    about = [*_about(body), _log(float(np.ptp(body.corners @ axis)), _span(body, axis)) / 2.0]
    about.append(_height(body, float(chosen.origin[0, 2])))
    stop = np.inf if share >= 1.0 else share * farthest / unit
    return Setting(slides, unit, stop, np.array([*own, *about]))


def _way(body: Body, axis: FloatArray, evidence: FloatArray) -> float:
    """Return the part's length along its way; of drawer fronts without a box, the object's [m]."""
    length = max(float(evidence[NAMES.index("slide_extent")]) * body.diagonal, 1e-9)
    front = evidence[NAMES.index("slide_inside")] < FRONT and not is_small(evidence)
    return _span(body, axis) if front else length


def _span(body: Body, axis: FloatArray) -> float:
    return max(float(np.ptp(body.partition.few_vertices @ axis)), 1e-9)


def _height(body: Body, z: float) -> float:
    """Return -1 at the object's foot, 1 at its top."""
    low, high = body.partition.mesh.bounds[:, 2]
    return float(np.clip(2.0 * (z - low) / max(high - low, 1e-9) - 1.0, -1.5, 1.5))


def _log(one: float, other: float) -> float:
    """Return the logarithm of a ratio of lengths, within -3 to 3."""
    return float(np.clip(np.log(max(one, 1e-12) / max(other, 1e-12)), -3.0, 3.0))


def _about(body: Body) -> list[float]:
    """Return everything of ``ABOUT`` that is the same for each of a part's candidates."""
    partition = body.partition
    corners = body.corners
    level = np.ptp(corners @ partition.level.T, axis=0)
    whole = np.ptp(partition.few_vertices @ partition.level.T, axis=0)
    sides = np.sort(level)
    sizes = partition.part_diagonals
    same = (partition.parents == partition.parents[body.part]) & (
        np.abs(sizes / max(body.own_size, 1e-12) - 1.0) < 0.1
    )
    return [
        _log(body.diagonal, partition.mesh.diagonal) / 2.0,
        _log(float(level[2]), float(level[:2].max())) / 2.0,
        float(sides[0] / max(sides[2], 1e-12)),
        _log(float(whole[2]), float(whole[:2].max())),
        _log(float(whole[:2].min()), float(whole[:2].max())),
        _height(body, float(corners[:, 2].min() + corners[:, 2].max()) / 2.0),
        float(np.log2(len(partition.parents))) / 4.0,
        float(np.log2(max(int(same.sum()), 1))) / 4.0,
        float(len(partition.above(body.part)) > 1),
        float((partition.parents == body.part).any()),
    ]


def free_way(body: Body, chosen: Candidates, farthest: float) -> float:
    """Return the share of the way before more than a few points meet the part's holder."""
    values = np.arange(1, STEPS + 1) / STEPS * farthest
    tried = chosen.at(np.zeros(STEPS, dtype=np.int64))
    hits = body.holder.hits(*displaced(tried, body.probes.points, values))
    free = int(np.argmin(hits[:AT_REST].mean(axis=1)))
    met = np.logical_or.accumulate(hits[free:] & ~hits[free], axis=0).mean(axis=1)
    stopped = free + np.flatnonzero(met > SLACK)
    return float(stopped[0] / STEPS) if len(stopped) else 1.0
