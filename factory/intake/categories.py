"""Categories of objects with their usual size, mass and inside."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from importlib.resources import files as resource_files
from pathlib import Path
from types import MappingProxyType
from typing import Literal

import msgspec

from ..errors import ConfigError

_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+")
_SHORTEST_SUFFIX = 4


class Category(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The usual size, mass and inside of objects of one category.

    Attributes:
        name: canonical.
        measure: ``height`` (along z) or ``extent`` (largest side).
        typical: size [m].
        range: least and most size [m].
        aliases: other names, words joined by ``_``.
        bulk: mass over the volume of the box around the closed object [kg/m3]; ``None`` where
            the density of boards tells the mass well enough.
        shelves: distance between the shelves behind its doors [m]; ``None``: it has none.
        liner: colour of its inside, sRGB as ``#rrggbb``; ``None``: like its outside.
    """

    name: str
    measure: Literal["height", "extent"]
    typical: float
    range: tuple[float, float]
    aliases: tuple[str, ...] = ()
    bulk: float | None = None
    shelves: float | None = None
    liner: str | None = None


#: An object of which nothing is known.
UNKNOWN = Category("object", "extent", 1.0, (0.02, 5.0))


@cache
def category_table() -> Mapping[str, Category]:
    """Return the table in ``configs/categories.toml``, by canonical name and by alias.

    Raises:
        ConfigError: an entry contradicts itself or a name appears twice.
    """
    text = (resource_files("asset_factory") / "configs" / "categories.toml").read_bytes()
    table: dict[str, Category] = {}
    for name, entry in msgspec.toml.decode(text, type=dict[str, dict[str, object]]).items():
        try:
            category = msgspec.convert({"name": name, **entry}, Category)
        except msgspec.ValidationError as error:
            raise ConfigError(f"categories.toml, {name}: {error}") from None
        if not 0.0 < category.range[0] <= category.typical <= category.range[1]:
            raise ConfigError(f"categories.toml, {name}: want range[0] <= typical <= range[1]")
        for each in (name, *category.aliases):
            if each in table:
                raise ConfigError(f"categories.toml, {name}: {each!r} appears twice")
            table[each] = category
    return MappingProxyType(table)


def usual_of(category: str | None) -> Category:
    """Return the table's entry of a category; :data:`UNKNOWN` where there is none."""
    return category_table().get(normalised(category), UNKNOWN) if category else UNKNOWN


def normalised(category: str) -> str:
    """Return a category as the table would write it; its canonical name if the table knows it."""
    name = "_".join(re.findall(r"[a-z0-9]+", category.lower())) or category
    known = category_table().get(name)
    return known.name if known else name


def category_of(path: Path, stated: str | None) -> str | None:
    """Return the category that is stated of an input, else one that its path names."""
    return normalised(stated) if stated else guess_category(path.stem, path.parent.name)


def guess_category(stem: str, folder: str = "") -> str | None:
    """Return a category of the table named in a file stem, else at the end of its folder's name.

    The longest match in words wins, then an exact word over the tail of one (``kitchencabinet``),
    then the last: in English the head of a compound comes last.
    """
    return _named_in(_words(stem), anywhere=True) or _named_in(_words(folder), anywhere=False)


def _words(text: str) -> list[str]:
    return [word.lower() for word in _WORD.findall(text)]


def _named_in(words: list[str], *, anywhere: bool) -> str | None:
    best: tuple[int, int, int] | None = None
    found: str | None = None
    for name, category in category_table().items():
        parts = name.split("_")
        for end in range(len(parts), len(words) + 1) if anywhere else [len(words)]:
            rank = _match(words[max(end - len(parts), 0) : end], parts)
            if rank and (best is None or (len(parts), rank, end) > best):
                best = (len(parts), rank, end)
                found = category.name
    return found


def _match(words: list[str], parts: list[str]) -> int:
    """Return 2 for the same words, one plural allowed; 1 if one word ends in the name; else 0."""
    if len(words) != len(parts):
        return 0
    if words == parts or [*words[:-1], words[-1].removesuffix("s")] == parts:
        return 2
    return int(
        len(parts) == 1 and len(parts[0]) >= _SHORTEST_SUFFIX and words[0].endswith(parts[0])
    )
