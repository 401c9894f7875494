"""Where a finding is: the pose in which it shows, and the point."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from asset_factory.sim_checks import Finding
from asset_factory.sim_checks.measurements import MeasuredContact, MeasuredJoint, penetrations

from ...display.pictures import Fault
from ...display.scene import SceneGraph, SceneJoint

#: Of a pair that is checked like any other.
PLAIN = "plain"


@dataclass(frozen=True)
class SweepMark:
    """The worst of a pair of links along a joint: at which value [rad] or [m], a gap [mm]."""

    at: float
    mm: float
    told: str


@dataclass(frozen=True)
class SweepTold:
    """What the validator measured along one joint.

    Attributes:
        marks: of the pairs that come near.
        open: values of the joints that have to be open for it [rad] or [m].
    """

    marks: tuple[SweepMark, ...] = ()
    open: Mapping[str, float] = field(default_factory=dict)


class Places:
    """The poses and points of an asset's findings."""

    def __init__(self, scene: SceneGraph, measurements: Mapping[str, Any]) -> None:
        self._joints = {joint.name: joint for joint in scene.movable}
        self._measured = penetrations(measurements)

    def of(self, finding: Finding) -> Fault | None:
        """Return where a finding is; ``None`` where nothing is known of that."""
        wanted = frozenset(finding.parts)
        for values, contact in self._contacts(finding.joint):
            if wanted and wanted == frozenset(contact.links) and _tells(finding, contact):
                return Fault(values, contact.point_m or None)
        joint = self._joints.get(finding.joint or "")
        return None if joint is None else Fault({joint.name: _value(finding, joint)}, None)

    def sweeps(self) -> dict[str, SweepTold]:
        """Return the measurements along each joint."""
        found = {}
        for measured in self._measured[:1]:
            for joint in measured.joints:
                way = joint.with_those_open or joint
                opened = self._opened(joint.needs_open if joint.with_those_open else ())
                marks = tuple(SweepMark(pair.at, -pair.depth_mm, _told(pair)) for pair in way.pairs)
                found[joint.joint] = SweepTold(marks, opened)
        return found

    def ignored(self) -> list[tuple[str, str]]:
        """Return pairs of links that may overlap: hinges, and what the file excludes."""
        contacts = (contact for measured in self._measured for contact in measured.contacts)
        return sorted({contact.links for contact in contacts if contact.kind != PLAIN})

    def clearance(self) -> float | None:
        """Return the smallest gap of any pair along any joint, negative for a depth [mm]."""
        gaps = [mark.mm for told in self.sweeps().values() for mark in told.marks]
        return min(gaps, default=None)

    def _contacts(self, joint: str | None) -> Iterator[tuple[Mapping[str, float], MeasuredContact]]:
        """Yield every measured contact with its pose; those along a named joint first."""
        for measured in self._measured:
            for each in measured.joints:
                if each.joint == joint:
                    yield from self._along(each)
            for near in measured.neighbours:
                if joint in (None, near.joint):
                    stands = {} if near.open_at is None else {near.open: near.open_at}
                    yield {near.joint: near.at, **self._opened((near.open,)), **stands}, near
            for tried in measured.combinations:
                yield tried.values, tried
            yield from (({}, contact) for contact in measured.rest)
            zero = dict.fromkeys(self._joints, 0.0)
            yield from ((zero, contact) for contact in measured.zero or ())

    def _along(self, joint: MeasuredJoint) -> Iterator[tuple[Mapping[str, float], MeasuredContact]]:
        yield from (({joint.joint: pair.at}, pair) for pair in joint.pairs)
        if joint.with_those_open is not None:
            opened = self._opened(joint.needs_open)
            for pair in joint.with_those_open.pairs:
                yield {joint.joint: pair.at, **opened}, pair

    def _opened(self, joints: Sequence[str]) -> dict[str, float]:
        return {name: self._joints[name].upper for name in joints if name in self._joints}


def _value(finding: Finding, joint: SceneJoint) -> float:
    """Return the joint's value that a finding speaks of, else where it is open."""
    told = finding.value if finding.unit == ("m" if joint.slides else "rad") else None
    return joint.upper if told is None or not joint.lower <= told <= joint.upper else told


def _tells(finding: Finding, contact: MeasuredContact) -> bool:
    """Return whether a contact may be what a finding speaks of, by its depth where it names one."""
    if finding.unit != "mm" or finding.value is None:
        return True
    depths = (contact.depth_mm, getattr(contact, "excess_mm", contact.depth_mm))
    return any(abs(depth - finding.value) < 0.01 for depth in depths)


def _told(contact: MeasuredContact) -> str:
    state = "apart" if contact.depth_mm < 0.0 else "into each other"
    return f"{' and '.join(contact.links)}: {abs(contact.depth_mm):.2f} mm {state}, as measured"
