"""PartNet-Mobility: ``mobility.urdf``, meshes, ``meta.json`` (category). Fronts look along -X."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from asset_factory.factory.intake.categories import normalised

from .item import SourceItem, find_items

MAIN = "mobility.urdf"
META = "meta.json"
MAX_META_BYTES = 1_000_000


def find_partnet(root: Path) -> tuple[SourceItem, ...]:
    """Return the objects of a folder of PartNet-Mobility folders, called by their numbers."""
    found = find_items(root, _mains, lambda _: "")
    return tuple(replace(item, category=_category(item)) for item in found)


def _mains(files: Sequence[Path]) -> list[Path]:
    return [path for path in files if path.name == MAIN]


def _category(item: SourceItem) -> str:
    """Return the ``model_cat`` of its ``meta.json``; empty if there is none."""
    path = next((path for path in item.files if path == item.folder / META), None)
    try:
        if path is None or path.stat().st_size > MAX_META_BYTES:
            return ""
        stated = json.loads(path.read_text(encoding="utf-8"))["model_cat"]
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return ""
    return normalised(words(stated)) if isinstance(stated, str) else ""


def words(name: str) -> str:
    """Split ``StorageFurniture`` into ``Storage Furniture``."""
    return re.sub("(?<=[^A-Z])(?=[A-Z])", " ", name)
