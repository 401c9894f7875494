"""Why engines disagree: known traits of each, held against the checks' own depths and gaps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..report import PASS, Disagreement, Finding

UNKNOWN = "no known difference between these engines explains it"
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
        """Return what ``loading`` or ``motion`` measured; empty if the engine got no further."""
        found: Mapping[str, Any] = self.measurements.get(simulator, {}).get(check, {})
        return found

    def answer(self, simulator: str, codes: frozenset[str], joint: str | None = None) -> str:
        """Return ``pass``, or the first of these codes that the engine found (on one joint)."""
        own = (f for f in self.findings if f.simulator == simulator and f.code in codes)
        return next((f.code for f in own if joint in (None, f.joint)), PASS)

    def sweeps(self, joint: str | None) -> Iterator[Mapping[str, Any]]:
        """Yield the measurements along one joint's way."""
        swept = self.measurements.get("penetration", {}).get("joints", ())
        yield from (sweep for sweep in swept if sweep["joint"] == joint)

    def parts(self, case: Disagreement) -> frozenset[str]:
        """Return parent and child of the joint, as a finding names them; empty if none does."""
        told = (f for f in self.findings if f.simulator in case.failing)
        both = (f.parts for f in told if f.joint == case.joint and len(f.parts) == 2)
        return frozenset(next(both, ()))

    def blockers(self, case: Disagreement) -> frozenset[str]:
        """Return the two links in contact where an engine stopped the joint; empty if unknown."""
        lists = (self.said(n, "motion").get("joints", ()) for n in sorted(case.failing))
        motions = (motion for each in lists for motion in each if motion["joint"] == case.joint)
        return frozenset(next(filter(None, (m.get("blocked_by") for m in motions)), ()))

    def nearest(self, case: Disagreement) -> Mapping[str, Any] | None:
        """Return the deepest overlap or narrowest gap of the parts that block the joint.

        Looked at are contacts on the joint's way, and at rest at its parent or child; of all of
        them where nobody names what blocks it. ``None`` if nothing comes near.
        """
        contacts = list(self._contacts(case))
        blockers = self.blockers(case)
        blocking = [contact for contact in contacts if set(contact["links"]) == blockers]
        return max(blocking or contacts, key=lambda each: float(each["depth_mm"]), default=None)

    def _contacts(self, case: Disagreement) -> Iterator[Mapping[str, Any]]:
        if case.question != "rests":
            for sweep in self.sweeps(case.joint):
                yield from sweep["pairs"]
        resting = self.measurements.get("penetration", {}).get("rest", ())
        yield from (each for each in resting if self.parts(case) & set(each["links"]))


def likely_reason(case: Disagreement, evidence: EngineEvidence) -> str:
    """Return a sentence with the number in it; or that no known trait explains it."""
    if case.question == "loads":
        return _loading(case) or UNKNOWN
    if case.joint is None:
        return UNKNOWN
    return (
        _soft_limit(case)
        or _follower(case, evidence)
        or _explicit_damping(case, evidence)
        or _contact(case, evidence)
        or _friction(case, evidence)
        or UNKNOWN
    )


def _loading(case: Disagreement) -> str | None:
    refusing = [name for name, verdict in case.verdicts.items() if verdict == "load_failed"]
    if not refusing or len(refusing) != len(case.failing):
        return None
    own_words = "its own words are in its finding"
    return f"the loader of {_titles(refusing)} asks more of a file; {own_words}"


def _soft_limit(case: Disagreement) -> str | None:
    value = case.values.get("mujoco")
    asked = case.question == "keeps_limits" and case.failing == {"mujoco"}
    if not asked or value is None or value > SOFT_LIMIT_SHARE:
        return None
    gave = f"MuJoCo's limits are springs, which gave way by {value:.1%} of the range"
    return f"{gave}; the others' are hard"


def _follower(case: Disagreement, evidence: EngineEvidence) -> str | None:
    """Blame coupling where some engine couples the joint, or what it pushed, to another joint."""
    coupled: dict[str, set[str]] = {}
    concerned = {case.joint}
    for name in case.verdicts:
        motion = evidence.said(name, "motion")
        coupled[name] = set(motion["moved_with_others"])
        concerned |= {entry["pushed"] for entry in motion["joints"] if entry["joint"] == case.joint}
    free = [name for name in case.verdicts if not coupled[name]]
    bound = [name for name in case.verdicts if coupled[name] & concerned]
    if not free or not bound or not (set(free) <= case.failing or set(free) <= case.passing):
        return None
    return f"the file couples joints, which {_titles(bound)} obeyed and {_titles(free)} did not"


def _explicit_damping(case: Disagreement, evidence: EngineEvidence) -> str | None:
    told = (f for f in evidence.findings if f.code == "damping_stiff")
    stiff = [f for f in told if f.joint == case.joint]
    if not stiff or case.failing != {"pybullet"} or evidence.blockers(case):
        return None
    takes = f"damping takes {stiff[0].value:.3g} times the speed in one step"
    return f"{takes}, and Bullet, which integrates it explicitly, explodes"


def _contact(case: Disagreement, evidence: EngineEvidence) -> str | None:
    """Blame how the engines treat the deepest overlap or the narrowest gap."""
    contact = evidence.nearest(case)
    if contact is None:
        return None
    pair = " and ".join(contact["links"])
    if contact["kind"] == "excluded" and "mujoco" in case.passing:
        return f"the file excludes {pair} from contact, which of these engines only MuJoCo reads"
    if contact["depth_mm"] > TOUCH_MM:
        return _overlap(case, evidence, contact, f"{pair} overlap by {contact['depth_mm']:.2f} mm")
    return _gap(case, evidence, contact, pair)


def _overlap(
    case: Disagreement, evidence: EngineEvidence, contact: Mapping[str, Any], overlap: str
) -> str | None:
    slides = any(sweep["unit"] == "m" for sweep in evidence.sweeps(case.joint))
    # An overlap across a slide neither grows nor begins as it moves.
    across = slides and contact.get("excess_mm", 0.0) <= TOUCH_MM and "pybullet" in case.passing
    if "sapien" in case.passing and set(contact["links"]) == evidence.parts(case):
        never = "are parent and child, which PhysX never collides: SAPIEN cannot feel it"
        nor = "; nor can Bullet, which exerts no force for overlap across a slide's axis"
        return f"{overlap} and {never}{nor if across else ''}"
    if across:
        no_force = "and Bullet exerts no force for overlap across a slide's axis"
        return f"{overlap} all along the slide, {no_force}"
    if "mujoco" in case.passing and contact["depth_mm"] <= SOFT_CONTACT_MM:
        return f"{overlap}, and MuJoCo's soft contacts give way"
    return None


def _gap(
    case: Disagreement, evidence: EngineEvidence, contact: Mapping[str, Any], pair: str
) -> str | None:
    gap = max(0.0, -contact["depth_mm"])
    margin = sum(BULLET_MARGIN_MM for shape in contact["shapes"] if shape not in PRIMITIVES)
    if case.failing == {"pybullet"} and gap < margin:
        wraps = f"Bullet wraps every mesh hull in {BULLET_MARGIN_MM:g} mm"
        return f"{pair} are {gap:.2f} mm apart, and {wraps}: to it they touch"
    if gap <= TOUCH_MM and set(contact["links"]) == evidence.blockers(case):
        feels = f"whether {_titles(sorted(case.failing))} feels friction there or an edge"
        flush = f"{pair} touch without a gap, measured to {TOUCH_MM:g} mm"
        return f"{flush}: {feels} is a matter of rounding"
    return None


def _friction(case: Disagreement, evidence: EngineEvidence) -> str | None:
    contact = evidence.nearest(case)
    touches = contact is not None and contact["depth_mm"] > TOUCH_MM
    if touches or case.passing != {"sapien"} or case.question not in {"opens", "returns"}:
        return None
    told = (f for f in evidence.findings if f.code == "friction_ignored")
    dropped = any(f.simulator == "sapien" and case.joint in f.joints for f in told)
    return "nothing is in the way, and SAPIEN drops the file's joint friction" if dropped else None


def _titles(names: Sequence[str]) -> str:
    return " and ".join(TITLES.get(name, name) for name in names)
