"""Objects whose hinges were spoilt: how many come back, and whether on the true line.

    python benchmarks/broken_copies.py                        objects of the table of real ones
    python benchmarks/broken_copies.py --list FILE --every 1   of these inputs, one a line

The largest door, flap or lid of a sound object has its hinge flipped, tilted or shifted; each copy
is made, repaired and validated without simulators. One that passes about another line than the
true one is wrong, whatever else is right about it.
"""

from __future__ import annotations

import argparse
import csv
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from real_yield import DATA
from results_file import renew

from asset_factory.factory.articulate.standing import standing_hypotheses
from asset_factory.factory.articulation import Articulation, Joint, JointKind, rotation_about
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.intake.source import Source
from asset_factory.factory.part import PartKind
from asset_factory.factory.runtime.stages import Stages
from asset_factory.factory.verify.rounds import Rounds
from asset_factory.sim_checks.judge import Judge

TABLE = Path(__file__).with_name("real_objects.csv")
#: What is done to a hinge: turned round, tilted [deg], shifted [share of its part's diagonal].
FAULTS = ("flipped", "tilted 4", "tilted 10", "shifted 2", "shifted 5", "shifted 15")
#: A line is the true one within so much [deg], [share of its part's diagonal].
SAME_DEG = 0.1
SAME_SHARE = 0.01
#: Parts that close something.
PANELS = frozenset({PartKind.DOOR, PartKind.FLAP, PartKind.LID})
OUTCOMES = ("rejected", "mended", "as it was", "elsewhere")


def main() -> int:
    """Break, make and count; returns the exit code: 1 if a copy passes elsewhere."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=DATA, help="folder of data")
    parser.add_argument("--list", type=Path, help="a file of inputs, one a line, instead")
    parser.add_argument("--every", type=int, default=3, help="take one input of so many")
    options = parser.parse_args()
    found: dict[str, Counter[str]] = {fault: Counter() for fault in FAULTS}
    objects = 0
    for path in list(_inputs(options.data, options.list))[:: options.every]:
        counted = 0
        for fault, outcome in _outcomes(path):
            found[fault][outcome] += 1
            counted += 1
            print(f"{path.stem}: {fault}: {outcome}", flush=True)
        objects += counted > 0
    rows = [[fault, *(str(found[fault][each]) for each in OUTCOMES)] for fault in FAULTS]
    print(f"{objects} objects")
    renew("broken_copies", ("fault", *OUTCOMES), rows)
    return int(any(counts["elsewhere"] for counts in found.values()))


def _inputs(data: Path, listed: Path | None) -> Iterator[Path]:
    """Yield annotated inputs: those of a list, or those of the table that pass."""
    if listed is not None:
        yield from (Path(line) for line in listed.read_text().split())
        return
    with TABLE.open(newline="") as table:
        for row in csv.DictReader(table):
            if row["articulator"] == "annotated" and row["status"] == "passed":
                yield data / row["input"]


def _outcomes(path: Path) -> Iterator[tuple[str, str]]:
    """Yield faults and what becomes of an object's first hinge so spoilt, if it is sound."""
    config = replace(BuildConfig(), articulator="annotated", simulators=())
    stages = Stages(config, None)
    origin = Source(path, config)
    try:
        intake, (likeliest, *_) = standing_hypotheses(origin.load(), origin, stages)
    except InputRejected:
        return
    true = likeliest
    # What stands free, a knob or a lamp's arm, turns as well about any line.
    hinges = [
        joint
        for joint in true.movable_joints
        if joint.kind is JointKind.REVOLUTE and true.parts[joint.child].kind in PANELS
    ]
    if not hinges:
        return
    hinge = max(hinges, key=lambda joint: true.part_mesh(joint.child).diagonal)
    with Judge(config.checks) as judge:

        def made(tried: Articulation) -> Joint | None:
            with tempfile.TemporaryDirectory() as folder:
                try:
                    draft = Rounds(tried, intake, Path(folder), judge, stages).drafted()
                except InputRejected:
                    return None
                kept = {joint.name: joint for joint in draft.asset.articulation.movable_joints}
                return kept.get(hinge.name) if draft.passes else None

        sound = made(true)
        if sound is None:
            return
        size = true.part_mesh(hinge.child).diagonal
        for fault in FAULTS:
            spoilt = _spoilt(hinge, fault, size)
            joints = tuple(spoilt if each is hinge else each for each in true.joints)
            ended = made(replace(true, joints=joints))
            yield fault, _outcome(ended, sound, spoilt, size)


def _spoilt(hinge: Joint, fault: str, size: float) -> Joint:
    """Return a hinge with a fault; ``size`` is its part's diagonal [m]."""
    what, _, amount = fault.partition(" ")
    if what == "flipped":
        return replace(hinge, axis=-hinge.axis)
    across = np.cross(hinge.axis, np.eye(3)[int(np.abs(hinge.axis).argmin())])
    across /= np.linalg.norm(across)
    if what == "tilted":
        return replace(hinge, axis=rotation_about(across, np.radians(float(amount))) @ hinge.axis)
    return replace(hinge, origin=hinge.origin + float(amount) / 100.0 * size * across)


def _outcome(ended: Joint | None, true: Joint, spoilt: Joint, size: float) -> str:
    """Say what became of a hinge; the true one is as the sound object has it, mended or not."""
    if ended is None:
        return "rejected"
    if _is_line_of(ended, true, size):
        return "mended"
    return "as it was" if _is_line_of(ended, spoilt, size) else "elsewhere"


def _is_line_of(one: Joint, other: Joint, size: float) -> bool:
    """Tell whether two hinges are one line, and open the same way."""
    angle = np.degrees(np.arccos(np.clip(one.axis @ other.axis, -1.0, 1.0)))
    apart = one.origin - other.origin
    off = float(np.linalg.norm(apart - (apart @ other.axis) * other.axis))
    return bool(angle <= SAME_DEG) and off <= SAME_SHARE * size


if __name__ == "__main__":
    sys.exit(main())
