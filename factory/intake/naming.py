"""Safe names for assets, from the names of files."""

import re
from pathlib import Path

MAX_LENGTH = 60
#: File names that say nothing; the folder's name says more.
GENERIC_STEMS = frozenset({"asset", "mesh", "mobility", "model", "object", "scene"})


def safe_name(path: Path) -> str:
    """Return an asset's name, of letters, digits, ``_``, ``-``, e.g. ``kitchen_cabinet``.

    A generic stem such as ``mobility.urdf`` is preceded by its folder's name.
    """
    cleaned = re.sub(r"[^A-Za-z0-9_-]+", "_", full_name(path)).strip("_-")
    return cleaned[:MAX_LENGTH] or "asset"


def full_name(path: Path) -> str:
    """Return what :func:`safe_name` makes safe and short."""
    folder = path.absolute().parent.name
    return f"{folder}_{path.stem}" if path.stem.lower() in GENERIC_STEMS and folder else path.stem


def well_formed(text: str) -> str:
    """Return a text as UTF-8 can be written: file names may hold surrogate-escaped raw bytes."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")
