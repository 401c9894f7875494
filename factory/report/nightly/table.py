"""``attempts.parquet``: a row per try of an input (the only file that says ``pyarrow``)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, get_type_hints

from asset_factory.sim_checks import Status

from ...runtime.store import writing
from .night import NightResult, attempt_from, latest

#: Reason of a try that was followed by another.
DIED = "tried_again"
DIED_MESSAGE = "its process crashed, hung or ran out of memory, and the input was tried again"
STAGE_PREFIX = "seconds_"


def write_table(path: Path, tried: Sequence[NightResult]) -> None:
    """Write a night's tries by input: those that died too, and those of its earlier runs.

    A column for each field of an attempt, ``attempt`` and ``last``, and a column
    ``seconds_<stage>`` for each stage that any of them went through.

    A reader sees the old file or the new one, never half of it.
    """
    import pyarrow as pa
    from pyarrow import parquet

    kinds = {str: pa.string(), Status: pa.string(), int: pa.int32(), float: pa.float64()}
    kinds[tuple[str, ...]] = pa.list_(pa.string())
    hints = get_type_hints(NightResult).items()
    columns = {name: kinds[hint] for name, hint in hints if hint in kinds}
    columns |= {"attempt": pa.int32(), "last": pa.bool_()}
    stages = sorted({stage for attempt in tried for stage in attempt.stages})
    columns |= {STAGE_PREFIX + stage: pa.float64() for stage in stages}

    table = pa.Table.from_pylist(list(_rows(tried)), schema=pa.schema(columns))
    with writing(path) as file:
        parquet.write_table(table, file, compression="zstd")


def _rows(tried: Sequence[NightResult]) -> Iterator[dict[str, Any]]:
    final = {id(attempt) for attempt in latest(tried)}
    for attempt in sorted(tried, key=lambda item: item.input):
        tries = attempt.attempts
        died = NightResult(
            attempt.id, attempt.input, Status.UNJUDGED, DIED, DIED_MESSAGE, attempts=tries
        )
        for number in range(1, tries):
            yield _row(died, number, last=False) | {"seconds": None}
        last = id(attempt) in final
        if last or not attempt.known:
            yield _row(attempt, tries, last=last)


def _row(attempt: NightResult, number: int, *, last: bool) -> dict[str, Any]:
    told = asdict(attempt)
    stages = {STAGE_PREFIX + stage: seconds for stage, seconds in attempt.stages.items()}
    return {**told, **stages, "attempt": number, "last": last}


def read_table(path: Path) -> tuple[NightResult, ...]:
    """Read a night's attempts, one per input; empty where no table can be read."""
    import pyarrow as pa
    from pyarrow import parquet

    try:
        rows = parquet.read_table(path).to_pylist()
    except (OSError, pa.ArrowInvalid):
        return ()
    return tuple(_attempt(row) for row in rows if row.get("last", True))


def _attempt(row: dict[str, Any]) -> NightResult:
    told = {name: value for name, value in row.items() if value is not None}
    prefixed = {name: value for name, value in told.items() if name.startswith(STAGE_PREFIX)}
    stages = {name.removeprefix(STAGE_PREFIX): value for name, value in prefixed.items()}
    return attempt_from({**told, "stages": stages})
