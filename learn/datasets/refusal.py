"""Why an object is passed over, kept so that it is not asked again."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path

from asset_factory.factory.runtime.store import write_whole


@dataclass(frozen=True)
class ItemRefusal:
    """Why an object is passed over: a stable code, and one sentence."""

    reason: str
    message: str


def write_refusal(path: Path, refusal: ItemRefusal) -> None:
    """Write JSON, complete or not there."""
    write_whole(path, json.dumps(asdict(refusal)).encode())


def read_refusal(path: Path) -> ItemRefusal | None:
    """Return the refusal kept in a file; ``None`` if there is none, or it is damaged."""
    try:
        said = json.loads(path.read_text(encoding="utf-8"))
        return ItemRefusal(str(said["reason"]), str(said["message"]))
    except (OSError, ValueError, KeyError, TypeError):
        return None
