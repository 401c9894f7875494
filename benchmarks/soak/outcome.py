"""What a build left behind, in a form that two builds can be compared by."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

from asset_factory.factory.registry import Registry
from asset_factory.factory.runtime.store import digest_file

#: What a registry is for; everything else in its folder is a database of it, a cache or a log.
LASTING = ("assets", "rejected")
#: What nobody may find once ``factory gc`` is done.
PASSING = (".staging", ".claims")


def content(output: Path) -> dict[str, str]:
    """SHA-256 of every lasting file, by path within the output."""
    files = [path for name in LASTING for path in (output / name).rglob("*") if path.is_file()]
    return {path.relative_to(output).as_posix(): digest_file(path) for path in files}


def rows(output: Path) -> list[dict[str, Any]]:
    """Every row of the registry, by id."""
    return [asdict(entry) for entry in Registry(output).entries()]


def leftovers(output: Path) -> list[str]:
    """Half-made things, by path within the output."""
    found = [
        path for name in PASSING if (output / name).is_dir() for path in (output / name).iterdir()
    ]
    found += list(output.rglob(".writing-*"))
    return sorted(path.relative_to(output).as_posix() for path in found)
