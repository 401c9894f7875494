"""What an evaluation writes: JSON of everything, CSV with a line per case; no times in either."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from asset_factory.factory.mesh import Mesh
from asset_factory.factory.runtime.store import write_json, write_whole

from .score import Score
from .summary import compared, in_order, rounded, summarised
from .trial import Row

JSON_NAME = "evaluation.json"
CSV_NAME = "cases.csv"


def write_results(folder: Path, rows: Sequence[Row], settings: dict[str, Any]) -> dict[str, Any]:
    """Write both files, the same bytes for the same numbers; returns what the JSON file holds.

    Rows come in any order; ``settings`` have no paths of this machine.
    """
    folder.mkdir(parents=True, exist_ok=True)
    lines = [_line(row) for row in in_order(rows)]
    data = {"settings": settings, "summary": summarised(rows), "paired": compared(rows)}
    data["cases"] = lines
    write_json(folder / JSON_NAME, data)
    write_whole(folder / CSV_NAME, _table(lines).encode())
    return data


def _line(row: Row) -> dict[str, Any]:
    trial = row.trial
    request = trial.request
    score = row.score or Score({})
    told = {"method": trial.method.name, "case": request.name, "repeat": trial.repeat}
    told |= {name: getattr(request, name) for name in ("source", "category", "pose", "yaw")}
    values = {name: rounded(value) for name, value in score.values.items()}
    parts = {name: [rounded(v) for v in each] for name, each in score.pooled.items()}
    return told | {"failure": row.failure, "values": values, "parts": parts}


def _table(lines: Sequence[dict[str, Any]]) -> str:
    """Write a column per value; those of parts become their means, blank without any."""
    fixed = ("method", "case", "repeat", "source", "category", "pose", "yaw", "failure")
    values = dict.fromkeys(name for line in lines for name in line["values"])
    parts = dict.fromkeys(name for line in lines for name in line["parts"])
    text = io.StringIO()
    columns = [*fixed, *values, *parts]
    writer = csv.DictWriter(text, columns, extrasaction="ignore", lineterminator="\n")
    writer.writeheader()
    for line in lines:
        means = {name: rounded(np.mean(each)) for name, each in line["parts"].items() if each}
        writer.writerow(line | line["values"] | means)
    return text.getvalue()


def write_obj(path: Path, mesh: Mesh) -> None:
    """Write a mesh fit to be published: faces in its own order, numbers that read back exactly."""
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in mesh.vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (mesh.faces + 1).tolist()]
    write_whole(path, ("\n".join(lines) + "\n").encode())
