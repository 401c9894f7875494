"""The frozen list of real objects: which, what they are, and which half may be tuned on."""

from __future__ import annotations

import csv
import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

from asset_factory.factory.errors import ConfigError

HALVES = ("develop", "report")
COLUMNS = ("path", "source", "category", "digest", "shape", "half", "front_yaw")
#: The list that comes with the package.
REAL = "evaluation/real.csv"


@dataclass(frozen=True)
class Listed:
    """One object of a list.

    Attributes:
        path: of its URDF or MJCF, relative to the folder of data, with ``/``.
        source: where it is from; a folder's name.
        category: what it is, a best guess.
        digest: SHA-256 of the description file.
        shape: path of the first object of the list with the same surface, perhaps its own.
        half: ``develop`` to make choices on, ``report`` to be looked at when all choices are made.
        front_yaw: turn about z that brings its front to -Y [deg]; ``None`` without a front.
    """

    path: str
    source: str
    category: str
    digest: str
    shape: str
    half: str
    front_yaw: float | None

    @property
    def name(self) -> str:
        """Return the path without its last suffix and with ``__`` for ``/``: a file's name."""
        return str(Path(self.path).with_suffix("")).replace("/", "__")


def half_of(shape: str) -> str:
    """Return the half of objects with one surface: parity of its first path's SHA-256.

    Objects that are the same fall into the same half, and a new object changes no other's.
    """
    return HALVES[hashlib.sha256(shape.encode()).digest()[0] % 2]


def read_list(path: Path | None = None) -> tuple[Listed, ...]:
    """Read a CSV file with the columns ``COLUMNS``; the package's own by default.

    Raises:
        ConfigError: it is not there, a column or a value is missing, or a half is not the rule's.
    """
    return tuple(_rows(list_text(path).splitlines(), REAL if path is None else path.name))


def list_text(path: Path | None = None) -> str:
    """Return the text of a list; arguments and errors as for :func:`read_list`."""
    if path is None:
        return (resources.files("asset_factory.configs") / REAL).read_text(encoding="utf-8")
    if not path.is_file():
        raise ConfigError(f"{path}: no such list; want a CSV with columns {', '.join(COLUMNS)}")
    return path.read_text(encoding="utf-8")


def _rows(lines: list[str], name: str) -> Iterator[Listed]:
    reader = csv.DictReader(lines)
    missing = [column for column in COLUMNS if column not in (reader.fieldnames or ())]
    if missing:
        raise ConfigError(f"{name}: has no column {missing[0]!r}; want {', '.join(COLUMNS)}")
    for number, row in enumerate(reader, start=2):
        values: dict[str, Any] = {column: row[column] or "" for column in COLUMNS}
        if not (values["path"] and values["digest"] and values["shape"]):
            raise ConfigError(f"{name}, line {number}: want a path, a digest and a shape")
        half = half_of(values["shape"])
        if values["half"] != half:
            said = values["half"]
            raise ConfigError(f"{name}, line {number}: half is {said!r}, want {half!r}")
        try:
            front = float(values["front_yaw"]) if values["front_yaw"] else None
        except ValueError:
            raise ConfigError(
                f"{name}, line {number}: front_yaw must be degrees, not {values['front_yaw']!r}"
            ) from None
        yield Listed(**values | {"front_yaw": front})
