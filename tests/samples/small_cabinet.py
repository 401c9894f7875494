"""A carcass with a drawer above a door, of boxes, as URDF and MJCF; a good one and broken ones."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fault_corpus.exhibits import edited, mjcf, urdf
from fault_corpus.things import Body, Move, Thing, at, box

from asset_factory.sim_checks.checks.result import CheckResult
from asset_factory.sim_checks.report import Report, Severity

Boxes = tuple[tuple[tuple[float, float, float], tuple[float, float, float]], ...]

#: Centre and size [m] of every box, in the base's frame with all joints at 0; front is -x, gaps are
#: 5 mm.
PARTS: Mapping[str, Boxes] = {
    "carcass": (
        ((0.191, 0.0, 0.4), (0.018, 0.6, 0.8)),
        ((0.0, -0.291, 0.4), (0.4, 0.018, 0.8)),
        ((0.0, 0.291, 0.4), (0.4, 0.018, 0.8)),
        ((0.0, 0.0, 0.791), (0.4, 0.6, 0.018)),
        ((0.0, 0.0, 0.4), (0.4, 0.6, 0.018)),
        ((0.0, 0.0, 0.009), (0.4, 0.6, 0.018)),
    ),
    "drawer": (((-0.015, 0.0, 0.5955), (0.37, 0.554, 0.363)),),
    "door": (((-0.214, 0.0, 0.2), (0.018, 0.59, 0.38)),),
}
MASSES = {"carcass": 20.0, "drawer": 3.0, "door": 2.0, "stopper": 1.0}
ORIGINS = {"drawer": (-0.2, 0.0, 0.6), "door": (-0.223, -0.295, 0.2), "stopper": (-0.3, 0.0, 0.6)}
MOVES = {
    "drawer": ("slide", "prismatic", (-1.0, 0.0, 0.0), 0.3),
    "door": ("hinge", "revolute", (0.0, 0.0, 1.0), 1.57),
    "stopper": ("stopper_joint", "fixed", (1.0, 0.0, 0.0), 0.0),
}


def cabinet(parts: Mapping[str, Boxes] = PARTS, *, joints: bool = True) -> Thing:
    """The cabinet, with other parts or without what holds them."""
    bodies = []
    for name, boxes in parts.items():
        pieces = tuple(box(*each) for each in boxes)
        bodies.append(Body(name, pieces, at(*ORIGINS.get(name, (0, 0, 0))), MASSES[name]))
    moves = [
        Move(name, kind, "carcass", child, axis, 0.0, upper)
        for child, (name, kind, axis, upper) in MOVES.items()
        if child in parts and joints
    ]
    return Thing("cabinet", tuple(bodies), tuple(moves))


def write_urdf(
    folder: Path,
    parts: Mapping[str, Boxes] = PARTS,
    replace: Mapping[str, str] | None = None,
    *,
    joints: bool = True,
) -> Path:
    """Write it as URDF; ``replace`` edits its text, and must find what it replaces."""
    made = urdf(cabinet(parts, joints=joints))
    return edited(made, *(replace or {}).items(), count=-1)(folder)


def write_mjcf(folder: Path) -> Path:
    return mjcf(cabinet())(folder)


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
