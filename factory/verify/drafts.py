"""Several hypotheses of one input, each made and validated: which becomes the asset."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from asset_factory.sim_checks import Finding, Severity

from ..articulate.proposal import probability_of
from ..articulation import Articulation
from ..asset import Asset
from ..errors import InputRejected
from ..export.bundle import Bundle
from ..manufacture.plan import Plan
from .validate import Verdict

#: So many faces take as long as a hull, in the rounds of 27 objects of 400 to 65,000 faces.
FACES_PER_HULL = 400


@dataclass(frozen=True)
class HypothesisDraft:
    """One hypothesis, made, and repaired as far as that goes.

    Attributes:
        articulation: the kinematic tree of the hypothesis.
        asset, bundle: what it became.
        plan: what repairs changed.
        findings: the factory's own.
        inspected: what the validator says of it without simulators.
        before: what it was before repairs, if there were any.
        work: that it took, with all that was made of it before; see :func:`work_of`.
    """

    articulation: Articulation
    asset: Asset
    bundle: Bundle
    plan: Plan
    findings: tuple[Finding, ...]
    inspected: Verdict
    before: Asset | None = None
    work: int = 0

    @property
    def passes(self) -> bool:
        """Return whether nothing rejects it so far."""
        return self.inspected.reason is None

    @property
    def whole(self) -> bool:
        """Return whether it passes with every joint of its hypothesis."""
        return self.passes and not self.plan.frozen and not self.plan.given_up


def work_of(asset: Asset) -> int:
    """Return what it takes to make and inspect an asset once: hulls, and faces, that are moved.

    Counted from what it is, so that it is alike on every machine and with every cache. Each took
    3 to 23 ms of processor time.
    """
    moved = asset.hull_count + len(asset.articulation.mesh.faces) // FACES_PER_HULL
    return max(1, len(asset.articulation.movable_joints)) * moved


def best_of(drafts: Iterable[HypothesisDraft]) -> tuple[HypothesisDraft, tuple[Finding, ...]]:
    """Return the draft that becomes the asset, and findings on the others.

    The likeliest that passes with all its joints; else the likeliest that passes; else the
    likeliest. Those behind the first that passes whole are not made.

    Args:
        drafts: the likeliest first, each made when it is asked for; at least one.
    """
    made: list[HypothesisDraft] = []
    for draft in drafts:
        made.append(draft)
        if draft.whole:
            break
    best = max(made, key=lambda draft: (draft.whole, draft.passes))
    return best, tuple(_lost(draft) for draft in made if draft is not best)


def refused_hypothesis(articulation: Articulation, rejection: InputRejected) -> Finding:
    """Return the finding on a hypothesis of which no bodies could be made."""
    return _told_of(articulation, f"cannot be made, {rejection.code}: {rejection}")


def _lost(draft: HypothesisDraft) -> Finding:
    reason = draft.inspected.reason
    dropped = sorted(draft.plan.frozen | draft.plan.given_up)
    if reason is not None:
        why = f"is rejected, {reason.code}: {reason.message}"
    elif dropped:
        why = f"passes only without {', '.join(dropped)}"
    else:
        why = "passes too, and is less likely"
    return _told_of(draft.articulation, why)


def _told_of(articulation: Articulation, why: str) -> Finding:
    """Return the finding on a hypothesis that did not become the asset."""
    joints = articulation.movable_joints
    told = [
        f"{articulation.parts[j.child].name} {'turns' if j.turns else 'slides'}" for j in joints
    ]
    if any(joint.confidence is not None for joint in joints):
        told.append(f"probability {probability_of(articulation):.2f}")
    said = f"read otherwise ({', '.join(told)}), it {why}"
    return Finding("other_reading", Severity.WARNING, said)
