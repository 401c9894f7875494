"""What a long arm passes between two of the poses at which hulls were cut apart."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from ...mesh import FloatArray
from ..poses import relative_poses
from .along import Sides, hull_depth
from .hung import reach_m
from .pair import PartPair

#: After a cut all of a hinge's way is looked at, in steps so long at the end of its arm [m],
STEP_M = 0.004
#: at most so many for each that was cut at; and again after what was missed is cut, so often.
FINEST = 8
MOST_LOOKS = 3
#: In the first share of its range a door leaves its frame, corner past corner: steps are shorter.
LEAVING = 0.1
LEAVING_STEP_M = 0.0015
#: Hulls may be as near as this between two poses: PyBullet feels what is nearer [m].
LEAST_M = 0.002

Cut = Callable[..., Sides]


def _poses_between(pair: PartPair) -> list[FloatArray]:
    """Return poses between those of hinges, so near that a sheet at an arm's end meets another.

    None for slides, which are cut on all of their way, where the poses that are cut at are near
    enough, and where no joint holds one part in the other.
    """
    mover = pair.bodies.surfaces[pair.parts[1 - pair.holder]]
    if mover is None or not pair.jointed:
        return []
    articulation = pair.bodies.articulation
    count = pair.bodies.config.poses
    turning = [joint for joint in pair.joints if joint.turns]
    way = max((joint.range * reach_m(mover, joint) for joint in turning), default=0.0)
    most = FINEST * (count - 1)
    finer = min(int(way / STEP_M), most) + 1
    if finer <= count:
        return []
    leaving = min(int(LEAVING * way / LEAVING_STEP_M), most) + 1
    first = relative_poses(articulation, *pair.parts, leaving, LEAVING)
    return first + relative_poses(articulation, *pair.parts, finer)


def cut_between(cut: Cut, pair: PartPair, after: Sides, way: Sequence[FloatArray]) -> Sides | None:
    """Cut hulls of two parts anew where they are too near to one another between two poses.

    Args:
        cut: hulls at some poses.
        pair: the two parts, with the hulls that they have before.
        after: their hulls, cut.
        way: poses that they were cut at: of the second part as seen from the first, [4, 4] each.

    Returns:
        ``None`` where they are not.
    """
    found = None
    poses = list(way)
    between = _poses_between(pair)
    for _ in range(MOST_LOOKS):
        hulls = found or after
        missed = [pose for pose in between if hull_depth(*hulls, pose, LEAST_M) > -LEAST_M]
        if not missed:
            break
        # Where nearly all of a long way is missed, as that of a wheel, some of it shows the rest.
        poses += missed[:: -(-len(missed) // len(way))]
        found = cut(*pair.before, poses)
    return found
