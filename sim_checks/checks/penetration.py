"""Do the parts overlap: at rest, along every joint, and in combination?

Depth at rest and depth gained along the way are two numbers and are never mixed: a drawer 5 mm too
wide gains nothing on its way out, and a door that swings into its frame may touch nothing at rest.
Every pair of parts counts, parent and child too: what PhysX and Bullet silently let pass, MuJoCo
stops. Joints that follow another are never moved by themselves:
wherever a joint goes, its followers are where it takes them.
"""

from __future__ import annotations

from collections.abc import Mapping

from ..config import PenetrationConfig, WorkConfig
from ..description import Description
from ..geometry.collision import LookBudget, TooManyLooks
from ..geometry.kinematics import find_tree
from ..geometry.solids import Solids
from .diagnosis import Diagnosis
from .extent import beyond
from .neighbours import open_neighbours
from .opening import judge_joints
from .pairs import RestingSolids, at_rest
from .penetration_report import report, told_parts
from .penetration_study import Contact, PairKind, PartPair, PenetrationStudy
from .result import CheckResult

#: Bases of the Halton sequence, one for each joint.
PRIMES = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53)

Ranges = Mapping[str, tuple[float, float]]


def check_penetration(
    description: Description, config: PenetrationConfig, most_looks: int = WorkConfig.looks
) -> CheckResult:
    """Measure every pair of parts at rest, along each joint's range and at combinations.

    Args:
        description: as read.
        config: limits, and steps of the sweep.
        most_looks: exact looks at two hulls, beyond which there is no verdict.

    Returns:
        ``rest_penetration``, ``sweep_penetration``, ``joint_obstructed`` (errors);
        ``hinge_overlap``, ``excluded_penetration``, ``joint_dependency``, ``joints_collide``,
        ``combination_penetration`` (warnings); ``joints_not_swept`` (note); and every
        number taken. Or ``too_large_to_judge`` alone.
    """
    tree = find_tree(description)
    if tree is None:
        # There is no pose to measure in, which the lint says.
        return CheckResult()
    try:
        return _measured(Solids(description, tree, LookBudget(most_looks)), config)
    except TooManyLooks:
        words = "exact looks do not tell how deep its parts penetrate each other"
        return CheckResult((beyond(words, most_looks + 1, most_looks),))


def _measured(solids: Solids, config: PenetrationConfig) -> CheckResult:
    tree = solids.tree
    rest = at_rest(solids, config)
    # Contacts are located as the solids are placed, which sweeps change.
    met = rest.worst(rest.standings, rest.lower)
    at_zero = _at_zero(rest)
    sweeps = judge_joints([joint for joint in tree.free if joint.name in tree.ranges], rest)
    study = PenetrationStudy(
        rest=met,
        zero=at_zero,
        sweeps=sweeps,
        neighbours=open_neighbours(rest, told_parts(sweeps, config)),
        combinations=_combinations(rest),
    )
    return report(Diagnosis(rest).explained(study), rest)


def _at_zero(rest: RestingSolids) -> tuple[Contact, ...] | None:
    """Return contacts in the pose of the file, where that is reachable and not rest."""
    reachable = all(low <= 0.0 <= rest.upper[name] for name, low in rest.lower.items())
    if not reachable or all(low == 0.0 for low in rest.lower.values()):
        return None
    rest.solids.place({})
    return rest.worst(rest.solids.standings(rest.config.clearance_m), {})


def _combinations(rest: RestingSolids) -> tuple[Contact, ...]:
    """Return how each pair of parts meets in the combination in which it is deepest beyond rest."""
    worst: dict[PartPair, Contact] = {}
    for values in combination_values(rest.solids.tree.ranges, rest.config.combinations):
        rest.solids.place(values)
        for pair, overlap in rest.solids.standings(0.0).items():
            if rest.kind(*pair) is not PairKind.PLAIN:
                continue
            key = rest.parts(*pair)
            if key not in worst or overlap.depth - rest.depth(*pair) > worst[key].excess:
                worst[key] = rest.contact(*pair, overlap.depth, values)
    return tuple(worst[key] for key in sorted(worst))


def combination_values(ranges: Ranges, count: int) -> list[dict[str, float]]:
    """Return all joints at upper, then ``count`` points of the Halton sequence over their ranges.

    With fewer than two joints there is nothing to combine.
    """
    if len(ranges) < 2:
        return []
    poses = [{name: upper for name, (_, upper) in ranges.items()}]
    for index in range(1, count + 1):
        pose = {}
        for column, (name, (lower, upper)) in enumerate(ranges.items()):
            prime = PRIMES[column % len(PRIMES)]
            # Joints that share a prime start at different places of its sequence.
            share = _radical_inverse(index + column // len(PRIMES), prime)
            pose[name] = lower + share * (upper - lower)
        poses.append(pose)
    return poses


def _radical_inverse(index: int, base: int) -> float:
    """Return the digits of ``index`` mirrored at the point, in [0, 1)."""
    value = 0.0
    scale = 1.0
    while index > 0:
        index, digit = divmod(index, base)
        scale /= base
        value += digit * scale
    return value
