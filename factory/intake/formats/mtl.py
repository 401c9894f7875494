"""Wavefront material libraries: diffuse colour and diffuse map."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from ...mesh import Material, Texture
from ..files import InputFiles
from ..images import load_texture
from ..limits import require_at_most

_MAX_BYTES = 16 * 1024 * 1024
_OPTION_WORDS = {"-o": 3, "-s": 3, "-t": 3, "-mm": 2}


@dataclass(frozen=True)
class _Maps:
    """Where a library's images are, and where to complain about them."""

    folder: Path
    files: InputFiles
    notes: list[str]
    known: dict[str, Texture | None] = field(default_factory=dict)

    def load(self, reference: str) -> Texture | None:
        if reference not in self.known:
            self.known[reference] = self._read(reference)
        return self.known[reference]

    def _read(self, reference: str) -> Texture | None:
        try:
            data = self.files.read_reference(reference, self.folder)
        except FileNotFoundError:
            self.notes.append(f"The texture {reference} is missing; the plain colour was kept.")
            return None
        texture = load_texture(data, reference, self.files)
        if texture is None:
            self.notes.append(
                f"The texture {reference} ({len(data)} bytes) cannot be decoded; "
                "the plain colour was kept."
            )
        return texture


def read_mtl(data: bytes, folder: Path, files: InputFiles, notes: list[str]) -> dict[str, Material]:
    """Return materials by name; a diffuse map replaces the diffuse colour, as in modelling tools.

    Maps are relative to ``folder``; sentences about missing and broken ones are added to ``notes``.

    Raises:
        InputRejected: ``external_reference`` or ``too_large`` for a map.
    """
    require_at_most("material library", len(data), _MAX_BYTES, "bytes")
    maps = _Maps(folder, files, notes)
    result: dict[str, Material] = {}
    name: str | None = None
    for line in data.decode("utf-8", "replace").splitlines():
        keyword, _, rest = line.strip().partition(" ")
        rest = rest.strip()
        if keyword == "newmtl":
            name = rest
            result[name] = Material(name)
        elif name is not None:
            result[name] = _changed(result[name], keyword.lower(), rest, maps)
    return result


def _changed(material: Material, keyword: str, rest: str, maps: _Maps) -> Material:
    red, green, blue, alpha = material.color
    if keyword == "kd" and material.texture is None:
        values = [_unit(word) for word in rest.split()[:3]]
        if len(values) in (1, 3):
            red, green, blue = values * 3 if len(values) == 1 else values
    elif keyword == "d" and rest:
        alpha = _unit(rest.rsplit(maxsplit=1)[-1])
    elif keyword == "tr" and rest:
        alpha = 1.0 - _unit(rest.rsplit(maxsplit=1)[-1])
    elif keyword == "map_kd" and rest:
        texture = maps.load(_without_options(rest))
        if texture is not None:
            return Material(material.name, (1.0, 1.0, 1.0, alpha), texture)
    return Material(material.name, (red, green, blue, alpha), material.texture)


def _unit(word: str) -> float:
    try:
        value = float(word)
    except ValueError:
        return 1.0
    return min(max(value, 0.0), 1.0) if value == value else 1.0  # noqa: PLR0124 - NaN


def _without_options(rest: str) -> str:
    """Return the file name behind options such as ``-s 1 1 1``; it may hold spaces."""
    words = rest.split(" ")
    while words and words[0].startswith("-") and len(words) > 1:
        skip = 1
        limit = _OPTION_WORDS.get(words[0], 1)
        while skip <= limit and skip < len(words) - 1 and (limit == 1 or _is_number(words[skip])):
            skip += 1
        words = words[skip:]
    return " ".join(words)


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
