"""Joints left alone part-way open, under gravity, where friction should hold them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..config import MotionConfig
from ..description import FloatArray
from .drive import arrived
from .joints import Ranges, companions, ranges
from .rest import left_alone
from .simulator import HoldMotion, JointMotion, World
from .touching import pressing

#: Shares of the range at which a joint is left alone, in from the limits.
SHARES = (0.25, 0.5, 0.75)


def hold(
    world: World, motions: tuple[JointMotion, ...], config: MotionConfig
) -> tuple[HoldMotion, ...]:
    """Leave every joint that opened alone at three values of its range, the others balanced.

    Args:
        world: a loaded asset.
        motions: of its joints, from :func:`~.drive.sweep`; those that others must be open for
            are left alone with these at upper, the rest at lower.
        config: how long, and how strong friction must be beside the load.

    Returns:
        One for each value at which the engine has friction that should hold the joint. Joints that
        move with others are left out, and so are poses where the engine itself feels a load near
        or beyond the friction, from weight or a spring.
    """
    span = ranges(world)
    numbers = {joint.name: i for i, joint in enumerate(world.joints)}
    return tuple(
        held
        for motion in motions
        if arrived(motion, config) and len(companions(world, numbers[motion.joint])) == 1
        for held in _held(world, numbers[motion.joint], _start(world, motion, span), span, config)
    )


def _start(world: World, motion: JointMotion, span: Ranges) -> FloatArray:
    """Return where the other joints stand [rad] or [m], shape [joint_count]."""
    start = span.lower.copy()
    for i, joint in enumerate(world.joints):
        if joint.name in motion.needs_open:
            together = sorted(companions(world, i))
            start[together] = span.upper[together]
    return start


def _held(
    world: World, index: int, start: FloatArray, span: Ranges, config: MotionConfig
) -> Iterator[HoldMotion]:
    friction = world.joints[index].friction
    if not friction:
        return
    for share in SHARES:
        start[index] = span.lower[index] + share * span.travel[index]
        world.place(start)
        if abs(float(world.balance()[index])) <= config.hold_share * friction:
            yield _left_at(world, index, start, config)


def _left_at(world: World, index: int, start: FloatArray, config: MotionConfig) -> HoldMotion:
    def balance() -> FloatArray:
        forces = world.balance()
        forces[index] = 0.0
        return forces

    moved = 0.0
    finite = True
    for position, _ in left_alone(world, config.held_s, config, balance):
        finite = bool(np.isfinite(position).all())
        if not finite:
            break
        moved = max(moved, abs(float(position[index] - start[index])))
    values = {joint.name: float(value) for joint, value in zip(world.joints, start, strict=True)}
    pressed = pressing(world, index) if finite else None
    return HoldMotion(world.joints[index].name, values, moved, finite, pressed)
