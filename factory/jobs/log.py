"""What a job did, as JSON lines to read while it runs; times are here, not in artefacts."""

from __future__ import annotations

import json
import os
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from asset_factory.sim_checks.processes.isolation import Outcome

from ..registry.logged import LOG_NAME
from ..registry.product import Product
from ..registry.result import Result


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
        self._write(
            "built",
            {
                "id": result.entry.id,
                "input": result.input,
                "status": result.entry.status,
                "reason": result.entry.reason,
                "attempts": result.attempts,
                "seconds": round(result.seconds, 4),
                "stages": stages,
                **said,
            },
        )

    def ended(self, state: str, built: int, left: int) -> None:
        """Write that a job ended, and how."""
        self._write("ended", {"state": state, "built": built, "left": left})

    def _write(self, event: str, data: dict[str, Any]) -> None:
        moment = datetime.now(UTC).isoformat(timespec="milliseconds")
        line = json.dumps({"time": moment, "event": event, "job": os.getpid(), **data}) + "\n"
        # One write for one line: jobs that log at the same time do not mix theirs.
        os.write(self._descriptor, line.encode())
