"""Real-world sizes by category, and which factor makes a mesh's units metres."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files as resource_files
from pathlib import Path
from types import MappingProxyType

from ..errors import ConfigError
from ..mesh import FloatArray

UNITS = ((0.001, "millimetres", 1.0), (0.01, "centimetres", 1.0), (0.0254, "inches", 2.0))
"""Factors tried when a size is implausible in metres, and how much better than others each fits."""

_UNIT_WITHIN = 4.0
"""How far off the expected size, times that handicap, a unit is still believed."""

PLAUSIBLE_EXTENT = (0.02, 5.0)
"""Largest extent of an object of unknown category that is believed to be in metres [m]."""

_UNKNOWN_EXTENT = 1.0
_UNKNOWN_EXTENT_IN_UNITS = 0.5
_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+")
_SHORTEST_SUFFIX = 4


@dataclass(frozen=True)
class Size:
    """How large things of one category are.

    Attributes:
        category: canonical name.
        aliases: other names, words joined by ``_``.
        measure: ``height`` (along z) or ``extent`` (largest side).
        typical, least, most: [m].
    """

    category: str
    aliases: tuple[str, ...]
    measure: str
    typical: float
    least: float
    most: float


@dataclass(frozen=True)
class Scale:
    """A factor from input units to metres, and the sentence that says why.

    Attributes:
        factor: metres per input unit.
        source: as in ``Provenance.scale_source``.
        note: ``None`` if nothing was assumed.
        plausible: whether a known unit explains the size; if not, the typical size was imposed.
    """

    factor: float
    source: str
    note: str | None = None
    plausible: bool = True


@cache
def size_table() -> Mapping[str, Size]:
    """Return the table in ``configs/categories.toml``, by canonical name and by alias.

    Raises:
        ConfigError: an entry contradicts itself or a name appears twice.
    """
    text = (resource_files("asset_factory") / "configs" / "categories.toml").read_text(
        encoding="utf-8"
    )
    table: dict[str, Size] = {}
    for category, entry in tomllib.loads(text).items():
        least, most = entry["range"]
        size = Size(
            category,
            tuple(entry.get("aliases", ())),
            entry["measure"],
            entry["typical"],
            least,
            most,
        )
        if not 0.0 < size.least <= size.typical <= size.most or size.measure not in (
            "height",
            "extent",
        ):
            raise ConfigError(
                f"categories.toml, {category}: "
                "want range[0] <= typical <= range[1], a known measure"
            )
        for name in (category, *size.aliases):
            if name in table:
                raise ConfigError(f"categories.toml, {category}: {name!r} appears twice")
            table[name] = size
    return MappingProxyType(table)


def normalised(category: str) -> str:
    """Return a category as the table would write it; its canonical name if the table knows it."""
    name = "_".join(re.findall(r"[a-z0-9]+", category.lower())) or category
    size = size_table().get(name)
    return size.category if size else name


def category_of(path: Path, stated: str | None) -> str | None:
    """Return the category that is stated of an input, else one that its path names."""
    return normalised(stated) if stated else guess_category(path.stem, path.parent.name)


def guess_category(stem: str, folder: str = "") -> str | None:
    """Return a category of the table named in a file stem, else at the end of its folder's name.

    The longest match in words wins, then an exact word over the tail of one (``kitchencabinet``),
    then
    the last: in English the head of a compound comes last.
    """
    return _named_in(_words(stem), anywhere=True) or _named_in(_words(folder), anywhere=False)


def _words(text: str) -> list[str]:
    return [word.lower() for word in _WORD.findall(text)]


def _named_in(words: list[str], *, anywhere: bool) -> str | None:
    best: tuple[int, int, int] | None = None
    found: str | None = None
    for name, size in size_table().items():
        parts = name.split("_")
        for end in range(len(parts), len(words) + 1) if anywhere else [len(words)]:
            rank = _match(words[max(end - len(parts), 0) : end], parts)
            if rank and (best is None or (len(parts), rank, end) > best):
                best = (len(parts), rank, end)
                found = size.category
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


def scale_by_size(extents: FloatArray, category: str | None) -> Scale:
    """Return the factor that makes a mesh plausible in metres, by category if it is known.

    Args:
        extents: of the mesh, z up, input units, shape [3].
        category: as from :func:`normalised` or :func:`guess_category`.
    """
    size = size_table().get(category) if category else None
    if size is None:
        size = Size("object", (), "extent", _UNKNOWN_EXTENT, *PLAUSIBLE_EXTENT)
        source = "guess"
    else:
        source = "category"
    flat = size.measure == "height" and extents[2] <= 0.0
    value = float(extents.max() if size.measure == "extent" or flat else extents[2])
    what = "largest extent" if size.measure == "extent" or flat else "height"
    plausible = f"{size.least:g} to {size.most:g} m is plausible for {_article(size.category)}"
    if size.least <= value <= size.most:
        return Scale(
            1.0,
            "as_is",
            f"The input was taken to be in metres: its {what} is {value:.4g}, and {plausible}.",
        )
    expected = size.typical if source == "category" else _UNKNOWN_EXTENT_IN_UNITS
    unit = _best_unit(value, size, expected)
    if unit is not None:
        factor, name = unit
        note = (
            f"The input was taken to be in {name}: "
            f"its {what} is {value:.4g}, so {value * factor:.4g} m"
        )
        return Scale(factor, source, f"{note}; {plausible}.")
    factor = size.typical / value
    note = (
        f"The input was scaled by {factor:.6g} to a {what} of {size.typical:g} m: "
        f"its own is {value:.4g}"
    )
    return Scale(factor, source, f"{note}, which no known unit makes likely ({plausible}).", False)


def _best_unit(value: float, size: Size, expected: float) -> tuple[float, str] | None:
    """Return the unit that makes ``value`` plausible and closest to the expected size."""
    off = {
        (factor, name): handicap * max(value * factor / expected, expected / (value * factor))
        for factor, name, handicap in UNITS
        if size.least <= value * factor <= size.most
    }
    best = min(off, key=lambda unit: off[unit], default=None)
    return best if best is not None and off[best] <= _UNIT_WITHIN else None


def _article(category: str) -> str:
    words = category.replace("_", " ")
    return f"an {words}" if words[0] in "aeiou" else f"a {words}"
