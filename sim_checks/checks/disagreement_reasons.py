"""Why engines disagree: known traits of each, held against the judge's own depths and gaps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..report import Finding

UNKNOWN = "unknown"
PASS = "pass"  # noqa: S105 - a verdict
TITLES = {"sapien": "SAPIEN", "mujoco": "MuJoCo", "pybullet": "PyBullet"}
#: Depths and growths below this are touch, not overlap [mm].
TOUCH_MM = 0.01
#: Bullet's margin around one mesh hull; primitives have none [mm].
BULLET_MARGIN_MM = 1.0
#: A nameless primitive goes by its kind; everything else is a mesh.
PRIMITIVES = frozenset({"box", "capsule", "cylinder", "ellipsoid", "sphere"})
#: Overlap that MuJoCo's soft contacts were seen to give way to without stopping a joint [mm].
SOFT_CONTACT_MM = 0.5
#: Share of the range beyond which a passed limit is no spring's doing.
SOFT_LIMIT_SHARE = 0.2
TOUCHING_QUESTIONS = frozenset({"opens", "returns", "rests", "leaves_others", "keeps_limits"})


@dataclass(frozen=True)
class EngineEvidence:
    """Everything known of an asset.

    Attributes:
        findings, measurements: of all checks, as in a report.
        simulators: who was asked, in order.
    """

    findings: Sequence[Finding]
    measurements: Mapping[str, Any]
    simulators: Sequence[str]

    def said(self, simulator: str, check: str) -> Mapping[str, Any]:
        """The measurements of ``loading`` or ``motion``; empty if the engine got no further."""
        found: Mapping[str, Any] = self.measurements.get(simulator, {}).get(check, {})
        return found

    def answer(self, simulator: str, codes: frozenset[str], joint: str | None = None) -> str:
        """``pass``, or the first of these codes among the engine's findings (on one joint).

        All joints count where none is named.
        """
        for finding in self.findings:
            concerned = finding.simulator == simulator and joint in (None, finding.joint)
            if concerned and finding.code in codes:
                return finding.code
        return PASS

    def sweeps(self, joint: str | None) -> Iterator[Mapping[str, Any]]:
        """Yield what was measured along one joint's way."""
        for sweep in self.measurements.get("penetration", {}).get("joints", ()):
            if sweep["joint"] == joint:
                yield sweep


@dataclass(frozen=True)
class Dispute:
    """One question and what was answered.

    Attributes:
        question, joint, verdicts, values, unit: as in
            :class:`~asset_factory.sim_checks.report.Disagreement`.
        evidence: everything known of the asset.
    """

    question: str
    joint: str | None
    verdicts: Mapping[str, str]
    values: Mapping[str, float | None]
    unit: str | None
    evidence: EngineEvidence

    @property
    def passing(self) -> frozenset[str]:
        """Return the engines that found nothing wrong."""
        return frozenset(name for name, verdict in self.verdicts.items() if verdict == PASS)

    @property
    def failing(self) -> frozenset[str]:
        """Return the others."""
        return frozenset(self.verdicts) - self.passing

    @property
    def parts(self) -> frozenset[str]:
        """Parent and child of the joint, as a finding names them; empty if none does."""
        for finding in self.evidence.findings:
            if (
                finding.joint == self.joint
                and finding.simulator in self.failing
                and len(finding.parts) == 2
            ):
                return frozenset(finding.parts)
        return frozenset()

    @property
    def blockers(self) -> frozenset[str]:
        """The two links in contact where an engine stopped the joint; empty if none names any."""
        for name in sorted(self.failing):
            for motion in self.evidence.said(name, "motion").get("joints", ()):
                if motion["joint"] == self.joint and motion.get("blocked_by"):
                    return frozenset(motion["blocked_by"])
        return frozenset()

    def nearest(self) -> Mapping[str, Any] | None:
        """The deepest overlap or narrowest gap of the parts that block the joint, or any near it.

        On the joint's way, and at rest at its parent or child; ``None`` if nothing comes near.
        """
        contacts = list(self._contacts())
        blocking = [contact for contact in contacts if set(contact["links"]) == self.blockers]
        return max(
            blocking or contacts, key=lambda contact: float(contact["depth_mm"]), default=None
        )

    def _contacts(self) -> Iterator[Mapping[str, Any]]:
        if self.question != "rests":
            for sweep in self.evidence.sweeps(self.joint):
                yield from sweep["pairs"]
        for contact in self.evidence.measurements.get("penetration", {}).get("rest", ()):
            if self.parts & set(contact["links"]):
                yield contact


def likely_reason(case: Dispute) -> str:
    """A sentence with the number in it; ``unknown`` where no known trait explains the case."""
    if case.question == "loads":
        return _loading(case) or UNKNOWN
    if case.question not in TOUCHING_QUESTIONS:
        return UNKNOWN
    rules = (
        _soft_limit,
        _follower,
        _explicit_damping,
        _excluded,
        _parent_and_child,
        _across_a_slide,
        _margin,
        _flush,
        _soft_contact,
        _friction,
    )
    return next((sentence for rule in rules if (sentence := rule(case)) is not None), UNKNOWN)


def _loading(case: Dispute) -> str | None:
    refusing = [name for name, verdict in case.verdicts.items() if verdict == "load_failed"]
    if refusing and len(refusing) == len(case.failing):
        return (
            f"the loader of {_titles(refusing)} asks more of a file; "
            "its own words are in its finding"
        )
    return None


def _soft_limit(case: Dispute) -> str | None:
    value = case.values.get("mujoco")
    asked = case.question == "keeps_limits" and case.failing == {"mujoco"}
    if not asked or value is None or value > SOFT_LIMIT_SHARE:
        return None
    return (
        f"MuJoCo's limits are springs, which gave way by {value:.1%} of the range; "
        "the others' are hard"
    )


def _follower(case: Dispute) -> str | None:
    """Only where some engine couples the joint, or what it pushed, to another joint."""
    coupled: dict[str, set[str]] = {}
    concerned = {case.joint}
    for name in case.verdicts:
        motion = case.evidence.said(name, "motion")
        coupled[name] = set(motion["moved_with_others"])
        concerned |= {entry["pushed"] for entry in motion["joints"] if entry["joint"] == case.joint}
    free = [name for name in case.verdicts if not coupled[name]]
    bound = [name for name in case.verdicts if coupled[name] & concerned]
    if not free or not bound or not (set(free) <= case.failing or set(free) <= case.passing):
        return None
    return f"the file couples joints, which {_titles(bound)} obeyed and {_titles(free)} did not"


def _explicit_damping(case: Dispute) -> str | None:
    stiff = [
        f for f in case.evidence.findings if f.code == "damping_stiff" and f.joint == case.joint
    ]
    if not stiff or case.failing != {"pybullet"} or case.blockers:
        return None
    share = f"{stiff[0].value:.3g} times the speed"
    return (
        f"damping takes {share} in one step, and Bullet, which integrates it explicitly, explodes"
    )


def _excluded(case: Dispute) -> str | None:
    contact = case.nearest()
    if contact is None or contact["kind"] != "excluded" or "mujoco" not in case.passing:
        return None
    return (
        f"the file excludes {_pair(contact)} from contact, which of these engines only MuJoCo reads"
    )


def _parent_and_child(case: Dispute) -> str | None:
    contact = case.nearest()
    if contact is None or "sapien" not in case.passing or contact["depth_mm"] <= TOUCH_MM:
        return None
    if set(contact["links"]) != case.parts:
        return None
    sentence = (
        f"{_pair(contact)} overlap by {contact['depth_mm']:.2f} mm and are parent and "
        "child, which PhysX never collides: SAPIEN cannot feel it"
    )
    if "pybullet" in case.passing and _is_across(case, contact):
        sentence += "; nor can Bullet, which exerts no force for overlap across a slide's axis"
    return sentence


def _across_a_slide(case: Dispute) -> str | None:
    contact = case.nearest()
    if contact is None or "pybullet" not in case.passing or contact["depth_mm"] <= TOUCH_MM:
        return None
    if not _is_across(case, contact):
        return None
    return (
        f"{_pair(contact)} overlap by {contact['depth_mm']:.2f} mm all along the slide, "
        "and Bullet exerts no force for overlap across a slide's axis"
    )


def _is_across(case: Dispute, contact: Mapping[str, Any]) -> bool:
    """Return whether an overlap of a slide neither grows nor begins as it moves."""
    slides = any(sweep["unit"] == "m" for sweep in case.evidence.sweeps(case.joint))
    return slides and contact.get("excess_mm", 0.0) <= TOUCH_MM


def _margin(case: Dispute) -> str | None:
    contact = case.nearest()
    if contact is None or case.failing != {"pybullet"} or contact["depth_mm"] > TOUCH_MM:
        return None
    margin = _margin_mm(contact["shapes"])
    gap = max(0.0, -contact["depth_mm"])
    if gap >= margin:
        return None
    return (
        f"{_pair(contact)} are {gap:.2f} mm apart, "
        f"and Bullet wraps every mesh hull in {BULLET_MARGIN_MM:g} mm: to it they touch"
    )


def _flush(case: Dispute) -> str | None:
    contact = case.nearest()
    if (
        contact is None
        or abs(contact["depth_mm"]) > TOUCH_MM
        or set(contact["links"]) != case.blockers
    ):
        return None
    return (
        f"{_pair(contact)} touch without a gap, measured to {TOUCH_MM:g} mm: whether "
        f"{_titles(sorted(case.failing))} feels friction there or an edge is a matter of rounding"
    )


def _margin_mm(shapes: Sequence[str]) -> float:
    return sum(BULLET_MARGIN_MM for shape in shapes if shape not in PRIMITIVES)


def _soft_contact(case: Dispute) -> str | None:
    contact = case.nearest()
    if (
        contact is None
        or "mujoco" not in case.passing
        or not TOUCH_MM < contact["depth_mm"] <= SOFT_CONTACT_MM
    ):
        return None
    return (
        f"{_pair(contact)} overlap by {contact['depth_mm']:.2f} mm, "
        "and MuJoCo's soft contacts give way"
    )


def _friction(case: Dispute) -> str | None:
    contact = case.nearest()
    touches = contact is not None and contact["depth_mm"] > TOUCH_MM
    if touches or case.passing != {"sapien"} or case.question not in {"opens", "returns"}:
        return None
    dropped = any(
        finding.code == "friction_ignored"
        and finding.simulator == "sapien"
        and case.joint in finding.joints
        for finding in case.evidence.findings
    )
    return "nothing is in the way, and SAPIEN drops the file's joint friction" if dropped else None


def _pair(contact: Mapping[str, Any]) -> str:
    return " and ".join(contact["links"])


def _titles(names: Sequence[str]) -> str:
    return " and ".join(TITLES.get(name, name) for name in names)
