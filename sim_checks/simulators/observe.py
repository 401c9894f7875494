"""One look at one file in one engine: load, poses, rest, sweep; runs inside a killable child."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..config import MotionConfig
from .catalog import simulator
from .chatter import captured_lines, timeless
from .drive import sweep
from .hold import hold
from .rest import fall, rest
from .simulator import JointValues, Observation, PoseSample
from .world import Groups, World


def observe(
    name: str,
    path: Path,
    config: MotionConfig,
    samples: tuple[JointValues, ...],
    apart: Groups = (),
) -> Observation:
    """Take all that the simulator checks need from a single load in an engine, by its name.

    Link poses are reported at the ``samples``; joints of a group of ``apart``, by name, may be
    driven at the same time.

    Raises:
        ValueError: if it does not load; with the loader's own words.
    """
    chatter: list[str] = []
    try:
        with captured_lines(chatter):
            world = simulator(name).open(path, config)
    except ValueError as error:
        lines = dict.fromkeys([str(error), *chatter])
        raise ValueError("\n".join(timeless(line, path) for line in lines)) from error
    said = tuple(timeless(line, path) for line in chatter)
    try:
        poses = tuple(_pose(world, values) for values in samples)
        alone = (rest(world, config), fall(world, config))
        motions = sweep(world, config, apart)
        holds = hold(world, motions, config, apart)
        return Observation(world.model, poses, *alone, motions, world.warnings(), holds, said)
    finally:
        world.close()


def _pose(world: World, values: JointValues) -> PoseSample:
    world.place(np.array([values.get(joint.name, 0.0) for joint in world.joints]))
    return PoseSample(values, world.link_poses())
