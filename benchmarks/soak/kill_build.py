"""Kill a build at random moments, go on, and compare with a build that nobody disturbed.

python benchmarks/soak/kill_build.py --assets 60 --kills 100

Each kill is a ``kill -9`` of the job itself, of one of its workers, or of a process that a worker started, each kind
as often as the others. A killed job is started again with the same command. One JSON line at the end: how many of each
were killed, how many files and rows differ from the undisturbed build (want none), what is left in staging after
``factory registry gc`` (want nothing), and how many processes are left (want none).
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from pathlib import Path

import numpy as np
from meshes import write_meshes
from outcome import content, leftovers, rows

FACTORY = (sys.executable, "-m", "asset_factory.factory.cli")
KINDS = ("job", "worker", "grandchild")


def build_command(inputs: Path, output: Path, workers: int) -> list[str]:
    """The command that is killed and repeated."""
    flags = ("--sim", "mujoco", "--config", "fast", "--workers", str(workers))
    return [*FACTORY, "build", "--input", str(inputs), "--output", str(output), *flags]


def children(parent: int) -> list[int]:
    """Processes that a process has started and that are still there."""
    with suppress(OSError):
        found: list[int] = []
        for task in Path(f"/proc/{parent}/task").iterdir():
            found += [int(word) for word in (task / "children").read_text().split()]
        return found
    return []


def descendants(parent: int, depth: int) -> list[int]:
    """Processes this many generations below a process."""
    generation = [parent]
    for _ in range(depth):
        generation = [child for each in generation for child in children(each)]
    return generation


def victim(job: int, kind: str, draw: np.random.Generator) -> int | None:
    """Somebody of that kind who is alive now. Workers are born of a fork server, which is the job's child."""
    if kind == "job":
        return job
    found = descendants(job, 2 if kind == "worker" else 3)
    found += descendants(job, 4) if kind == "grandchild" else []
    return int(draw.choice(found)) if found else None


def kill_while_building(command: list[str], kills: int, longest_s: float, seed: int) -> dict[str, int]:
    """Run the command again and again until so many kills were made; then once more, undisturbed."""
    draw, killed, restarts = np.random.default_rng(seed), dict.fromkeys(KINDS, 0), 0
    while sum(killed.values()) < kills:
        job = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while job.poll() is None and sum(killed.values()) < kills:
            time.sleep(draw.uniform(0.05, longest_s))
            kind = str(draw.choice(KINDS))
            target = victim(job.pid, kind, draw)
            if target is None or job.poll() is not None:
                continue
            with suppress(ProcessLookupError):
                os.kill(target, signal.SIGKILL)
                killed[kind] += 1
        job.wait()
        restarts += 1
        if job.returncode in (0, 3):
            break
    subprocess.run(command, check=False, capture_output=True)
    return {**killed, "starts": restarts + 1}


def main() -> None:
    """Build undisturbed, build disturbed, compare."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--assets", type=int, default=60)
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--longest", type=float, default=4.0, help="longest wait between two kills [s]")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_meshes(folder / "meshes", given.assets)
        undisturbed, disturbed = folder / "undisturbed", folder / "disturbed"
        command = build_command(folder / "meshes", undisturbed, given.workers)
        subprocess.run(command, check=True, capture_output=True)
        command = build_command(folder / "meshes", disturbed, given.workers)
        killed = kill_while_building(command, given.kills, given.longest, given.seed)
        subprocess.run([*FACTORY, "registry", "gc", "--output", str(disturbed)], check=True, capture_output=True)
        wanted, found = content(undisturbed), content(disturbed)
        differing = sorted(path for path in wanted.keys() | found.keys() if wanted.get(path) != found.get(path))
        print(
            json.dumps(
                {
                    "assets": given.assets,
                    "killed": killed,
                    "files": len(wanted),
                    "files_differing": len(differing),
                    "first_differing": differing[:3],
                    "rows": len(rows(undisturbed)),
                    "rows_equal": rows(undisturbed) == rows(disturbed),
                    "left_in_staging": leftovers(disturbed),
                    "processes_left": processes_of(str(disturbed)),
                }
            )
        )


def processes_of(text: str) -> int:
    """How many processes have this text on their command line."""
    count = 0
    for folder in Path("/proc").iterdir():
        if folder.name.isdigit() and int(folder.name) != os.getpid():
            with suppress(OSError):
                count += text in (folder / "cmdline").read_bytes().decode(errors="replace")
    return count


if __name__ == "__main__":
    main()
