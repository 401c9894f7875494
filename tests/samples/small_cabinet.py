"""A carcass with a drawer above a door, of boxes, as URDF and MJCF; a good one and broken ones."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from fault_corpus.exhibits import edited, mjcf, urdf
from fault_corpus.things import Body, Move, Thing, at, box

from asset_factory.sim_checks.checks.result import CheckResult
from asset_factory.sim_checks.report import Report, Severity


def part(
    name: str, mass: float, origin: Sequence[float], *boxes: Sequence[Sequence[float]]
) -> Body:
    """A body of boxes, each by its centre and size [m], in the base's frame with joints at 0."""
    return Body(name, tuple(box(*each) for each in boxes), at(*origin), mass)


#: Front is -x, gaps are 5 mm.
CABINET = Thing(
    "cabinet",
    (
        part(
            "carcass",
            20.0,
            (0.0, 0.0, 0.0),
            ((0.191, 0.0, 0.4), (0.018, 0.6, 0.8)),
            ((0.0, -0.291, 0.4), (0.4, 0.018, 0.8)),
            ((0.0, 0.291, 0.4), (0.4, 0.018, 0.8)),
            ((0.0, 0.0, 0.791), (0.4, 0.6, 0.018)),
            ((0.0, 0.0, 0.4), (0.4, 0.6, 0.018)),
            ((0.0, 0.0, 0.009), (0.4, 0.6, 0.018)),
        ),
        part("drawer", 3.0, (-0.2, 0.0, 0.6), ((-0.015, 0.0, 0.5955), (0.37, 0.554, 0.363))),
        part("door", 2.0, (-0.223, -0.295, 0.2), ((-0.214, 0.0, 0.2), (0.018, 0.59, 0.38))),
    ),
    (
        Move("slide", "prismatic", "carcass", "drawer", (-1.0, 0.0, 0.0), 0.0, 0.3),
        Move("hinge", "revolute", "carcass", "door", (0.0, 0.0, 1.0), 0.0, 1.57),
    ),
)
#: Nothing holds its parts.
LOOSE = replace(CABINET, moves=())


def stopped(thing: Thing = CABINET) -> Thing:
    """The cabinet with something before the drawer, which it stops."""
    stopper = part("stopper", 1.0, (-0.3, 0.0, 0.6), ((-0.31, 0.0, 0.6), (0.02, 0.5, 0.3)))
    weld = Move("stopper_joint", "fixed", "carcass", "stopper", (1.0, 0.0, 0.0), 0.0, 0.0)
    return replace(thing, bodies=(*thing.bodies, stopper), moves=(*thing.moves, weld))


def write_urdf(
    folder: Path, thing: Thing = CABINET, replace: Mapping[str, str] | None = None
) -> Path:
    """Write it as URDF; ``replace`` edits its text, and must find what it replaces."""
    return edited(urdf(thing), *(replace or {}).items(), count=-1)(folder)


def write_mjcf(folder: Path) -> Path:
    return mjcf(CABINET)(folder)


def write_lid(folder: Path) -> Path:
    """A 20 kg lid with damping and friction, without collision shapes, opening upwards."""
    path = folder / "lid.urdf"
    path.write_text(
        """<robot name="chest"><link name="chest"/><link name="lid"><inertial>
        <origin xyz="0.3 0 0"/><mass value="20"/>
        <inertia ixx="0.4" iyy="0.7" izz="1.0" ixy="0.01" ixz="0.02" iyz="0.03"/></inertial></link>
        <joint name="hinge" type="revolute"><parent link="chest"/><child link="lid"/>
        <origin xyz="0 0 0.5"/><axis xyz="0 -1 0"/>
        <limit lower="0" upper="1.57" effort="1" velocity="1"/>
        <dynamics damping="1.5" friction="2.0"/></joint></robot>"""
    )
    return path


def codes(result: CheckResult | Report, severity: Severity = Severity.ERROR) -> list[str]:
    return [finding.code for finding in result.findings if finding.severity is severity]


def rows(result: CheckResult) -> dict[str, Any]:
    """What was measured of each joint, by its name."""
    return {row["joint"]: row for row in result.measurements["joints"]}


def motion_of(result: CheckResult, joint: str) -> dict[str, float]:
    return next(m for m in result.measurements["motion"]["joints"] if m["joint"] == joint)
