"""Joints left alone part-way open, under gravity, where friction should hold them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..config import MotionConfig
from ..description import FloatArray
from .drive import arrived
from .rest import left_alone
from .simulator import HoldMotion, JointMotion
from .world import Groups, World

#: Shares of the range at which a joint is left alone, in from the limits.
SHARES = (0.25, 0.5, 0.75)


def hold(
    world: World, motions: tuple[JointMotion, ...], config: MotionConfig, apart: Groups = ()
) -> tuple[HoldMotion, ...]:
    """Leave every joint that opened alone at three values of its range, the others balanced.

    Of the ``motions`` that :func:`~.drive.sweep` saw, those that others must be open for are left
    alone with these at upper, the rest at lower. Joints of a group of ``apart``, by name, cannot
    reach one another; they are left alone at the same time.

    Returns:
        One for each value at which the engine has friction that should hold the joint. Joints that
        move with others are left out, and so are poses where the engine itself feels a load near
        or beyond the friction, from weight or a spring.
    """
    numbers = {joint.name: i for i, joint in enumerate(world.joints)}
    asked = {
        numbers[motion.joint]: motion
        for motion in motions
        if arrived(motion, config)
        and len(world.companions(numbers[motion.joint])) == 1
        and world.joints[numbers[motion.joint]].friction
    }
    free = {i: motion.joint for i, motion in asked.items() if not motion.needs_open}
    together = [[i for i, joint in free.items() if joint in names] for names in apart]
    alone = [[i] for i in asked.keys() - {i for group in together for i in group}]
    needs = {i: [numbers[name] for name in motion.needs_open] for i, motion in asked.items()}
    found = {
        (numbers[held.joint], share): held
        for group in (*together, *alone)
        if group
        # Those of a larger group need none.
        for share, held in _held(world, group, needs[group[0]], config)
    }
    return tuple(found[i, share] for i in asked for share in SHARES if (i, share) in found)


def _held(
    world: World, group: list[int], opened: list[int], config: MotionConfig
) -> Iterator[tuple[float, HoldMotion]]:
    span = world.span
    start = world.standing_open(opened)
    friction = np.array([world.joints[i].friction for i in group], np.float64)
    for share in SHARES:
        start[group] = span.lower[group] + share * span.travel[group]
        world.place(start)
        light = np.abs(world.balance()[group]) <= config.hold_share * friction
        held = [index for index, is_light in zip(group, light, strict=True) if is_light]
        if held:
            yield from ((share, motion) for motion in _left_at(world, held, start, config))


def _left_at(
    world: World, held: list[int], start: FloatArray, config: MotionConfig
) -> Iterator[HoldMotion]:
    def balance() -> FloatArray:
        forces = world.balance()
        forces[held] = 0.0
        return forces

    moved = np.zeros(len(start))
    for position, _ in left_alone(world, config.held_s, config, balance):
        moved = np.maximum(moved, np.abs(position - start))
    values = {joint.name: float(value) for joint, value in zip(world.joints, start, strict=True)}
    finite = world.is_finite()
    for index in held:
        pressed = world.pressing(index) if finite else None
        yield HoldMotion(world.joints[index].name, values, float(moved[index]), finite, pressed)
