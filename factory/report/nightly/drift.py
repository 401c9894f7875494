"""The yield of each source of inputs, against what it was over the last nights."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePath
from statistics import median

from .night import NightResult, share

#: Fewer nights tell nothing of what is usual.
LEAST_NIGHTS = 3


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
    return SourceYield(now.source, now.passed, now.tried, usual, len(recent), fell)
