"""Which objects are for training: lists of names, and a division that growth does not change."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path

from asset_factory.factory.errors import ConfigError


def read_split(path: Path) -> frozenset[str]:
    """Return the names in a text file, one per line; ``#`` begins a comment.

    Raises:
        ConfigError: there is no such file, or it names nothing.
    """
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(f"split {path}: cannot be read: {error}") from error
    names = frozenset(line.split("#", 1)[0].strip() for line in lines) - {""}
    if not names:
        raise ConfigError(f"split {path}: names no object, want a name per line")
    return names


def is_held_out(name: str, share: float) -> bool:
    """Return whether an object is held out: by its name alone, so that more objects move none."""
    number = int.from_bytes(hashlib.sha256(name.encode()).digest()[:8], "big")
    return number < share * 2.0**64


def write_split(path: Path, names: Iterable[str], share: float) -> tuple[Path, Path]:
    """Write ``<path>.train.txt`` and ``<path>.held_out.txt``; return both.

    About ``share`` of the names are held out.
    """
    ordered = sorted(names)
    paths = path.with_name(f"{path.name}.train.txt"), path.with_name(f"{path.name}.held_out.txt")
    for target, held_out in zip(paths, (False, True), strict=True):
        chosen = [name for name in ordered if is_held_out(name, share) is held_out]
        target.write_text("".join(f"{name}\n" for name in chosen), encoding="utf-8", newline="\n")
    return paths
