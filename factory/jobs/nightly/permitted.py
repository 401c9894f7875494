"""Which inputs may be built, by their licences."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ...intake.licenses import is_allowed
from ...intake.naming import well_formed
from ...registry import Entry
from .attempt import PASSED, Attempt
from .settings import Licences

_MAX_BYTES = 1_000_000


@dataclass(frozen=True)
class LeftOut:
    """An input that was not built.

    Attributes:
        input: path of the file.
        licence: what its sidecar states; empty if nothing.
    """

    input: str
    licence: str


def permitted(licence: str, rules: Licences) -> bool:
    """Whether a licence is among those allowed."""
    return is_allowed(licence, rules.names)


def not_allowed(entries: Iterable[Entry], rules: Licences) -> tuple[Attempt, ...]:
    """What is registered under a licence that is not allowed: from before it was not, or built by others."""
    passed = (
        entry for entry in entries if entry.status == PASSED and not permitted(entry.license, rules)
    )
    return tuple(
        Attempt(entry.id, entry.name, entry.status, licence=entry.license) for entry in passed
    )


def sort_out(
    inputs: Sequence[Path], rules: Licences
) -> tuple[tuple[Path, ...], tuple[LeftOut, ...]]:
    """Inputs that may be built, and those whose sidecar states a licence that is not allowed.

    What only the file itself states is known once it is loaded: then it is rejected.
    """
    kept, left = [], []
    for path in inputs:
        stated = stated_licence(path) if rules.allowed else ""
        if stated and not permitted(stated, rules):
            left.append(LeftOut(well_formed(str(path)), stated))
        else:
            kept.append(path)
    return tuple(kept), tuple(left)


def stated_licence(path: Path) -> str:
    """What the sidecar of an input states; empty where there is none, or none that can be read: loading says why."""
    for sidecar in (path.with_name(path.name + ".toml"), path.with_name(path.stem + ".toml")):
        try:
            if sidecar.is_file() and sidecar.stat().st_size <= _MAX_BYTES:
                stated = tomllib.loads(sidecar.read_text(encoding="utf-8")).get("license", "")
                return stated.strip() if isinstance(stated, str) else ""
        except (OSError, ValueError, RecursionError):
            return ""
    return ""
