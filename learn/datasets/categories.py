"""What kind of thing an object is, as its dataset's inventory or its folder's name says."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable
from pathlib import Path, PurePosixPath

from asset_factory.factory.intake.categories import normalised

INVENTORY = "INVENTORY.csv"
MAX_BYTES = 64 * 1024 * 1024


def categories_of(root: Path) -> Callable[[str], str]:
    """Return the category by object name: the inventory's, else its start (``box`` of ``box_101``).

    The inventory is ``INVENTORY.csv`` in ``root``, with columns ``path`` and ``category``; a path
    may begin with the folders that ``root`` lies in. An inventory that cannot be read is none.
    Categories are written as the table of sizes writes them: ``fridge`` for a refrigerator.
    """
    listed = _listed(root / INVENTORY)
    above = root.resolve().parts[1:]

    def category(name: str) -> str:
        parts = PurePosixPath(name).parts
        paths = [PurePosixPath(*above[start:], *parts).as_posix() for start in range(len(above))]
        known = next((path for path in (name, *paths[::-1]) if path in listed), None)
        stated = listed[known] if known else prefix_of(parts[-1] if parts else name)
        return normalised(stated) if stated else ""

    return category


def prefix_of(name: str) -> str:
    """Return the words before a number: ``wall_cabinet`` of ``wall_cabinet_07``; may be empty."""
    match = re.match(r"[A-Za-z]+(?:[_-][A-Za-z]+)*", name)
    return match.group().lower().replace("-", "_") if match else ""


def _listed(path: Path) -> dict[str, str]:
    try:
        if path.stat().st_size > MAX_BYTES:
            return {}
        with path.open(newline="", encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file) if row.get("path") and row.get("category")]
    except (OSError, UnicodeDecodeError, csv.Error):
        return {}
    return {PurePosixPath(row["path"]).as_posix(): row["category"] for row in rows}
