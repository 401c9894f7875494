"""A thousand workers and ten million meshes, played through: what is full first, and when.

Nothing is built. Each worker draws how long a build takes from measured ones, is lost now and then,
gets its input from the head and sends its bundle through the store; one head takes every answer,
one at a time, as the command does. Prints a JSON line for each number of workers: assets a second,
how busy the head and the line are, and whichever of them is busiest; the last line adds up what ten
million meshes take.

Times are of ``logs/builds.jsonl`` of a registry, which can be named; else of the eleven example
meshes on one of two shared processors. The head's share of an asset is what ``build_overhead.py``
(28 ms) and ``ray_overhead.py`` (4 ms) say on a busy machine. Sizes, losses and the line's speed are
assumed.
"""

from __future__ import annotations

import heapq
import json
import random
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

#: Of one build [s].
BUILDS_S = (44.3, 26.1, 31.7, 110.1, 36.4, 107.1, 18.8, 165.1, 19.9, 42.8, 97.0)
WORKERS = (10, 100, 300, 1_000, 3_000)
MESHES = 10_000_000
#: So long is played, after as long again that is not counted [s].
PLAYED_S = 3_600.0
DAY_S = 86_400.0


@dataclass(frozen=True)
class Costs:
    """What one asset costs beside its build.

    Attributes:
        head_s: of the head's one thread: hand out, take back, verify the digest, register [s].
        bundle_bytes: through the store, twice [bytes].
        input_bytes: from the head to a worker, and in the head's object store until then [bytes].
        store_bytes_s: what the store and the head's line carry [bytes/s].
        row_bytes: of the index [bytes].
        call_bytes: of the head's memory, for a call that is under way [bytes].
        loss: share of builds whose worker is lost in the middle.
    """

    head_s: float = 0.032
    bundle_bytes: float = 1.0e6
    input_bytes: float = 1.0e6
    store_bytes_s: float = 125e6
    row_bytes: float = 600.0
    call_bytes: float = 20e3
    loss: float = 0.002

    @property
    def line_bytes(self) -> float:
        """Over the head's line for each asset [bytes]."""
        return 2.0 * self.bundle_bytes + self.input_bytes


def played(workers: int, builds: Sequence[float], costs: Costs) -> dict[str, float | int | str]:
    """Play so many workers; both the head and the line serve one asset at a time."""
    chance = random.Random(0)  # noqa: S311 - not a secret
    ends = [(chance.choice(builds) * chance.random(), number) for number in range(workers)]
    heapq.heapify(ends)
    line_free = 0.0
    head_free = 0.0
    line_busy = 0.0
    head_busy = 0.0
    done = 0
    waited = 0.0
    line_s = costs.line_bytes / costs.store_bytes_s
    while ends[0][0] < 2.0 * PLAYED_S:
        now, number = heapq.heappop(ends)
        if chance.random() < costs.loss:
            heapq.heappush(ends, (now + chance.choice(builds), number))
            continue
        line_free = max(now, line_free) + line_s
        head_free = max(line_free, head_free) + costs.head_s
        if now >= PLAYED_S:
            done += 1
            line_busy += line_s
            head_busy += costs.head_s
            waited += head_free - now
        # A worker's second call lies ready, as long as the head is no more than that behind.
        late = max(0.0, head_free - now - chance.choice(builds))
        heapq.heappush(ends, (now + late + chance.choice(builds), number))
    busy = {"head": head_busy / PLAYED_S, "store": line_busy / PLAYED_S}
    rate = done / PLAYED_S
    wished = workers / (sum(builds) / len(builds))
    return {
        "workers": workers,
        "assets_per_s": round(rate, 3),
        "of_what_workers_could": round(rate / wished, 3),
        "head_busy": round(min(1.0, busy["head"]), 3),
        "store_busy": round(min(1.0, busy["store"]), 3),
        "waits_s": round(waited / max(1, done), 3),
        "full_first": max(busy, key=lambda name: busy[name]),
        "days_for_ten_million": round(MESHES / rate / DAY_S, 1),
        "head_mb_for_calls": round(2 * workers * (costs.call_bytes + costs.input_bytes) / 1e6, 1),
    }


def measured(registry: Path) -> tuple[float, ...]:
    """Times of builds that a registry's log tells [s]."""
    lines = (registry / "logs" / "builds.jsonl").read_text(encoding="utf-8").splitlines()
    events = (json.loads(line) for line in lines)
    return tuple(event["seconds"] for event in events if event["event"] == "built")


def main() -> None:
    """Play every number of workers."""
    builds = measured(Path(sys.argv[1])) if len(sys.argv) > 1 else BUILDS_S
    costs = Costs()
    for workers in WORKERS:
        print(json.dumps(played(workers, builds, costs)))
    print(
        json.dumps(
            {
                "meshes": MESHES,
                "index_gb": round(MESHES * costs.row_bytes / 1e9, 1),
                "assets_tb": round(MESHES * costs.bundle_bytes / 1e12, 1),
                "head_saturates_at_workers": round(sum(builds) / len(builds) / costs.head_s),
                "store_saturates_at_workers": round(
                    sum(builds) / len(builds) * costs.store_bytes_s / costs.line_bytes
                ),
            }
        )
    )


if __name__ == "__main__":
    main()
