"""Parts that penetrate each other, at rest or on their way."""

import numpy as np

from .exhibits import ENGINES, Exhibit, both, edited, mjcf, urdf
from .good_things import BOARD, GAP, cabinet, oven
from .things import Body, Move, Thing, at, box, with_body, with_move


def screw_in_the_way(at_value: float = 0.2017, width: float = 0.002) -> Thing:
    """A drawer with a 2 mm pin on its side, a wall with a 1 mm fin; they meet at one value only."""
    thing = cabinet()
    shell, tub, *_ = (body.pieces for body in thing.bodies)
    # The pin stands 3 mm out into the 4 mm gap; the fin reaches 3 mm into it from the other side.
    pin = box((-0.2795, 0.3, 0.15), (0.005, width, width))
    fin = box((-0.2805, 0.3 - at_value, 0.15), (0.003, 0.001, 0.1))
    walled = with_body(thing, "carcass", pieces=(*shell, fin))
    return with_body(walled, "drawer", pieces=(*tub, pin))


def wall_in_front() -> Thing:
    """A post of the same body stands 0.2 m before the drawer, which wants 0.3 m."""
    thing = cabinet()
    post = box((0.0, -0.25, 0.15), (0.1, 0.02, 0.3))
    return with_body(thing, "carcass", pieces=(*thing.bodies[0].pieces, post))


def deadlock() -> Thing:
    """Two sliding blocks, each with a tab in the other's way: either opens only after the other."""
    floor = box((0.0, 0.0, -0.05), (1.2, 1.2, 0.02))
    first = (
        box((0.0, 0.0, 0.1), (0.1, 0.1, 0.1)),
        box((0.0, 0.0, 0.2), (0.1, 0.02, 0.1)),
        box((-0.04, 0.1, 0.24), (0.02, 0.2, 0.02)),
    )
    second = (box((0.15, 0.0, 0.1), (0.1, 0.1, 0.1)), box((0.15, 0.0, 0.19), (0.1, 0.02, 0.08)))
    hook = box((0.0, 0.25, 0.24), (0.1, 0.02, 0.02))
    arm = box((0.1, 0.25, 0.2), (0.1, 0.02, 0.1))
    foot = box((0.15, 0.125, 0.12), (0.1, 0.27, 0.02))
    bodies = (
        Body("floor", (floor,), at(0, 0, 0), 5.0),
        Body("first", first, at(0, 0, 0.1), 1.0),
        Body("second", (*second, foot, arm, hook), at(0.15, 0, 0.1), 1.0),
    )
    moves = (
        Move("along_x", "prismatic", "floor", "first", (1.0, 0.0, 0.0), 0.0, 0.4),
        Move("along_y", "prismatic", "floor", "second", (0.0, -1.0, 0.0), 0.0, 0.4),
    )
    return Thing("deadlock", bodies, moves)


def crossing() -> Thing:
    """Two drawers in two faces of a corner cabinet that meet only when both are open."""
    bodies = (
        Body("base", (box((0.0, 0.0, -0.2), (1.0, 1.0, 0.02)),), at(0, 0, 0), 10.0),
        Body("left", (box((-0.4, 0.1, 0.0), (0.2, 0.2, 0.1)),), at(-0.4, 0.1, 0.0), 1.0),
        Body("right", (box((0.1, -0.4, 0.0), (0.2, 0.2, 0.1)),), at(0.1, -0.4, 0.0), 1.0),
    )
    moves = (
        Move("left_slide", "prismatic", "base", "left", (1.0, 0.0, 0.0), 0.0, 0.45),
        Move("right_slide", "prismatic", "base", "right", (0.0, 1.0, 0.0), 0.0, 0.45),
    )
    return Thing("crossing", bodies, moves)


def flap_over_drawer() -> Thing:
    """A flap that drops to 126 degrees before a chest; any drawer under it that is out stops it."""
    bodies = (
        Body("chest", (box((0.0, 0.3, 0.2), (0.5, 0.6 - 2 * GAP, 0.4)),), at(0, 0, 0), 30.0),
        Body("flap", (box((0.0, -0.01, 0.2), (0.5, 0.02, 0.4)),), at(0, -0.02, 0.0), 3.0),
        Body("drawer", (box((0.0, 0.2, -0.1 - GAP), (0.5, 0.44, 0.2)),), at(0, 0, -0.1), 3.0),
    )
    moves = (
        Move("drop", "revolute", "chest", "flap", (1.0, 0.0, 0.0), 0.0, 2.2),
        Move("slide", "prismatic", "chest", "drawer", (0.0, -1.0, 0.0), 0.0, 0.4),
    )
    return Thing("flap_over_drawer", bodies, moves)


def knuckle(length: float) -> Thing:
    """A door beside a frame; its hinge's leaves overlap for some of the door's 0.6 m [m]."""
    frame = (
        box((-0.06, 0.0, 0.0), (0.06, 0.1, 0.8)),
        box((-0.005, 0.0, 0.0), (0.05, 0.012, length)),
    )
    door = (box((0.25, 0.0, 0.0), (0.4, BOARD, 0.6)), box((0.025, 0.0, 0.0), (0.05, 0.012, length)))
    bodies = (Body("frame", frame, at(0, 0, 0), 5.0), Body("door", door, at(0, 0, 0), 2.0))
    return Thing(
        "knuckle", bodies, (Move("hinge", "revolute", "frame", "door", (0.0, 0.0, 1.0), 0.0, 0.1),)
    )


def _longer(tub: tuple[np.ndarray, ...], more: float) -> tuple[np.ndarray, ...]:
    """The drawer with its back moved further in [m]."""
    return tuple(np.where(piece > 0.3, np.add(piece, (0.0, more, 0.0)), piece) for piece in tub)


def _shifted(thing: Thing, index: int, by: tuple[float, float, float]) -> Thing:
    """The thing with one body elsewhere, frame and all [m]."""
    body = thing.bodies[index]
    pieces = tuple(np.add(piece, by) for piece in body.pieces)
    return with_body(thing, body.name, pieces=pieces, frame=at(*by) @ body.frame)


CABINET = cabinet()
SHELL, TUB, (DOOR,), _ = (body.pieces for body in CABINET.bodies)
WIDE = (*(piece * [0.574 / 0.556, 1.0, 1.0] for piece in TUB[:-1]), TUB[-1])
LOW = DOOR + np.where(DOOR[:, 2:] < 0.4, [[0.0, 0.0, -0.012]], [[0.0, 0.0, 0.0]])
LONG = with_body(CABINET, "drawer", pieces=_longer(TUB, 0.013 + 2 * GAP))
FILLED = with_body(CABINET, "carcass", pieces=(np.vstack(SHELL),), looks=SHELL)
EXCLUDE = '<contact><exclude body1="drawer" body2="carcass"/></contact></mujoco>'
WIDER = with_body(CABINET, "drawer", pieces=tuple(piece * [1.03, 1.0, 1.0] for piece in TUB))
EXCLUDED = edited(mjcf(WIDER), ("</mujoco>", EXCLUDE))
ASKEW = (0.0, float(np.sin(0.1)), -float(np.cos(0.1)))
ALL_JAM = dict.fromkeys(ENGINES, "jammed")
REST = "rest_penetration"
SWEEP = "sweep_penetration"
BROKEN = (
    # Parts that overlap with everything closed.
    *both("drawer_too_wide", with_body(CABINET, "drawer", pieces=WIDE), REST),
    *both("drawer_too_long", LONG, REST, mujoco="pushed_at_rest"),
    *both("fronts_overlap", with_body(CABINET, "door", pieces=(LOW,)), REST),
    *both("cavity_filled", FILLED, "interior_filled"),
    *both("door_10_cm_inside", _shifted(CABINET, 2, (0.0, 0.1, 0.0)), REST),
    # Nothing overlaps closed; opening makes parts penetrate.
    *both("hinge_opens_inwards", with_move(CABINET, "hinge", axis=(0.0, 0.0, 1.0)), SWEEP),
    *both("drawer_opens_backwards", with_move(CABINET, "slide", axis=(0.0, 1.0, 0.0)), SWEEP),
    *both("drawer_moves_sideways", with_move(CABINET, "slide", axis=(1.0, 0.0, 0.0)), SWEEP),
    *both("hinge_inside_the_door", with_body(CABINET, "door", frame=at(-0.25, -GAP, 0.5)), SWEEP),
    *both("lid_turns_too_far", with_move(CABINET, "flap", upper=4.5), SWEEP),
    *both("door_turns_too_far", with_move(CABINET, "hinge", upper=5.5), SWEEP),
    *both("screw_in_the_way", screw_in_the_way(), SWEEP),
    *both("wall_in_front", wall_in_front(), SWEEP),
    *both("flap_on_an_open_drawer", flap_over_drawer(), "joint_obstructed"),
    Exhibit("each_bars_the_other.urdf", urdf(deadlock()), SWEEP, engines=ALL_JAM),
    Exhibit("each_bars_the_other.mjcf", mjcf(deadlock()), SWEEP, engines={"mujoco": "jammed"}),
    # Nothing ever meets anything, because it moves where nothing is, or not at all.
    *both("hinge_far_away", with_body(CABINET, "door", frame=at(-0.3, -2.0, 0.5)), "axis_remote"),
    *both("hinge_askew", with_move(CABINET, "hinge", axis=ASKEW), "axis_oblique"),
    *both("lid_next_door", _shifted(CABINET, 3, (30.0, 0.0, 0.0)), "part_remote"),
    *both("lid_in_the_air", _shifted(CABINET, 3, (0.0, 0.0, 0.3)), "part_detached"),
    *both("drawer_leaves", with_move(CABINET, "slide", upper=3.0), "range_implausible"),
    *both("hardly_a_range", with_move(CABINET, "slide", upper=1e-4), "range_tiny", "warning"),
    # Reported, and no reason to reject.
    *both("rack_behind_a_door", oven(), "joint_dependency", "warning"),
    *both("both_open", crossing(), "joints_collide", "warning"),
    # Nothing in the file tells the engines that this overlap is a knuckle.
    *both("knuckle", knuckle(0.05), "hinge_overlap", "warning", mujoco="jammed"),
    *both("knuckle_too_long", knuckle(0.5), REST),
    Exhibit("excluded_overlap.mjcf", EXCLUDED, "excluded_penetration", "warning"),
)
