"""The list of an export's digests, as ``sha256sum`` writes and checks it."""

from __future__ import annotations

import re
from pathlib import Path

from ...errors import RegistryError

_LINE = re.compile(r"([0-9a-f]{64})  ([^\n]+)")
_MAX_BYTES = 2_000_000_000


def read_sums(path: Path) -> dict[str, str]:
    """Read SHA-256 by path. Raises RegistryError if the list is not there or not one."""
    try:
        if path.is_symlink() or path.stat().st_size > _MAX_BYTES:
            raise RegistryError(f"{path}: is no list of digests")
        lines = path.read_text(encoding="utf-8").splitlines()
    except FileNotFoundError as error:
        raise RegistryError(
            f"{path.parent}: no {path.name}; want an export as `factory registry export` writes it"
        ) from error
    except (OSError, UnicodeDecodeError) as error:
        raise RegistryError(f"{path}: cannot be read ({error})") from error
    sums: dict[str, str] = {}
    for number, line in enumerate(lines, start=1):
        found = _LINE.fullmatch(line)
        if found is None or found[2] in sums:
            raise RegistryError(
                f"{path}, line {number}: want a digest, "
                "two spaces and a path that is not listed yet"
            )
        sums[found[2]] = found[1]
    return sums
