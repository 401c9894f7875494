"""Tables of an export's assets that can be read without the assets."""

from __future__ import annotations

import importlib
import io
import json
from dataclasses import asdict
from typing import Any

from ..entry import Entry
from ..split import SPLITS

#: What a row has of its entry.
_COLUMNS = (
    *("id", "name", "category", "split", "status", "reason", "message", "parts", "joints", "hulls"),
    *("license", "solved", "tags", "key"),
)


def described(entry: Entry, folder: str, manifest: bytes | None) -> dict[str, Any]:
    """Return one row: the entry, where its files are in the export, and its manifest's physics."""
    data: dict[str, Any] = json.loads(manifest) if manifest is not None else {}
    lower, upper = data.get("closed_bounds") or ([0.0] * 3, [0.0] * 3)
    moving = [joint["kind"] for joint in data.get("joints", ()) if joint["kind"] != "fixed"]
    values = asdict(entry)
    return {
        **{name: list(values[name]) if name == "tags" else values[name] for name in _COLUMNS},
        "folder": folder,
        "urdf": f"{folder}/{data['urdf']}" if "urdf" in data else "",
        "mjcf": f"{folder}/{data['mjcf']}" if data.get("mjcf") else "",
        "joint_types": moving,
        "mass_kg": float(data.get("mass", 0.0)),
        "size_m": [round(b - a, 6) for a, b in zip(lower, upper, strict=True)],
    }


def metadata_files(rows: list[dict[str, Any]]) -> dict[str, bytes]:
    """Return one table per split that has assets: Parquet with pyarrow, else JSON lines."""
    try:
        writer: Any = importlib.import_module("pyarrow.parquet")
        arrow: Any = importlib.import_module("pyarrow")
    except ImportError:
        writer = arrow = None
    files = {}
    for split in SPLITS:
        chosen = [row for row in rows if row["split"] == split]
        if not chosen:
            continue
        if arrow is None:
            files[f"metadata/{split}.jsonl"] = "".join(
                json.dumps(row) + "\n" for row in chosen
            ).encode()
        else:
            buffer = io.BytesIO()
            writer.write_table(arrow.Table.from_pylist(chosen, schema=_schema(arrow)), buffer)
            files[f"metadata/{split}.parquet"] = buffer.getvalue()
    return files


def _schema(arrow: Any) -> Any:
    """Return the types that do not depend on what the first rows happen to hold."""
    text = arrow.string()
    texts = arrow.list_(arrow.string())
    special = {
        **dict.fromkeys(("parts", "joints", "hulls"), arrow.int64()),
        **dict.fromkeys(("tags", "joint_types"), texts),
        "mass_kg": arrow.float64(),
        "size_m": arrow.list_(arrow.float64()),
    }
    names = (*_COLUMNS, "folder", "urdf", "mjcf", "joint_types", "mass_kg", "size_m")
    return arrow.schema([(name, special.get(name, text)) for name in names])
