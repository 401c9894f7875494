"""Kill a build at random moments, go on, and compare with a build that nobody disturbed.

python benchmarks/soak/kill_build.py --assets 60 --kills 100

Each kill is a ``kill -9`` of the job itself, of one of its workers, or of a process that a worker
started (a simulator, a decomposition, the server that forks them), each kind as often as the
others. A killed job is started again with the same command. One JSON line at the end: how many of
each were killed, how often inputs were built, how many files and rows differ from the undisturbed
build (want none), what is left of half-made things and of temporary files after ``factory registry
gc`` (want nothing), and how many processes are left (want none).
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import tempfile
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from job import build_command, collected, done, started
from meshes import write_meshes
from outcome import LASTING, content, leftovers, rows
from processes import descendants, left_over

KINDS = ("job", "worker", "grandchild")
#: Workers are born of a fork server, which is the job's child; what they start, of a server of
#: their own.
GENERATIONS = {"worker": (2,), "grandchild": (3, 4)}


def victim(job: int, kind: str, draw: np.random.Generator) -> int | None:
    """Somebody of that kind who is alive now."""
    if kind == "job":
        return job
    found = [each for depth in GENERATIONS[kind] for each in descendants(job, depth)]
    return int(draw.choice(found)) if found else None


def finished(output: Path) -> int:
    """How many inputs have their folder."""
    return sum(len(os.listdir(output / name)) for name in LASTING if (output / name).is_dir())


def kill_while_building(
    plan: Plan, command: list[str], output: Path, scratch: Path
) -> tuple[dict[str, int], int]:
    """Run the command again and again until all kills were made; kills by kind, and starts."""
    draw = np.random.default_rng(plan.seed)
    killed = dict.fromkeys(KINDS, 0)
    starts = 0
    while sum(killed.values()) < plan.kills:
        job = started(command, scratch)
        starts = starts + 1
        while job.poll() is None and sum(killed.values()) < plan.kills:
            if finished(output) < plan.due(sum(killed.values())):
                time.sleep(0.02)
                continue
            time.sleep(draw.uniform(0.0, plan.longest_s))
            kind = min(KINDS, key=lambda each: (killed[each], each))
            target = victim(job.pid, kind, draw)
            if target is None or job.poll() is not None:
                continue
            with suppress(ProcessLookupError):
                os.kill(target, signal.SIGKILL)
                killed[kind] += 1
        code = job.wait()
        if code >= 0:
            break
    return killed, starts


@dataclass(frozen=True)
class Plan:
    """When to kill.

    Attributes:
        assets: of the build.
        kills: spread over all of it, however slow the machine is today.
        longest_s: longest wait between the moment when a kill is due and the kill [s].
        seed: of the moments and the victims.
    """

    assets: int
    kills: int
    longest_s: float
    seed: int

    def due(self, number: int) -> int:
        """How many assets are finished when that kill may come."""
        return number * self.assets * 9 // (self.kills * 10)


def main() -> None:
    """Build undisturbed, build disturbed, compare."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--assets", type=int, default=60)
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--longest", type=float, default=2.0, help="longest wait before a kill [s]")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scratch = Path(name) / "tmp"
        write_meshes(folder / "meshes", given.assets)
        undisturbed = folder / "undisturbed"
        disturbed = folder / "disturbed"
        done(
            build_command(folder / "meshes", undisturbed, given.workers), scratch
        ).check_returncode()
        command = build_command(folder / "meshes", disturbed, given.workers)
        plan = Plan(given.assets, given.kills, given.longest, given.seed)
        killed, starts = kill_while_building(plan, command, disturbed, scratch)
        last = done(command, scratch)
        collected(disturbed, scratch).check_returncode()
        wanted = content(undisturbed)
        found = content(disturbed)
        differing = sorted(
            path for path in wanted.keys() | found.keys() if wanted.get(path) != found.get(path)
        )
        numbers = {
            "assets": given.assets,
            "killed": killed,
            "starts": starts + 1,
            "last_exit_code": last.returncode,
            "files": len(wanted),
            "files_differing": len(differing),
            "first_differing": differing[:3],
            "rows": len(rows(undisturbed)),
            "rows_equal": rows(undisturbed) == rows(disturbed),
            "registered": len(registrations(disturbed)),
            "registered_twice": doubled(registrations(disturbed)),
            "half_made": leftovers(disturbed),
            "temporary": sorted(os.listdir(scratch)),
            "processes": left_over(str(scratch)),
        }
        print(json.dumps(numbers))


def registrations(output: Path) -> list[str]:
    """Ids of the inputs that were registered as passed, as often as they were."""
    lines = [
        json.loads(line) for line in (output / "logs" / "builds.jsonl").read_text().splitlines()
    ]
    return [line["id"] for line in lines if line["event"] == "built" and line["status"] == "passed"]


def doubled(ids: list[str]) -> list[str]:
    """Those that are there more than once."""
    return sorted({each for each in ids if ids.count(each) > 1})


if __name__ == "__main__":
    main()
