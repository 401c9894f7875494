"""One look at one file in one engine: load, poses, rest, sweep; runs inside a killable child."""

from __future__ import annotations

import os
import re
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..config import MotionConfig
from .catalog import simulator
from .drive import sweep
from .hold import hold
from .joints import Groups
from .rest import fall, rest
from .simulator import JointValues, Observation, PoseSample, World

#: Longest part of a loader's chatter that is kept [lines].
MOST_LINES = 40
#: Bullet's messages start with where in its source they were written, and often end without a new
#: line.
BULLET_PREFIX = r"b3(?:Warning|Printf|Error)\[[^\]]*\]:\s*"
#: In lines that an engine writes whatever the file, or that quote its source.
CHATTER = ("build time", "Failed to find system libvulkan", "warn(", "= spec.compile()")


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
        raise ValueError("\n".join(_timeless(line, path) for line in lines)) from error
    said = tuple(_timeless(line, path) for line in chatter)
    try:
        poses = tuple(_pose(world, values) for values in samples)
        alone = rest(world, config)
        falling = fall(world, config)
        motions = sweep(world, config, apart)
        holds = hold(world, motions, config, apart)
        model = replace(world.model, warnings=said)
        return Observation(model, poses, alone, falling, motions, world.warnings(), holds)
    finally:
        world.close()


def _pose(world: World, values: JointValues) -> PoseSample:
    world.place(np.array([values.get(joint.name, 0.0) for joint in world.joints]))
    return PoseSample(values, world.link_poses())


@contextmanager
def captured_lines(lines: list[str]) -> Iterator[None]:
    """Collect what native code writes to stdout and stderr meanwhile, each line once."""
    sys.stdout.flush()
    sys.stderr.flush()
    kept = [os.dup(1), os.dup(2)]
    with tempfile.TemporaryFile() as file:
        try:
            os.dup2(file.fileno(), 1)
            os.dup2(file.fileno(), 2)
            yield
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            for descriptor, saved in zip((1, 2), kept, strict=True):
                os.dup2(saved, descriptor)
                os.close(saved)
            file.seek(0)
            text = file.read().decode("utf-8", "replace")
            found = (line.strip() for line in re.sub(BULLET_PREFIX, "\n", text).splitlines())
            told = (line for line in found if line and not any(word in line for word in CHATTER))
            lines.extend(list(dict.fromkeys(told))[:MOST_LINES])


def _timeless(line: str, path: Path) -> str:
    """Return the line without clock, temporary folder, place in the code and machine."""
    line = re.sub(r"^\S+\.py:\d+: (\w+Warning: )?", "", line)
    line = re.sub(r"^\[\d{4}-\d\d-\d\d [^\]]*\]\s*", "", line)
    line = re.sub(r"[^\s\"'\[(]*/twin-[^/\s]+/", "", line)
    return line.replace(f"{path.parent.resolve()}/", "")
