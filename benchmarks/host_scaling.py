"""What further hosts bring: 1 to 4 of a part of a core each, with real builds over Ray.

python benchmarks/host_scaling.py --share 0.25 --hosts 1 2 3 4

Hosts are network namespaces with a /tmp of their own, as in ``make cluster-test``; a control group
gives each the same share of a core, and inputs and assets travel over TCP and an S3 server. A JSON
line for each number of hosts: assets an hour once all of them are warm, and the efficiency: the
same over that number times what one host does. ``machine`` is the share that busy loops in as many
such groups got of what they were promised, at the same time of day: below 1, others use this
machine. The command and the S3 server have the rest of it. Needs root.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "tests" / "samples"), str(ROOT / "benchmarks" / "soak")]

from hosts import Hosts, hosts  # noqa: E402 - the samples live with the tests
from meshes import write_meshes  # noqa: E402 - beside the soak tests
from s3_server import BUCKET, s3_server  # noqa: E402

PERIOD_US = 100_000
#: Assets of each host that are not counted: it loads libraries first.
WARM = 5
BUSY_S = 5.0
_BUSY = f"import time; end = time.monotonic() + {BUSY_S}\nwhile time.monotonic() < end: pass\n"
_BUSY += "print(time.process_time())"
CHEAP = ROOT / "benchmarks" / "soak" / "cheap.toml"
FLAGS = ("--articulator", "annotated", "--sim", "mujoco", "--no-report", "--quiet")


@contextmanager
def groups(count: int, share: float) -> Iterator[list[Path]]:
    """Control groups that have a share of a core each, by either version of Linux's interface."""
    root = Path("/sys/fs/cgroup/cpu")
    legacy = root.is_dir()
    root = root if legacy else root.parent
    made = [root / f"af{os.getpid()}-{number}" for number in range(count)]
    quota = round(share * PERIOD_US)
    try:
        for group in made:
            group.mkdir()
            if legacy:
                (group / "cpu.cfs_period_us").write_text(str(PERIOD_US))
                (group / "cpu.cfs_quota_us").write_text(str(quota))
            else:
                (group / "cpu.max").write_text(f"{quota} {PERIOD_US}")
        yield made
    finally:
        for group in made:
            for _ in range(50):
                with contextlib.suppress(OSError):
                    group.rmdir()
                    break
                time.sleep(0.1)


def machine_gives(within: list[Path], share: float) -> float:
    """What busy loops in all groups get, over what they were promised."""
    join = 'echo $$ > "$0/cgroup.procs"; exec "$@"'
    loops = [
        subprocess.Popen(
            ["/bin/sh", "-c", join, str(group), sys.executable, "-c", _BUSY],
            stdout=subprocess.PIPE,
            text=True,
        )
        for group in within
    ]
    used = [float(loop.communicate()[0]) for loop in loops]
    return sum(used) / (len(within) * share * BUSY_S)


def assets_an_hour(made: Hosts, meshes: Path, output: Path, count: int) -> float:
    """Over all hosts, from when they are warm until some of them have nothing to do any more."""
    command = [sys.executable, "-m", "asset_factory.factory.cli", "build", *FLAGS]
    command += ["--config", str(CHEAP), "--input", str(meshes), "--output", str(output)]
    command += ["--executor", "ray", "--ray-address", made.address]
    command += ["--ray-exchange", f"s3://{BUCKET}/between"]
    subprocess.run(command, check=False, stdout=subprocess.DEVNULL)
    lines = [
        json.loads(line) for line in (output / "logs" / "builds.jsonl").read_text().splitlines()
    ]
    built = [
        datetime.fromisoformat(line["time"]).timestamp()
        for line in lines
        if line["event"] == "built"
    ]
    first = WARM * count - 1
    last = len(built) - 2 * count
    return 3600.0 * (last - first) / (built[last] - built[first])


def main() -> None:
    """One number of hosts after the other, each on a cluster of its own."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--share", type=float, default=0.5, help="of a core, that a host has")
    parser.add_argument("--hosts", type=int, nargs="+", default=[1, 2, 4])
    parser.add_argument("--assets", type=int, default=20, help="for each host")
    given = parser.parse_args()
    alone = 0.0
    for count in given.hosts:
        with (
            tempfile.TemporaryDirectory(prefix="hs-", dir="/tmp", ignore_cleanup_errors=True) as at,
            groups(count, given.share) as within,
        ):
            folder = Path(at)
            meshes = folder / "hidden" / "meshes"
            meshes.mkdir(parents=True)
            write_meshes(meshes, count * given.assets)
            machine = machine_gives(within, given.share)
            (folder / "ray").mkdir()
            with hosts(folder / "hidden", folder / "ray") as made, s3_server(made.head):
                import fsspec

                # The server forgets nothing in one process.
                with contextlib.suppress(FileExistsError):
                    fsspec.filesystem("s3", skip_instance_cache=True).mkdir(BUCKET)
                made.start_head()
                made.await_nodes(1)
                for number in range(2, 2 + count):
                    made.start(number)
                made.await_nodes(1 + count)
                # Ray's own start takes twenty seconds of a processor, and is over by now.
                for number, group in enumerate(within, start=2):
                    made.confine(number, group)
                speed = assets_an_hour(made, meshes, folder / "out", count)
        alone = alone or speed / count
        told = {
            "hosts": count,
            "share": given.share,
            "assets_an_hour": round(speed),
            "efficiency": round(speed / count / alone, 3),
            "machine": round(machine, 3),
            "load": round(os.getloadavg()[0], 1),
        }
        print(json.dumps(told), flush=True)
        shutil.rmtree(at, ignore_errors=True)


if __name__ == "__main__":
    main()
