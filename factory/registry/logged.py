"""The log of builds: JSON lines to read while a job runs; times are here, not in artefacts."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..runtime.layout import LOGS

if TYPE_CHECKING:
    from asset_factory.sim_checks.processes.isolation import Outcome

    from .product import Product
    from .result import Result

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


class Log:
    """Appends to ``logs/builds.jsonl`` of a registry; several jobs may at once.

    Args:
        output: the registry's folder.
    """

    def __init__(self, output: Path) -> None:
        path = output / LOG_NAME
        path.parent.mkdir(parents=True, exist_ok=True)
        self._descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o644)

    def close(self) -> None:
        """Close the log."""
        os.close(self._descriptor)

    def begun(self, inputs: int, known: int) -> None:
        """Write that a job began to build."""
        self._write("begun", {"inputs": inputs, "known": known})

    def built(self, result: Result, outcome: Outcome[Product]) -> None:
        """Write that an input was built, or failed: time per stage, its process's last output."""
        product = outcome.value
        stages = [
            {"stage": stage, "seconds": round(seconds, 4), "reused": stage in result.reused}
            for stage, seconds in result.stages.items()
        ]
        said = {} if product is not None else {"failure": outcome.failure, "output": outcome.output}
        built = {
            "id": result.entry.id,
            "input": result.input,
            "status": result.entry.status,
            "reason": result.entry.reason,
            "attempts": result.attempts,
            "seconds": round(result.seconds, 4),
            "stages": stages,
        }
        self._write("built", {**built, **said})

    def ended(self, state: str, built: int, left: int) -> None:
        """Write that a job ended, and how."""
        self._write("ended", {"state": state, "built": built, "left": left})

    def _write(self, event: str, data: dict[str, Any]) -> None:
        moment = datetime.now(UTC).isoformat(timespec="milliseconds")
        line = json.dumps({"time": moment, "event": event, "job": os.getpid(), **data}) + "\n"
        # One write for one line: jobs that log at the same time do not mix theirs.
        os.write(self._descriptor, line.encode())
