"""What attempts come to: changes between nights, reasons, times, and the yield of each source."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import PurePath
from statistics import median

from asset_factory.sim_checks import Status

from .night import NightResult, share

SLOWEST = 20
#: Fewer nights tell nothing of what is usual.
LEAST_NIGHTS = 3


@dataclass(frozen=True)
class InputChange:
    """An input in two nights: its attempt in each."""

    before: NightResult
    now: NightResult

    @property
    def same_content(self) -> bool:
        """Tell whether it is the same file (ids end in its digest), so that the change is ours."""
        return self.before.id == self.now.id


@dataclass(frozen=True)
class Changes:
    """Two nights compared.

    Attributes:
        failing: passed then and not now.
        passing: the other way round.
        other: failed both times, for another reason.
        shared: how many inputs both nights had.
        passed_before, passed_now: how many of those passed.
        fresh: inputs of the later night only.
        gone: inputs of the earlier night only.
    """

    failing: tuple[InputChange, ...] = ()
    passing: tuple[InputChange, ...] = ()
    other: tuple[InputChange, ...] = ()
    shared: int = 0
    passed_before: int = 0
    passed_now: int = 0
    fresh: tuple[NightResult, ...] = ()
    gone: tuple[NightResult, ...] = ()


def compare(before: Sequence[NightResult], now: Sequence[NightResult]) -> Changes:
    """Compare two nights; inputs are matched by path, those that were moved since by id."""
    by_path = {attempt.input: attempt for attempt in before}
    current = {attempt.input for attempt in now}
    moved = {attempt.id: attempt for attempt in before if attempt.input not in current}
    pairs = []
    fresh = []
    for attempt in now:
        old = by_path.get(attempt.input) or moved.pop(attempt.id, None)
        if old is None:
            fresh.append(attempt)
        else:
            pairs.append(InputChange(old, attempt))
            del by_path[old.input]
    was_passed = [pair for pair in pairs if pair.before.passed]
    was_failed = [pair for pair in pairs if not pair.before.passed]
    failed = [pair for pair in was_failed if not pair.now.passed]
    return Changes(
        failing=tuple(pair for pair in was_passed if not pair.now.passed),
        passing=tuple(pair for pair in was_failed if pair.now.passed),
        other=tuple(pair for pair in failed if pair.before.reason != pair.now.reason),
        shared=len(pairs),
        passed_before=len(was_passed),
        passed_now=sum(pair.now.passed for pair in pairs),
        fresh=tuple(fresh),
        gone=tuple(by_path.values()),
    )


@dataclass(frozen=True)
class Reason:
    """A reason code with its status, how many inputs have it, and one of them."""

    code: str
    status: str
    count: int
    example: str
    message: str


@dataclass(frozen=True)
class StageTime:
    """Time spent in a stage, in all and by the median of so many inputs [s], and the slowest."""

    stage: str
    seconds: float
    median: float
    inputs: int
    slowest: str


@dataclass(frozen=True)
class LicenseCount:
    """A license as stated, empty if it is not, and how many inputs of each verdict have it."""

    license: str
    passed: int
    rejected: int
    unjudged: int


def reasons(attempts: Sequence[NightResult]) -> tuple[Reason, ...]:
    """Count why inputs did not pass, the most frequent first, each with an example."""
    groups: dict[tuple[str, str], list[NightResult]] = defaultdict(list)
    for attempt in attempts:
        if not attempt.passed:
            groups[attempt.reason, attempt.status].append(attempt)
    found = []
    for (code, status), group in groups.items():
        example = min(group, key=lambda attempt: (not attempt.message, attempt.input))
        found.append(Reason(code, status, len(group), example.id, example.message))
    return tuple(sorted(found, key=lambda reason: (-reason.count, reason.code, reason.status)))


def stage_times(attempts: Sequence[NightResult]) -> tuple[StageTime, ...]:
    """Return where the time went, the longest stage first; inputs known from before took none."""
    spent: dict[str, list[NightResult]] = defaultdict(list)
    for attempt in slowest(attempts, len(attempts)):
        for stage in attempt.stages:
            spent[stage].append(attempt)
    found = []
    for stage, group in spent.items():
        times = [attempt.stages[stage] for attempt in group]
        longest = group[times.index(max(times))].id
        told = round(sum(times), 3), round(median(times), 3)
        found.append(StageTime(stage, *told, len(times), longest))
    return tuple(sorted(found, key=lambda item: (-item.seconds, item.stage)))


def slowest(attempts: Sequence[NightResult], most: int = SLOWEST) -> tuple[NightResult, ...]:
    """Return the inputs that took longest, of those built anew."""
    built = [attempt for attempt in attempts if not attempt.known]
    return tuple(sorted(built, key=lambda attempt: (-attempt.seconds, attempt.input))[:most])


def licenses(attempts: Sequence[NightResult]) -> tuple[LicenseCount, ...]:
    """Return the inputs by license, the most frequent first."""
    totals = Counter(attempt.license for attempt in attempts)
    counts = Counter((attempt.license, attempt.status) for attempt in attempts)
    names = sorted(totals, key=lambda name: (-totals[name], name))
    found = ({status: counts[name, status] for status in Status} for name in names)
    return tuple(LicenseCount(name, **told) for name, told in zip(names, found, strict=True))


@dataclass(frozen=True)
class SourceRules:
    """When the fall of a source's yield counts; configs/nightly.toml explains each setting."""

    drop: float = 0.1
    nights: int = 14
    least: int = 20


@dataclass(frozen=True)
class SourceYield:
    """How many inputs of a source there were in a night, and how many of them passed.

    Attributes:
        source: an input of the configuration, with all below it.
        passed, tried: inputs.
        usual: the median of its yields over the last nights, 0 to 1; ``None`` where there were too
            few.
        nights: how many those were.
        fell: whether the yield is further below that than is allowed.
    """

    source: str
    passed: int
    tried: int
    usual: float | None = None
    nights: int = 0
    fell: bool = False

    @property
    def yielded(self) -> float:
        """Return the share that passed, 0 to 1."""
        return self.passed / self.tried


def source_yields(
    attempts: Sequence[NightResult],
    roots: Sequence[PurePath],
    earlier: Sequence[Mapping[str, tuple[int, int]]],
    rules: SourceRules,
) -> tuple[SourceYield, ...]:
    """Return the yield of every source, by name.

    ``earlier`` says of each earlier night, in their order: source -> how many passed, of how many.
    """
    groups: dict[str, list[bool]] = defaultdict(list)
    for attempt in attempts:
        groups[_source(PurePath(attempt.input), roots)].append(attempt.passed)
    return tuple(
        _against(SourceYield(source, sum(passed), len(passed)), earlier, rules)
        for source, passed in sorted(groups.items())
    )


def _source(path: PurePath, roots: Sequence[PurePath]) -> str:
    """Return the innermost root that an input lies below; its folder if it is named itself."""
    above = [root for root in roots if root in path.parents]
    return str(max(above, key=lambda root: len(root.parts), default=path.parent))


def _against(
    now: SourceYield, earlier: Sequence[Mapping[str, tuple[int, int]]], rules: SourceRules
) -> SourceYield:
    known = [night[now.source] for night in earlier if now.source in night]
    yields = [share(passed, tried) for passed, tried in known if tried >= max(1, rules.least)]
    recent = [each for each in reversed(yields) if each is not None][: rules.nights]
    if len(recent) < LEAST_NIGHTS:
        return now
    usual = median(recent)
    # Rounded: a fall of exactly what is allowed is allowed, whatever binary fractions say.
    fell = now.tried >= rules.least and round(usual - now.yielded, 9) > rules.drop
    return replace(now, usual=usual, nights=len(recent), fell=fell)
