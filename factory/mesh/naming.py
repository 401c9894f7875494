"""Safe names for assets, from the names of files."""

from __future__ import annotations

import re
from pathlib import Path

MAX_LENGTH = 60
#: File names that say nothing; the folder's name says more.
GENERIC_STEMS = frozenset({"asset", "mesh", "mobility", "model", "object", "scene"})


def safe_name(path: Path) -> str:
    """A name of letters, digits, ``_`` and ``-`` for the asset in ``path``, e.g. ``kitchen_cabinet``.

    A generic stem such as ``mobility.urdf`` is preceded by its folder's name.
    """
    stem = path.stem
    if stem.lower() in GENERIC_STEMS and path.absolute().parent.name:
        stem = f"{path.absolute().parent.name}_{stem}"
    cleaned = re.sub(r"[^A-Za-z0-9_-]+", "_", stem).strip("_-")
    return cleaned[:MAX_LENGTH] or "asset"
