"""A registry of a million assets: how long its questions take.

One JSON line: how many times faster a count is than reading all rows, and milliseconds for each
question, each with the opening of the database: by the clock (the best of several, for a machine
that does other things too) and of the processor (the median).
The rows are made up; no asset has files.
The number of rows can be given: ``registry_size.py 100000``.
"""

from __future__ import annotations

import json
import random
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from statistics import median

from asset_factory.factory.errors import RegistryError
from asset_factory.factory.registry import Entry, Registry
from asset_factory.factory.registry.database import connected, writing
from asset_factory.factory.registry.rebuild import new_database
from asset_factory.factory.registry.rows import RegistryRow, having, insert
from asset_factory.factory.runtime.store import digest_bytes

ROWS = 1_000_000
TIMES = 15
CATEGORIES = tuple(f"category_{number}" for number in range(60))
REASONS = ("penetration", "joint_blocked", "load_failed", "build_timeout", "rest_penetration")
LICENSES = ("CC-BY-4.0", "CC0-1.0", "", "CC-BY-NC-4.0")


def made_up(count: int) -> Iterator[RegistryRow]:
    """Rows as different as real ones."""
    chance = random.Random(0)  # noqa: S311 - not a secret
    for number in range(count):
        digest = digest_bytes(str(number).encode())
        category = chance.choice(CATEGORIES)
        passed = chance.random() < 0.7
        # One reason is rare, and one row in ten thousand has a tag.
        reason = "" if passed else "rare" if chance.random() < 1e-5 else chance.choice(REASONS)
        entry = Entry(
            id=f"{category}-{digest[:10]}",
            name=category,
            category=category,
            status="passed" if passed else "unjudged" if reason == "build_timeout" else "rejected",
            reason=reason,
            parts=chance.randrange(2, 9),
            joints=chance.randrange(1, 8),
            hulls=chance.randrange(2, 200),
            key=digest,
            message=""
            if passed
            else "the door hits the frame at 0.4 rad, 12 mm deep, want at most 2 mm",
            license=chance.choice(LICENSES),
            tags=("chosen",) if chance.random() < 1e-4 else (),
            solved=chance.choice(("", "yes", "no")) if passed else "",
        )
        yield RegistryRow(entry, digest)


def milliseconds(ask: Callable[[], object]) -> tuple[float, float]:
    """Best time by the clock, and median of the processor's [ms]."""
    wall = []
    busy = []
    for _ in range(TIMES):
        started = time.perf_counter()
        worked = time.process_time()
        ask()
        wall.append((time.perf_counter() - started) * 1e3)
        busy.append((time.process_time() - worked) * 1e3)
    return round(min(wall), 2), round(median(busy), 2)


def unknown(registry: Registry, asset_id: str) -> None:
    """Ask for what is not there; the answer names what is near."""
    try:
        registry.entry(asset_id)
    except RegistryError:
        return
    raise AssertionError(asset_id)


def questions(registry: Registry) -> dict[str, Callable[[], object]]:
    """What commands and jobs ask."""
    some = registry.entries(category=CATEGORIES[31], limit=100)[-1]
    return {
        "open": lambda: Registry(registry.root),
        "lookup": lambda: registry.entry(some.id),
        "did_you_mean": lambda: unknown(registry, some.id[:-3] + "xyz"),
        "known_key": lambda: registry.known_keys((some.key,)),
        "page": lambda: registry.entries(limit=200),
        "page_in_the_middle": lambda: registry.entries(limit=200, after=some.id),
        "status": lambda: registry.entries(status="rejected", limit=200),
        "category": lambda: registry.entries(category=some.category, limit=200),
        "category_and_status": lambda: registry.entries(
            category=some.category, status="unjudged", limit=200
        ),
        "rare_reason": lambda: registry.entries(reason="rare", limit=200),
        "category_and_rare_reason": lambda: registry.entries(
            category=some.category, reason="rare", limit=200
        ),
        "nothing_at_all": lambda: registry.entries(status="passed", reason="rare", limit=200),
        "tag": lambda: registry.entries(tag="chosen", limit=200),
        "split_status_category": lambda: registry.entries(
            split="test", status="passed", category=some.category, limit=200
        ),
        "solved_and_license": lambda: registry.entries(solved="no", license="CC0-1.0", limit=200),
        "count_category": lambda: registry.count(having(category=some.category)),
        "count_all": registry.count,
        "count_status_license": lambda: registry.count(having(status="passed", license="")),
        "count_by_reading_rows": lambda: rows_read(registry),
        "note": lambda: write_row(registry, some),
    }


def rows_read(registry: Registry) -> int:
    """How many rows there are, without the counts that are kept."""
    with connected(registry.root) as connection:
        return int(connection.execute("SELECT count(*) FROM assets").fetchone()[0])


def write_row(registry: Registry, entry: Entry) -> None:
    """One row, as publishing writes it."""
    with writing(registry.root) as connection:
        insert(connection, RegistryRow(entry, ""))


def main() -> None:
    """Fill a registry and ask."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else ROWS
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder) / "out"
        started = time.perf_counter()
        root.mkdir()
        with new_database(root / "registry.db") as connection:
            for row in made_up(count):
                insert(connection, row)
        filled = time.perf_counter() - started
        registry = Registry(root, create=True)
        answers = {name: milliseconds(ask) for name, ask in questions(registry).items()}
        size = (registry.root / "registry.db").stat().st_size
    line = {
        "benchmark": "registry_size",
        "rows": count,
        "best_ms": {name: best for name, (best, _) in answers.items()},
        "processor_ms": {name: busy for name, (_, busy) in answers.items()},
        "count_speedup": round(answers["count_by_reading_rows"][0] / answers["count_all"][0], 1),
        "bytes_a_row": round(size / count),
        "filled_s": round(filled, 1),
    }
    print(json.dumps(line))


if __name__ == "__main__":
    main()
