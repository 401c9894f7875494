"""The frozen list of real objects: which, what they are, and which half may be tuned on.

A list is a CSV file with a row for each object: the path of its URDF or MJCF, relative to the
folder of data; its source, a folder's name; its category, a best guess; the SHA-256 of the
description; the shape, which is the path of the first object of the list with the same surface,
perhaps its own; the half, ``develop`` to make choices on, ``report`` to be looked at when all
choices are made; the turn about z that brings its front to -Y [deg], blank without a front.
"""

from __future__ import annotations

import csv
import hashlib
from importlib import resources
from pathlib import Path

from asset_factory.factory.errors import ConfigError

from .cases import Request

HALVES = ("develop", "report")
COLUMNS = ("path", "source", "category", "digest", "shape", "half", "front_yaw")
#: The list that comes with the package.
REAL = "evaluation/real.csv"


def half_of(shape: str) -> str:
    """Return the half of objects with one surface: parity of its first path's SHA-256.

    Objects that are the same fall into the same half, and a new object changes no other's.
    """
    return HALVES[hashlib.sha256(shape.encode()).digest()[0] % 2]


def list_text(path: Path | None = None) -> str:
    """Return the text of a list, the package's own by default.

    Raises:
        ConfigError: it is not there.
    """
    if path is None:
        return (resources.files("asset_factory.configs") / REAL).read_text(encoding="utf-8")
    if not path.is_file():
        raise ConfigError(f"{path}: no such list; want a CSV with columns {', '.join(COLUMNS)}")
    return path.read_text(encoding="utf-8")


def real_requests(root: Path, half: str | None, path: Path | None = None) -> tuple[Request, ...]:
    """Return the objects of a list, ``develop``, ``report`` or (``None``) both halves.

    The list is the package's own by default; its paths start from ``root``.

    Raises:
        ConfigError: it is not there, a column or a value is missing, a half is not the rule's, or
            an object is not there.
    """
    name = REAL if path is None else path.name
    reader = csv.DictReader(list_text(path).splitlines())
    missing = [column for column in COLUMNS if column not in (reader.fieldnames or ())]
    if missing:
        raise ConfigError(f"{name}: has no column {missing[0]!r}; want {', '.join(COLUMNS)}")
    found = []
    for number, row in enumerate(reader, start=2):
        told = {column: row[column] or "" for column in COLUMNS}
        request = _request(told, root, f"{name}, line {number}")
        if half in (None, told["half"]):
            found.append(request)
    for each in found:
        if each.file is None or not each.file.is_file():
            wanted = "want the folder of data that the list is about"
            raise ConfigError(f"{each.file}: no such file; {wanted}")
    return tuple(found)


def _request(row: dict[str, str], root: Path, where: str) -> Request:
    """Return the object of one row; ``where`` it is, for messages."""
    if not (row["path"] and row["digest"] and row["shape"]):
        raise ConfigError(f"{where}: want a path, a digest and a shape")
    half = half_of(row["shape"])
    if row["half"] != half:
        raise ConfigError(f"{where}: half is {row['half']!r}, want {half!r}")
    try:
        front = float(row["front_yaw"]) if row["front_yaw"] else None
    except ValueError:
        said = f"front_yaw must be degrees, not {row['front_yaw']!r}"
        raise ConfigError(f"{where}: {said}") from None
    return Request(
        object=str(Path(row["path"]).with_suffix("")).replace("/", "__"),
        source=row["source"],
        category=row["category"],
        file=root / row["path"],
        digest=row["digest"],
        front_yaw=front,
    )
