"""Which inputs may be built, by their licences."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

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
    """Whether a licence is among those allowed. Case and blanks at the ends do not matter."""
    if not rules.allowed:
        return bool(licence) or rules.unknown
    if not licence:
        return rules.unknown
    return licence.strip().casefold() in {name.strip().casefold() for name in rules.allowed}


def sort_out(inputs: Sequence[Path], rules: Licences) -> tuple[tuple[Path, ...], tuple[LeftOut, ...]]:
    """Inputs that may be built, and those whose sidecar states a licence that is not allowed.

    What only the file itself states is known once it is loaded; such assets are pointed out on the page.
    """
    kept, left = [], []
    for path in inputs:
        stated = stated_licence(path) if rules.allowed else ""
        if stated and not permitted(stated, rules):
            left.append(LeftOut(str(path), stated))
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
