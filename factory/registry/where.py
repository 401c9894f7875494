"""Which assets are wanted, as people type it: ``category = fridge and joints > 1``."""

from __future__ import annotations

import re
from difflib import get_close_matches

from asset_factory.sim_checks import Status

from ..errors import ConfigError
from ..runtime.terminal import complain
from .entry import SOLVED, SPLITS
from .registry import Registry
from .rows import Condition, having

YES_NO = ("yes", "no")
#: Columns that have one of a few values, any text, and a number.
CHOICES = {"status": tuple(Status), "split": SPLITS, "solved": SOLVED, "gpu_ready": YES_NO}
TEXTS = ("category", "reason", "license", "tag", "name")
COUNTS = ("parts", "joints", "hulls")
COLUMNS = (*CHOICES, *TEXTS, *COUNTS)
EXAMPLE = 'want e.g. "category = fridge and joints > 1"'
_CONDITION = re.compile(r'\s*([\w-]+)\s*(<=|>=|!=|=|<|>)\s*("[^"]*"|[^\s"<>=!]+)\s*(and\b|$)')
#: Values that an error lists.
_LISTED = 12


def wanted(registry: Registry, text: str, **defaults: str) -> tuple[Condition, ...]:
    """Return the conditions that a text asks for: joined by ``and``, each given once.

    A value that no asset has is told on stderr.

    Args:
        registry: the one to choose from.
        text: such as ``status = rejected and hulls >= 32``; values with blanks in quotes; empty
            for all.
        defaults: columns that are asked for unless the text speaks of them.

    Raises:
        ConfigError: it cannot be read, or asks for what no asset can be; what would be right.
    """
    found = _parsed(text)
    for each in found:
        if each.operator == "=" and each.column in TEXTS:
            there = registry.values(each.column)
            if each.value not in there:
                meant = _meant(str(each.value), there)
                complain(f"factory: --where: no asset has {each.column} {each.value!r}; {meant}")
                break
    spoken = {condition.column for condition in found}
    usual = {name: value for name, value in defaults.items() if name not in spoken}
    return (*having(**usual), *found)


def _parsed(text: str) -> list[Condition]:
    found: list[Condition] = []
    equal: set[str] = set()
    rest = text
    last = ""
    while rest.strip() or last:
        said = _CONDITION.match(rest)
        if said is None:
            raise ConfigError(f"--where: cannot read {rest.strip() or last!r}; {EXAMPLE}")
        condition = _checked(said[1].replace("-", "_"), said[2], said[3].strip('"'))
        if condition.operator == "=" and condition.column not in COUNTS:
            if condition.column in equal:
                raise ConfigError(f"--where: {condition.column} is there twice, want it once")
            equal.add(condition.column)
        found.append(condition)
        last = said[4]
        rest = rest[said.end() :]
    return found


def _checked(column: str, operator: str, value: str) -> Condition:
    if column not in COLUMNS:
        raise ConfigError(f"--where: no column {column!r}; {_meant(column, COLUMNS)}")
    if column in COUNTS:
        if not value.isdecimal():
            raise ConfigError(f"--where: {column} must be a whole number, not {value!r}")
        return Condition(column, operator, int(value))
    if operator not in ("=", "!=") or (column == "tag" and operator != "="):
        raise ConfigError(f"--where: {column} {operator} {value}: is no number; {EXAMPLE}")
    if column in CHOICES and value not in CHOICES[column]:
        raise ConfigError(f"--where: {column} is {value!r}; {_meant(value, CHOICES[column])}")
    return Condition(column, operator, value)


def _meant(typed: str, known: tuple[str, ...]) -> str:
    near = get_close_matches(typed, known, n=1)
    there = ", ".join(each or '""' for each in known[:_LISTED])
    more = f" and {len(known) - _LISTED} more" if len(known) > _LISTED else ""
    return f"did you mean {near[0]!r}?" if near else f"there are {there or 'none'}{more}"
