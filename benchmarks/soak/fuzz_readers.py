"""What the readers make of damaged and hostile files: a verdict within bounds, and no side effect.

Every file format that a build, a check or a checkpoint reads, damaged in thousands of ways and
attacked in a thousand more that were written by hand. A reading may end well or in a refusal with a
code. Anything else is a failure: another exception, a crash, 20 s, 2 GiB, a file opened outside the
input's folder, anything written, any address asked, any code run. One JSON line; exit code 1 if
anything failed. ``--save DIR`` keeps what failed, made as small as it gets.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cache
from itertools import islice
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "samples"))

from fuzz_cases import Case, seeds  # noqa: E402 - the attacks live with the tests
from fuzz_hostile import MESH_PAGES  # noqa: E402
from fuzz_hostile_texts import TEXT_PAGES  # noqa: E402
from fuzz_hostile_usd import USD_PAGES  # noqa: E402
from fuzz_mutations import mutated  # noqa: E402
from fuzz_trial import Trial, try_case  # noqa: E402
from hostile_descriptions import DESCRIPTION_PAGES  # noqa: E402
from hostile_meshes import LONG_PAGES  # noqa: E402
from hostile_mjcf import MJCF_PAGES  # noqa: E402
from hostile_weights import WEIGHT_PAGES  # noqa: E402

from asset_factory.sim_checks.processes.isolation import Limits, WarmChild  # noqa: E402

BATCH = 40
LIMITS = Limits(wall_s=1800.0, cpu_s=240.0, memory_bytes=4 * 2**30)
ALONE = Limits(wall_s=150.0, cpu_s=40.0, memory_bytes=4 * 2**30)
#: MJCF and USD are read in a child for every file: fifty times slower than the others.
SLOW = ("mjcf", "usd")
BY_HAND = "by hand: "
PAGES = {
    f"{BY_HAND}{name}": page
    for pages in (
        *(MESH_PAGES, LONG_PAGES, TEXT_PAGES, DESCRIPTION_PAGES),
        *(MJCF_PAGES, USD_PAGES, WEIGHT_PAGES),
    )
    for name, page in pages.items()
}


@cache
def _seeds(data: str) -> dict[str, Case]:
    found = dict(seeds())
    if data:
        found |= real_seeds(Path(data))
    return found


def _cases(kind: str, numbers: Sequence[int], data: str, salt: int) -> Iterator[Case]:
    if kind in PAGES:
        wanted = set(numbers)
        return (case for number, case in enumerate(PAGES[kind]()) if number in wanted)
    return (mutated(_seeds(data)[kind], number, salt) for number in numbers)


def try_batch(kind: str, numbers: Sequence[int], data: str, salt: int) -> list[Trial]:
    """In the child: make the cases and try them."""
    return [try_case(case) for case in _cases(kind, numbers, data, salt)]


def _tried(
    child: WarmChild, kind: str, numbers: Sequence[int], data: str, salt: int
) -> list[Trial]:
    """The trials of a batch; where its child died, one by one, to know which one killed it."""
    outcome = child.call(
        try_batch, kind, numbers, data, salt, limits=LIMITS if len(numbers) > 1 else ALONE
    )
    if outcome.value is not None:
        return outcome.value
    if len(numbers) > 1:
        return [trial for number in numbers for trial in _tried(child, kind, [number], data, salt)]
    name = next(_cases(kind, numbers, data, salt)).name
    return [
        Trial(name, kind, "failed", f"{outcome.detail}\n{outcome.output}", outcome.seconds, 0, ())
    ]


def _plan(count: int, data: str, only: str) -> Iterator[tuple[str, list[int]]]:
    words = only.split(",")
    kinds = [kind for kind in _seeds(data) if any(kind.startswith(word) for word in words)]
    fast = [kind for kind in kinds if not kind.startswith(SLOW)]
    share = count // (len(fast) or len(kinds) or 1)
    slow = share // (10 if fast else 1)
    sizes = {kind: max(1, share if kind in fast else slow) for kind in kinds}
    sizes |= {
        page: sum(1 for _ in cases())
        for page, cases in PAGES.items()
        if page.startswith(tuple(words))
    }
    for kind, size in sizes.items():
        numbers = iter(range(size))
        while batch := list(islice(numbers, BATCH)):
            yield kind, batch


def _save(trial: Trial, numbers: Sequence[int], options: argparse.Namespace) -> None:
    case = next(
        c for c in _cases(trial.kind, numbers, options.data, options.seed) if c.name == trial.name
    )
    folder = Path(options.save) / trial.name[:80].replace(os.sep, "_")
    for name, content in shrunk(case).files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    (folder / "why.txt").write_text(f"{trial.broke}\n{trial.detail}\n", encoding="utf-8")


def real_seeds(folder: Path, most_bytes: int = 2_000_000, most: int = 40) -> dict[str, Case]:
    """Files of a folder that are complete in themselves, as more seeds by kind and number."""
    found = {}
    for suffix in ("glb", "stl", "ply", "off", "obj"):
        paths = (
            path
            for path in sorted(folder.rglob(f"*.{suffix}"))
            if 0 < path.stat().st_size < most_bytes
        )
        for number, path in enumerate(list(paths)[:most]):
            name = f"{suffix}_real{number}"
            found[name] = Case(
                name, suffix, "load", path.name, {path.name: path.read_bytes()}, target=path.name
            )
    return found


def shrunk(case: Case, most: int = 200) -> Case:
    """A case that fails alike with as little in its damaged file as some tries find.

    Run in this process.
    """
    target = case.target or case.entry
    wanted = _symptom(try_case(case))
    best = case
    size = len(case.files[target]) // 2
    tries = 0
    while size and tries < most:
        data = best.files[target]
        at = 0
        while at < len(data) and tries < most:
            smaller = replace(best, files={**best.files, target: data[:at] + data[at + size :]})
            tries += 1
            if _symptom(try_case(smaller)) == wanted:
                best = smaller
                data = smaller.files[target]
            else:
                at += size
        size //= 2
    return best


def _symptom(trial: Trial) -> tuple[str, str, tuple[str, ...]]:
    last = (trial.detail.strip().splitlines() or [""])[-1]
    return trial.verdict, last.partition(":")[0], trial.broke


def main() -> int:
    """Run everything; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--cases",
        type=int,
        default=6000,
        help="damaged files in all; the attacks by hand come on top",
    )
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--data", default="", metavar="DIR", help="a folder of real files to damage as well"
    )
    parser.add_argument("--save", default="", metavar="DIR", help="where to keep what failed")
    parser.add_argument(
        "--only", default="", help="kinds whose names begin so, separated by commas"
    )
    options = parser.parse_args()
    verdicts: Counter[str] = Counter()
    counts: Counter[str] = Counter()
    seconds: defaultdict[str, float] = defaultdict(float)
    failed: list[Trial] = []
    worst_s = 0.0
    worst_bytes = 0
    # Whoever stops it is told how far it came.
    with suppress(KeyboardInterrupt), WarmChild(calls=20, resident_bytes=2**30) as child:
        for kind, numbers in _plan(options.cases, options.data, options.only):
            started = time.monotonic()
            trials = _tried(child, kind, numbers, options.data, options.seed)
            seconds[kind] += time.monotonic() - started
            counts[kind] += len(trials)
            verdicts.update(trial.verdict for trial in trials)
            worst_s = max(worst_s, *(trial.seconds for trial in trials))
            worst_bytes = max(worst_bytes, *(trial.grown for trial in trials))
            for trial in (trial for trial in trials if trial.failed):
                failed.append(trial)
                last = (trial.detail.strip().splitlines() or [""])[-1][:300]
                print(
                    f"FAILED {trial.name}: {trial.verdict} {trial.broke} {last}",
                    file=sys.stderr,
                    flush=True,
                )
                if options.save and "/" not in trial.name and kind not in PAGES:
                    _save(trial, numbers, options)
    result = {
        "benchmark": "fuzz_readers",
        "seed": options.seed,
        "cases": sum(counts.values()),
        "failures": len(failed),
        "verdicts": dict(verdicts.most_common()),
        "cases_per_min": {kind: round(60.0 * counts[kind] / seconds[kind]) for kind in counts},
        "slowest_s": round(worst_s, 2),
        "most_memory_mb": round(worst_bytes / 2**20),
    }
    print(json.dumps(result))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
