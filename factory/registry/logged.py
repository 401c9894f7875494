"""What the log of builds says of an asset; :mod:`..jobs.log` writes it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from ..runtime.layout import LOGS

LOG_NAME = Path(LOGS) / "builds.jsonl"


@dataclass(frozen=True)
class LoggedBuild:
    """An entry of the log on an asset's last build.

    Attributes:
        input: path of what it was made of, as it was given.
        stages: time of each stage [s], by its name.
    """

    input: str
    stages: Mapping[str, float]


def logged_build(output: Path, asset_id: str) -> LoggedBuild | None:
    """Return what the log says of an asset's last build; ``None`` where it says nothing."""
    found = None
    with suppress(OSError), (output / LOG_NAME).open(encoding="utf-8", errors="replace") as lines:
        for line in lines:
            # Few of the lines of a large registry are about one asset.
            with suppress(ValueError, LookupError, AttributeError, TypeError):
                said = json.loads(line) if asset_id in line else {}
                if said.get("id") == asset_id:
                    stages = {str(e["stage"]): float(e["seconds"]) for e in said.get("stages", ())}
                    found = LoggedBuild(str(said["input"]), stages)
    return found
