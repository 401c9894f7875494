"""Parts that penetrate each other, at rest or on their way."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from .exhibits import ENGINES, Exhibit, both, edited, mjcf
from .good_things import BOARD, GAP, cabinet, oven
from .things import Body, Move, Thing, at, box, shifted, with_body, with_move


def overlapping() -> Iterator[Exhibit]:
    """Parts that overlap with everything closed."""
    thing = cabinet()
    tub = thing.bodies[1].pieces
    shell = thing.bodies[0].pieces
    door = thing.bodies[2].pieces[0]
    wide = tuple(piece * [0.574 / 0.556, 1.0, 1.0] for piece in tub[:-1])
    long = _longer(tub, 0.013 + 2 * GAP)
    low = door + np.where(door[:, 2:] < 0.4, [[0.0, 0.0, -0.012]], [[0.0, 0.0, 0.0]])
    too_wide = with_body(thing, "drawer", pieces=(*wide, tub[-1]))
    yield from both("drawer_too_wide", too_wide, "rest_penetration")
    too_long = with_body(thing, "drawer", pieces=long)
    for exhibit in both("drawer_too_long", too_long, "rest_penetration"):
        yield replace(exhibit, engines={"mujoco": "pushed_at_rest"})
    yield from both("fronts_overlap", with_body(thing, "door", pieces=(low,)), "rest_penetration")
    filled = with_body(thing, "carcass", pieces=(np.vstack(shell),), looks=shell)
    yield from both("cavity_filled", filled, "interior_filled")
    yield from both("door_10_cm_inside", _shifted(thing, 2, (0.0, 0.1, 0.0)), "rest_penetration")


def colliding() -> Iterator[Exhibit]:
    """Nothing overlaps closed; opening makes parts penetrate."""
    thing = cabinet()
    for name, blocked in (
        ("hinge_opens_inwards", with_move(thing, "hinge", axis=(0.0, 0.0, 1.0))),
        ("drawer_opens_backwards", with_move(thing, "slide", axis=(0.0, 1.0, 0.0))),
        ("drawer_moves_sideways", with_move(thing, "slide", axis=(1.0, 0.0, 0.0))),
        ("hinge_inside_the_door", with_body(thing, "door", frame=at(-0.25, -GAP, 0.5))),
        ("lid_turns_too_far", with_move(thing, "flap", upper=4.5)),
        ("door_turns_too_far", with_move(thing, "hinge", upper=5.5)),
        ("screw_in_the_way", screw_in_the_way()),
        ("wall_in_front", wall_in_front()),
    ):
        yield from both(name, blocked, "sweep_penetration")
    yield from both("flap_on_an_open_drawer", flap_over_drawer(), "joint_obstructed")
    for exhibit in both("each_bars_the_other", deadlock(), "sweep_penetration"):
        heard = ("mujoco",) if exhibit.name.endswith("mjcf") else ENGINES
        yield replace(exhibit, engines=dict.fromkeys(heard, "jammed"))


def astray() -> Iterator[Exhibit]:
    """Nothing ever meets anything, because it moves where nothing is, or not at all."""
    thing = cabinet()
    far = with_body(thing, "door", frame=at(-0.3, -2.0, 0.5))
    yield from both("hinge_far_away", far, "axis_remote")
    yield from both("lid_next_door", _shifted(thing, 3, (30.0, 0.0, 0.0)), "part_remote")
    yield from both("lid_in_the_air", _shifted(thing, 3, (0.0, 0.0, 0.3)), "part_detached")
    yield from both("drawer_leaves", with_move(thing, "slide", upper=3.0), "range_implausible")
    short = with_move(thing, "slide", upper=1e-4)
    yield from both("hardly_a_range", short, "range_tiny", "warning")


def meeting() -> Iterator[Exhibit]:
    """What is reported and does not reject."""
    yield from both("rack_behind_a_door", oven(), "joint_dependency", "warning")
    yield from both("both_open", crossing(), "joints_collide", "warning")
    # Nothing in the file tells the engines that this overlap is a knuckle.
    for exhibit in both("knuckle", knuckle(0.05), "hinge_overlap", "warning"):
        yield replace(exhibit, engines={"mujoco": "jammed"})
    yield from both("knuckle_too_long", knuckle(0.5), "rest_penetration")
    exclude = '<contact><exclude body1="drawer" body2="carcass"/></contact></mujoco>'
    tub = tuple(piece * [1.03, 1.0, 1.0] for piece in cabinet().bodies[1].pieces)
    wide = edited(mjcf(with_body(cabinet(), "drawer", pieces=tub)), ("</mujoco>", exclude))
    yield Exhibit("excluded_overlap.mjcf", wide, "excluded_penetration", "warning")


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
    base = box((0.0, 0.0, -0.2), (1.0, 1.0, 0.02))
    left = box((-0.4, 0.1, 0.0), (0.2, 0.2, 0.1))
    right = box((0.1, -0.4, 0.0), (0.2, 0.2, 0.1))
    bodies = (
        Body("base", (base,), at(0, 0, 0), 10.0),
        Body("left", (left,), at(-0.4, 0.1, 0.0), 1.0),
        Body("right", (right,), at(0.1, -0.4, 0.0), 1.0),
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
    return tuple(np.where(piece > 0.3, shifted(piece, 0.0, more, 0.0), piece) for piece in tub)


def _shifted(thing: Thing, index: int, by: tuple[float, float, float]) -> Thing:
    """The thing with one body elsewhere, frame and all [m]."""
    body = thing.bodies[index]
    frame = body.frame.copy()
    frame[:3, 3] += by
    pieces = tuple(piece + np.array(by) for piece in body.pieces)
    return with_body(thing, body.name, pieces=pieces, frame=frame)
