"""Can a joint that follows another do so?"""

from __future__ import annotations

from ..description import ABSURD, Description, JointLine, Mimic, sensible
from ..geometry.coupling import whole_chain
from ..geometry.kinematics import MOVING_KINDS, own_limits, sound_mimics, sweep_range, swept_ranges
from .result import Findings, about, error, graded, rounded

#: Limits written with few digits may miss what the leader asks by this share of the follower's
#: range.
ROUNDING = 1e-3


def mimic_findings(description: Description) -> Findings:
    """Yield errors without a leader or a way to go, warnings where a follower stops its leader."""
    moving = {joint.name: joint for joint in description.joints if joint.kind in MOVING_KINDS}
    sound = sound_mimics(description)
    ranges = swept_ranges(moving.values(), sound)
    for joint in description.joints:
        mimic = joint.mimic
        if mimic is None:
            continue
        follows = f"joint {joint.name!r} follows {mimic.leader!r}"
        if not sensible((mimic.multiplier, mimic.offset)):
            numbers = f"{mimic.multiplier} times its value plus {mimic.offset}"
            message = f"{follows} by {numbers}; want finite numbers up to {ABSURD:g}"
            yield error("mimic_not_finite", message, **about(joint))
        elif joint.name in sound:
            whole = whole_chain(joint.name, sound)
            stuck = whole.leader not in ranges
            yield from _limit_findings(joint, moving[whole.leader], whole, stuck)
        elif joint.kind in MOVING_KINDS:
            message = f"{follows}, {_fault(joint, mimic, moving)}"
            yield error("mimic_unknown", message, **about(joint))


def _fault(joint: JointLine, mimic: Mimic, moving: dict[str, JointLine]) -> str:
    if mimic.leader == joint.name:
        return "which is itself; want another joint that moves"
    if mimic.leader not in moving:
        return "and no joint of that name moves; want one that does"
    return "whose own leaders lead nowhere or in a circle; want a chain that ends at a free joint"


def _limit_findings(joint: JointLine, leader: JointLine, mimic: Mimic, stuck: bool) -> Findings:
    led = sweep_range(leader)
    own = own_limits(joint)
    if led is None or own is None:
        # Limits that are none, or in the wrong order, have findings of their own.
        return
    asked = sorted(mimic.multiplier * end + mimic.offset for end in led)
    beyond = max(own[0] - asked[0], asked[1] - own[1])
    if beyond > ROUNDING * (own[1] - own[0]):
        unit = joint.unit
        message = (
            f"joint {joint.name!r} may move from {own[0]:g} to {own[1]:g} {unit}, "
            f"but the range of {leader.name!r}, which it follows, "
            f"takes it from {asked[0]:g} to {asked[1]:g}: {beyond:.4g} {unit} too far"
        )
        if stuck:
            all_led = f"all that move with {leader.name!r}"
            message += f"; nowhere are {all_led} within their limits, so none can"
        yield graded(stuck, "mimic_limits", message, **about(joint), **rounded(beyond, unit, 0.0))
