"""Parts that are no panels: knobs, buttons and wheels, each closed by what its own surface says."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...articulation import Joint, JointKind, rotation_about
from ...asset import Hull
from ...config import SeparateConfig
from ...mesh import FloatArray
from ..decompose.convex import hull_of, limit_vertices
from .pieces import MOST_CORNERS

#: Pieces of two parts are so far apart, at rest and on the way: a knob begins this far before the
#: surface that it stands on [m].
APART_M = SeparateConfig.clearance_m
#: Share of its height that may be cut off below for that.
LEAST_LEFT = 0.35
#: Copies that make a wheel round.
TURNS = 24
#: Directions with a smaller cosine are across a joint.
ACROSS = 0.25
#: What turns further than this is round [rad].
SPINNING = 3.5
#: Nor is it a wheel if its own hull is a smaller share of what it sweeps: a lever, a turning door.
WHEEL_SHARE = 0.1


@dataclass(frozen=True)
class Bump:
    """A small convex part.

    Attributes:
        hull: of it.
        rule: ``cut_base``: cut flat before what it stands on; ``lathe``: its surface swept about
            its axis.
        normal: outward direction of the base, shape [3]; ``None`` if it has none.
        base: of the base along ``normal`` [m].
    """

    hull: Hull
    rule: str
    normal: FloatArray | None
    base: float


def find_bump(points: FloatArray, rim: FloatArray, joint: Joint) -> Bump | None:
    """Return a knob, a button or a wheel; ``None`` where a part would not turn on the spot.

    Points of its surface, and its rim of those on its border with other parts, have shape [n, 3]
    [m].
    """
    options = [cut for cut in (_cut(points, rim, way) for way in _ways(joint)) if cut is not None]
    if options:
        return max(options, key=lambda bump: bump.hull.volume)
    return _turned(points, joint) if joint.turns and joint.range > SPINNING else None


def _ways(joint: Joint) -> list[FloatArray]:
    """Return the directions in which it may stand out: those that its motion keeps."""
    ways = [np.asarray(joint.axis), -np.asarray(joint.axis)]
    if joint.kind is JointKind.PRISMATIC:
        across = np.vstack([np.eye(3), -np.eye(3)])
        ways += [way for way in across if abs(float(way @ joint.axis)) < ACROSS]
    return ways


def _cut(points: FloatArray, rim: FloatArray, way: FloatArray) -> Bump | None:
    if len(rim) < 3:
        return None
    height = points @ way
    base = float(np.percentile(rim @ way, 90)) + APART_M
    whole = float(np.ptp(height))
    if height.max() - base < max(LEAST_LEFT * whole, APART_M):
        return None
    above = points[height >= base]
    # The section at the base is not known where the skin has no corners: the lowest ones stand in.
    foot = points[(height < base) & (height > base - 0.5 * whole)]
    foot = foot + np.outer(base - foot @ way, way)
    hull = hull_of(np.concatenate([above, foot]))
    return None if hull is None else Bump(limit_vertices(hull, MOST_CORNERS), "cut_base", way, base)


def _turned(points: FloatArray, joint: Joint) -> Bump | None:
    hull = hull_of(points)
    if hull is None:
        return None
    arms = hull.vertices - joint.origin
    angles = (2.0 * np.pi * turn / TURNS for turn in range(TURNS))
    copies = [arms @ rotation_about(joint.axis, angle).T + joint.origin for angle in angles]
    round_hull = hull_of(np.concatenate(copies))
    if round_hull is None or hull.volume < WHEEL_SHARE * round_hull.volume:
        return None
    return Bump(limit_vertices(round_hull, MOST_CORNERS), "lathe", None, 0.0)
