"""As many workers as this machine has processors and free memory for."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from asset_factory.sim_checks.processes.isolation import processors

from ..errors import ConfigError
from ..runtime.terminal import complain

#: What a build takes over all its processes [bytes]: the worker, its validator's children and an
#: engine in each; furniture was measured to take 1.1 GiB.
BUILD_BYTES = 1_200 * 2**20
#: What validating one file takes over its children [bytes]: static checks and three engines.
CHECK_BYTES = 2 * 2**30
#: A limit of a cgroup from here on is none [bytes].
NO_LIMIT = 2**60
GROUPS = Path("/sys/fs/cgroup")
PROC = Path("/proc")


def workers_for(asked: int | None, each: int) -> int:
    """Return how many workers to start: as asked for, or fewer (said) if memory is short.

    As many as there are processors are asked for by default; one may need ``each`` [bytes].

    Raises:
        ConfigError: fewer than one is asked for.
    """
    if asked is not None and asked < 1:
        raise ConfigError(f"--workers must be at least 1, not {asked}")
    wanted = asked or processors()
    free = free_memory()
    room = wanted if free is None else max(1, free // each)
    if room < wanted:
        short = f"{_gib(free or 0)} of memory are free, and one may need {_gib(each)}"
        complain(f"factory: {room} of {wanted} workers start: {short}")
    return min(room, wanted)


def free_memory(proc: Path = PROC, groups: Path = GROUPS) -> int | None:
    """Return what processes may still take, by the machine and by this process's cgroups [bytes].

    ``None`` where nothing says.
    """
    return min((*_of_machine(proc), *_of_groups(proc, groups)), default=None)


def _of_machine(proc: Path) -> Iterator[int]:
    available = _named(proc / "meminfo", "MemAvailable:")
    if available is not None:
        yield 1024 * available


def _of_groups(proc: Path, groups: Path) -> Iterator[int]:
    """Yield what each group above this process leaves: a group's limit holds for all below it."""
    lines: list[str] = []
    with suppress(OSError):
        lines = (proc / "self" / "cgroup").read_text().splitlines()
    for line in lines:
        _, controllers, path = line.split(":", 2)
        if controllers == "":
            root = groups
            names = ("memory.max", "memory.current", "inactive_file")
        elif "memory" in controllers.split(","):
            root = groups / "memory"
            names = ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file")
        else:
            continue
        # Within a container the path may be of the outside: then the mounted root is the group.
        at = root / path.lstrip("/")
        for group in (at, *at.parents):
            yield from _left(group, *names)
            if group == root:
                break


def _left(group: Path, limit: str, used: str, unused: str) -> Iterator[int]:
    with suppress(OSError, ValueError):
        most = int((group / limit).read_text())
        if most < NO_LIMIT:
            taken = int((group / used).read_text())
            # Files that were read are counted, and given up when memory runs short.
            yield max(0, most - taken + (_named(group / "memory.stat", unused) or 0))


def _named(file: Path, name: str) -> int | None:
    """Return the number beside a name; ``None`` where a file has none."""
    with suppress(OSError, ValueError, IndexError):
        for line in file.read_text().splitlines():
            words = line.split()
            if words[0] == name:
                return int(words[1])
    return None


def _gib(number: int) -> str:
    return f"{number / 2**30:.1f} GiB"
