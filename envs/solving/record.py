"""The attempts on one asset, kept beside the registry: ``solving/<id>.json``."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from asset_factory.factory.registry.entry import Solved
from asset_factory.factory.runtime.code import code_digest
from asset_factory.factory.runtime.store import write_json

from .attempt import SOLVER, Attempt

FOLDER = "solving"
#: Of the file's layout.
VERSION = 3
#: Reasons that say nothing of the joint: it is tried again by the next run.
UNJUDGED = ("crashed", "timeout", "failed")


@dataclass(frozen=True)
class SolveRecord:
    """All attempts at one asset.

    Attributes:
        asset, digest: which, and the SHA-256 of its manifest.
        rows: JSON data of each attempt, see :func:`attempt_row`; one per joint, robot and seed, in
            that order.
    """

    asset: str
    digest: str
    rows: tuple[dict[str, Any], ...] = ()

    def wants(self, joint: str, robot: str, seed: int, tries: int) -> bool:
        """Tell whether an attempt adds anything: none solved yet, this one not tried as often."""
        rows = [row for row in self.rows if row["joint"] == joint and row["seed"] == seed]
        known = [row for row in rows if row["robot"] == robot and row["reason"] not in UNJUDGED]
        tried = any(row["tries_allowed"] >= tries for row in known)
        return not tried and not any(row["solved"] for row in rows)

    def is_solved(self, joint: str, robot: str) -> bool:
        """Tell whether a robot opened a joint, with any seed."""
        rows = (row for row in self.rows if row["joint"] == joint and row["robot"] == robot)
        return any(row["solved"] for row in rows)

    def noting(self, attempt: Attempt, tries: int) -> SolveRecord:
        """Add one more attempt, of at most so many tries, in the place of an older one."""
        row = attempt_row(attempt, tries)
        rows = sorted([*(other for other in self.rows if _key(other) != _key(row)), row], key=_key)
        return replace(self, rows=tuple(rows))

    def of(self, joints: Sequence[str]) -> list[dict[str, Any]]:
        """Return attempts at some joints."""
        return [row for row in self.rows if row["joint"] in joints]

    def verdict(self, joints: Sequence[str]) -> Solved:
        """Return ``yes`` if a joint was opened, ``no`` if all were tried in vain, or empty."""
        if any(row["solved"] for row in self.rows):
            return "yes"
        tried = {row["joint"] for row in self.rows if row["reason"] not in UNJUDGED}
        return "no" if tried >= set(joints) else ""


def attempt_row(attempt: Attempt, tries: int) -> dict[str, Any]:
    """Return an attempt as JSON data: what would be the same the next time, without the actions."""
    return {
        "joint": attempt.joint,
        "robot": attempt.robot,
        "seed": attempt.seed,
        "options": attempt.options,
        "solved": attempt.solved,
        "reason": attempt.reason,
        "message": attempt.message,
        "open_fraction": round(attempt.open_fraction, 6),
        "peak_force_n": round(attempt.peak_force, 3),
        "mean_force_n": round(attempt.mean_force, 3),
        "steps": attempt.steps,
        "tries": attempt.tries,
        "tries_allowed": tries,
        "target": attempt.target,
        "kinds": list(attempt.kinds),
    }


def read_record(registry: Path, asset_id: str, digest: str) -> SolveRecord:
    """Return what this solver noted of the same asset; an empty record if there is nothing."""
    empty = SolveRecord(asset_id, digest)
    try:
        data = json.loads(_path(registry, asset_id).read_text(encoding="utf-8"))
        if data["solver"] != code_digest(*SOLVER) or data["digest"] != digest:
            return empty
        return replace(empty, rows=tuple(sorted((dict(row) for row in data["attempts"]), key=_key)))
    except (OSError, ValueError, KeyError, TypeError):
        return empty


def write_record(registry: Path, record: SolveRecord) -> None:
    """Write a record whole."""
    path = _path(registry, record.asset)
    path.parent.mkdir(exist_ok=True)
    data = {
        "version": VERSION,
        "solver": code_digest(*SOLVER),
        "asset": record.asset,
        "digest": record.digest,
        "attempts": list(record.rows),
    }
    write_json(path, data)


def _path(registry: Path, asset_id: str) -> Path:
    return registry / FOLDER / f"{asset_id}.json"


def _key(row: dict[str, Any]) -> tuple[str, str, int]:
    return str(row["joint"]), str(row["robot"]), int(row["seed"])
