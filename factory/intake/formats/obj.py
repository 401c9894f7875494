"""Wavefront OBJ and its material libraries: polygons fanned from their first corner."""

from __future__ import annotations

import io
from array import array
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cache, partial
from pathlib import Path

import numpy as np

from ...geometry.soup import Soup, unique_names
from ...mesh import FloatArray, IntArray, Material, Texture
from ..files import InputFiles
from ..images import read_texture
from ..limits import require_at_most, unreadable

_MANY = 64
_MOST_LIBRARIES = 64
_BLANKS = (b" ", b"\t", b"\v", b"\f", b"\r")
_MAX_BYTES = 16 * 1024 * 1024
_OPTION_WORDS = {"-o": 3, "-s": 3, "-t": 3, "-mm": 2}


@dataclass
class _Lines:
    """What the lines said so far; face corners are triples of 0-based indices, -1 for none."""

    positions: array[float] = field(default_factory=lambda: array("d"))
    coordinates: array[float] = field(default_factory=lambda: array("d"))
    normals: array[float] = field(default_factory=lambda: array("d"))
    corners: array[int] = field(default_factory=lambda: array("q"))
    face_material: array[int] = field(default_factory=lambda: array("q"))
    names: dict[str, int] = field(default_factory=dict)
    current: int = -1
    libraries: list[str] = field(default_factory=list)


def read_obj(data: bytes, path: Path, files: InputFiles) -> Soup:
    """Return an OBJ file's triangles and its libraries' materials, in its own frame and units.

    A library or texture that is missing is noted, not fatal.

    Raises:
        InputRejected: ``unreadable``, ``too_large`` or ``external_reference``.
    """
    limits = files.limits
    require_at_most(path.name, data.count(b"\nv "), 3 * limits.max_faces, "vertices")
    lines = _Lines()
    joined = data.replace(b"\\\r\n", b" ").replace(b"\\\n", b" ") if b"\\" in data else data
    for line in io.BytesIO(joined):
        _take(lines, line, path.name, limits.max_faces)
    notes: list[str] = []
    library: dict[str, Material] = {}
    # Of a library that is named again, the last mention counts.
    libraries = list(dict.fromkeys(reversed(lines.libraries)))[::-1]
    require_at_most(path.name, len(libraries), _MOST_LIBRARIES, "material libraries")
    for name in libraries:
        library.update(_library(name, path, files, notes))
    return _assemble(lines, library, notes, path.name, limits.max_faces)


def _take(lines: _Lines, line: bytes, name: str, max_faces: int) -> None:
    keyword, rest = (*line.split(None, 1), b"", b"")[:2]
    if keyword == b"v":
        lines.positions.extend(_numbers(rest, 3))
    elif keyword == b"vt":
        lines.coordinates.extend(_numbers(rest, 2))
    elif keyword == b"vn":
        lines.normals.extend(_numbers(rest, 3))
    elif keyword == b"f":
        done = len(lines.face_material)
        # Blanks bound a polygon's corners before they are split into words.
        blanks = sum(rest.count(blank) for blank in _BLANKS) if len(rest) > _MANY else 0
        require_at_most(name, done + (blanks if blanks > _MANY else 1), max_faces, "faces")
        _take_face(lines, rest.split())
    elif keyword == b"usemtl":
        material = rest.decode("utf-8", "replace").strip()
        lines.current = lines.names.setdefault(material, len(lines.names))
    elif keyword == b"mtllib":
        lines.libraries.append(rest.decode("utf-8", "replace").strip())


def _numbers(text: bytes, count: int) -> list[float]:
    values = [float(word) for word in text.split(None, count)[:count]]
    return values + [0.0] * (count - len(values)) if values else [float("nan")] * count


def _take_face(lines: _Lines, words: list[bytes]) -> None:
    polygon = [_corner(lines, word) for word in words]
    for k in range(1, len(polygon) - 1):
        for corner in (polygon[0], polygon[k], polygon[k + 1]):
            lines.corners.extend(corner)
        lines.face_material.append(lines.current)


def _corner(lines: _Lines, word: bytes) -> tuple[int, int, int]:
    """Return the indices of ``v/vt/vn``; negative ones count from the last line, 0 is not valid."""
    parts = word.split(b"/")
    sizes = (len(lines.positions) // 3, len(lines.coordinates) // 2, len(lines.normals) // 3)
    result = [-1, -1, -1]
    for k, part in enumerate(parts[:3]):
        if part:
            index = int(part)
            result[k] = index - 1 if index > 0 else sizes[k] + index
            if index == 0 or result[k] < 0:
                want = "want 1 or more, or a negative one in range"
                raise ValueError(f"a face refers to entry {index}, {want}")
    return result[0], result[1], result[2]


def _library(
    reference: str, path: Path, files: InputFiles, notes: list[str]
) -> dict[str, Material]:
    try:
        location = files.find(reference, path.parent)
        text = files.read(location)
    except FileNotFoundError:
        notes.append(f"The material library {reference} is missing; plain materials were used.")
        return {}
    return read_mtl(text, location.parent, files, notes)


def _assemble(
    lines: _Lines, library: dict[str, Material], notes: list[str], name: str, max_faces: int
) -> Soup:
    require_at_most(name, len(lines.face_material), max_faces, "faces")
    corners = np.array(lines.corners, dtype=np.int64).reshape(-1, 3, 3)
    face_material = np.array(lines.face_material, dtype=np.int64)
    used = list(lines.names)
    unknown = [n for n in used if n not in library]
    if unknown and library:
        lacking = f"Materials {', '.join(sorted(unknown)[:5])} are in no library"
        notes.append(f"{lacking}; plain ones were used.")
    originals = [library.get(n, Material(n)) for n in used]
    if (face_material < 0).any():
        face_material = np.where(face_material < 0, len(originals), face_material)
        originals.append(Material("default"))
    safe = unique_names(m.name for m in originals)
    named = tuple(replace(m, name=n) for n, m in zip(safe, originals, strict=True))
    positions = _gather(lines.positions, corners[..., 0], 3, name)
    if (corners[..., 0] < 0).any():
        raise unreadable(name, "a face has a corner without a vertex")
    return Soup(
        corners=np.zeros((0, 3, 3)) if positions is None else positions,
        uv=_gather(lines.coordinates, corners[..., 1], 2, name),
        normals=_gather(lines.normals, corners[..., 2], 3, name),
        face_material=face_material,
        materials=named or (Material("default"),),
        notes=tuple(notes),
    )


def _gather(values: array[float], indices: IntArray, width: int, name: str) -> FloatArray | None:
    """Return what corners refer to, NaN for those that name nothing; ``None`` if none does."""
    if not (indices >= 0).any():
        return None
    table = np.array(values, dtype=np.float64).reshape(-1, width)
    if indices.max() >= len(table):
        wrong = f"a face refers to entry {indices.max() + 1}, but there are {len(table)}"
        raise unreadable(name, wrong)
    # The last row, which -1 means.
    return np.vstack([table, np.full(width, np.nan)])[indices]


def read_mtl(data: bytes, folder: Path, files: InputFiles, notes: list[str]) -> dict[str, Material]:
    """Return materials by name; a diffuse map replaces the diffuse colour, as in modelling tools.

    Maps are relative to ``folder``; sentences about missing and broken ones are added to ``notes``.

    Raises:
        InputRejected: ``external_reference`` or ``too_large`` for a map.
    """
    require_at_most("material library", len(data), _MAX_BYTES, "bytes")

    @cache
    def texture(reference: str) -> Texture | None:
        return read_texture(
            reference, partial(files.read_reference, reference, folder), files, notes
        )

    result: dict[str, Material] = {}
    name: str | None = None
    for line in data.decode("utf-8", "replace").splitlines():
        keyword, _, rest = line.strip().partition(" ")
        rest = rest.strip()
        if keyword == "newmtl":
            name = rest
            result[name] = Material(name)
        elif name is not None:
            result[name] = _changed(result[name], keyword.lower(), rest, texture)
    return result


def _changed(
    material: Material, keyword: str, rest: str, load: Callable[[str], Texture | None]
) -> Material:
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
        texture = load(_without_options(rest))
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
