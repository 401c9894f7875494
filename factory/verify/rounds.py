"""One hypothesis of an input, made, validated and repaired, round by round."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from asset_factory.sim_checks import Finding
from asset_factory.sim_checks.judge import Judge

from ..articulate.drawn import close_seen, left_open
from ..articulation import Articulation
from ..asset import Asset
from ..errors import InputRejected, Unjudged
from ..export.bundle import export_bundle
from ..intake.intake import Intake
from ..manufacture.plan import Plan, Spare, dispensable_joints, first_plan
from ..manufacture.stage import manufacture
from ..runtime.stages import Stages
from .drafts import HypothesisDraft, work_of
from .repair import next_plan
from .validate import Verdict, inspect, validate

#: An asset of too many hulls gets fewer in so many steps at most.
LIGHTER = 3


@dataclass(frozen=True, eq=False)
class Rounds:
    """Whatever it takes to make one hypothesis, and to validate it.

    Attributes:
        articulation: the kinematic tree of the hypothesis.
        intake: the input.
        staging: a folder for products.
        judge: the validator, with the configuration's thresholds.
        stages: with the settings and the cache.
    """

    articulation: Articulation
    intake: Intake
    staging: Path
    judge: Judge
    stages: Stages

    def drafted(self) -> HypothesisDraft:
        """Make the hypothesis, validate it without simulators, and repair while a repair applies.

        Raises:
            InputRejected: nothing can be made of it.
            Unjudged: a clock or somebody stopped a step.
        """
        draft = self._repaired(self._made(first_plan(self.articulation, self._spare), "0"), "")
        return self._lighter(draft) if draft.passes else draft

    def simulated(
        self, draft: HypothesisDraft, others: tuple[Finding, ...]
    ) -> tuple[HypothesisDraft, Verdict]:
        """Validate a draft in simulators too, and repair what these alone refuse.

        The draft passes without simulators, or is the best there is; ``others`` are findings on
        other hypotheses.
        """
        first = draft, self._validated(draft, others)
        verdict = first[1]
        for attempt in range(self.stages.config.repair.max_rounds if draft.passes else 0):
            plan = None if verdict.reason is None else self._next(verdict, draft)
            if plan is None:
                break
            name = f"simulated-{attempt}-"
            try:
                again = self._repaired(self._made(plan, f"{name}0", draft.work), name)
            except InputRejected:
                break
            if not again.passes:
                break
            draft = replace(again, before=draft.before or draft.asset)
            verdict = self._validated(draft, others)
        return self._as_drawn(draft, verdict, others) if verdict.reason is None else first

    def _as_drawn(
        self, draft: HypothesisDraft, verdict: Verdict, others: tuple[Finding, ...]
    ) -> tuple[HypothesisDraft, Verdict]:
        """Return what passes with its rest as drawn, or else as it was made: closed."""
        asset = left_open(draft.asset, self.articulation)
        if asset is draft.asset:
            return draft, verdict
        made = self._exported(asset, draft.plan, draft.findings, "as_drawn", draft.work)
        made = replace(made, before=draft.before and left_open(draft.before, self.articulation))
        again = self._validated(made, others) if made.passes else made.inspected
        return (made, again) if again.reason is None else (draft, verdict)

    @cached_property
    def _closed(self) -> Articulation:
        return close_seen(self.articulation)

    @cached_property
    def _spare(self) -> Spare:
        return dispensable_joints(self._closed, self.stages.config.repair.small_share)

    def _made(self, plan: Plan, folder: str, done: int = 0) -> HypothesisDraft:
        """Make and inspect what a plan says; ``done`` is the work on it so far."""
        asset, findings = manufacture(self._closed, plan, self.intake, self.stages)
        return self._exported(asset, plan, findings, folder, done + work_of(asset))

    def _exported(
        self, asset: Asset, plan: Plan, findings: tuple[Finding, ...], folder: str, work: int
    ) -> HypothesisDraft:
        """Write an asset and inspect it."""
        with self.stages.clock.stage("export"):
            bundle = export_bundle(
                asset,
                self.intake.provenance,
                self.staging / folder,
                tuple(sorted(plan.exclude)),
                self.stages.config.formats,
            )
        inspected = _said(inspect(bundle, self.judge, findings, self.stages))
        return HypothesisDraft(
            self.articulation, asset, bundle, plan, findings, inspected, work=work
        )

    def _repaired(self, first: HypothesisDraft, name: str) -> HypothesisDraft:
        draft = first
        for attempt in range(self.stages.config.repair.max_rounds):
            plan = self._next(draft.inspected, draft)
            if plan is None:
                break
            draft = self._made(plan, f"{name}{attempt + 1}", draft.work)
        return draft if draft is first else replace(draft, before=first.asset)

    def _lighter(self, draft: HypothesisDraft) -> HypothesisDraft:
        """Return the same with fewer hulls, where it has too many and passes with those."""
        most = self.stages.config.hulls.most
        aim = most
        lightest = draft
        excess = draft.asset.hull_count - most
        for attempt in range(LIGHTER):
            if excess <= 0 or aim <= 0:
                break
            plan = replace(draft.plan, fewer=aim)
            made = self._made(plan, f"fewer-{attempt}", draft.work)
            if not made.passes:
                break
            if made.asset.hull_count < lightest.asset.hull_count:
                lightest = replace(made, before=draft.before or draft.asset)
            # Hulls are joined before they are cut apart, which makes several of one.
            excess = made.asset.hull_count - most
            aim -= excess
        return lightest

    def _next(self, verdict: Verdict, draft: HypothesisDraft) -> Plan | None:
        """Return what to do differently, if anything could help that is worth the work."""
        config = self.stages.config.repair
        if draft.work > config.most_work:
            return None
        return next_plan(verdict, draft.plan, config, self._spare, draft.asset)

    def _validated(self, draft: HypothesisDraft, others: tuple[Finding, ...]) -> Verdict:
        told = (*draft.findings, *others)
        return _said(validate(draft.bundle, self.judge, told, draft.inspected, self.stages))


def _said(verdict: Verdict) -> Verdict:
    """Return the same verdict. Raises Unjudged: a clock or somebody stopped one who was to judge.

    What that one would have said is not known, so nothing is repaired or chosen by the rest.
    """
    for finding in verdict.report.errors:
        if finding.stopped:
            raise Unjudged(finding)
    return verdict
