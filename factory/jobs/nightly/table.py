"""``attempts.parquet``: a row per attempt (the only room that says ``pyarrow``)."""

from __future__ import annotations

from collections.abc import Sequence
from math import isnan
from pathlib import Path
from typing import Any

from ...errors import ConfigError
from ...runtime.store import writing
from .attempt import COLUMNS, Attempt, Try, attempt_from

STAGE_PREFIX = "seconds_"
_TYPES = {"seconds": "float64", **dict.fromkeys(("attempts", "parts", "joints", "hulls"), "int32")}


def require_pyarrow() -> None:
    """Raises ConfigError where there is no pyarrow: before the night, not after it."""
    try:
        import pyarrow.parquet  # noqa: F401
    except ImportError as error:
        raise ConfigError(
            f"a night's table needs {error.name}: pip install 'asset-factory[nightly]'"
        ) from error


def write_table(path: Path, tries: Sequence[Try]) -> None:
    """Write tries in their order; a column ``seconds_<stage>`` for each stage that any of them went through.

    A reader sees the old file or the new one, never half of it.
    """
    import pyarrow as pa
    from pyarrow import parquet

    attempts = [item.attempt for item in tries]
    stages = sorted({stage for attempt in attempts for stage in attempt.stages})
    columns: dict[str, list[Any]] = {
        name: [getattr(attempt, name) for attempt in attempts] for name in COLUMNS
    }
    columns["seconds"] = [
        None if isnan(attempt.seconds) else attempt.seconds for attempt in attempts
    ]
    columns |= {"attempt": [item.number for item in tries], "last": [item.last for item in tries]}
    columns |= {
        STAGE_PREFIX + stage: [attempt.stages.get(stage) for attempt in attempts]
        for stage in stages
    }
    types = [(name, _TYPES.get(name, "string")) for name in COLUMNS]
    types += [("attempt", "int32"), ("last", "bool")]
    types += [(STAGE_PREFIX + stage, "float64") for stage in stages]
    schema = pa.schema(
        [
            pa.field(name, pa.list_(pa.string()) if name == "reused" else pa.type_for_alias(kind))
            for name, kind in types
        ]
    )
    with writing(path) as file:
        parquet.write_table(pa.Table.from_pydict(columns, schema=schema), file, compression="zstd")


def read_table(path: Path) -> tuple[Attempt, ...]:
    """What a night says of its inputs, one attempt each; empty where there is no table, or none that can be read."""
    import pyarrow as pa
    from pyarrow import parquet

    try:
        rows = parquet.read_table(path).to_pylist()
    except (OSError, pa.ArrowInvalid):
        return ()
    return tuple(_attempt(row) for row in rows if row.get("last", True))


def _attempt(row: dict[str, Any]) -> Attempt:
    known = {name: row[name] for name in COLUMNS if row.get(name) is not None}
    stages = {
        name.removeprefix(STAGE_PREFIX): value
        for name, value in row.items()
        if name.startswith(STAGE_PREFIX) and value is not None
    }
    return attempt_from({**known, "stages": stages})
