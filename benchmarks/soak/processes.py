"""Processes, as Linux shows them: who started whom, and what they use."""

from __future__ import annotations

import os
import time
from contextlib import suppress
from pathlib import Path

PAGE_BYTES = os.sysconf("SC_PAGE_SIZE")
TICKS_PER_S = os.sysconf("SC_CLK_TCK")
#: In ``/proc/<pid>/stat``, counted after the name: user and system time [ticks].
USER = 11
SYSTEM = 12


def children(parent: int) -> list[int]:
    """Processes that a process has started and that are still there."""
    with suppress(OSError):
        found: list[int] = []
        for task in Path(f"/proc/{parent}/task").iterdir():
            found += [int(word) for word in (task / "children").read_text().split()]
        return found
    return []


def family(job: int) -> list[int]:
    """A process and all its descendants."""
    return [job, *(each for child in children(job) for each in family(child))]


def descendants(parent: int, depth: int) -> list[int]:
    """Processes this many generations below a process."""
    generation = [parent]
    for _ in range(depth):
        generation = [child for each in generation for child in children(each)]
    return generation


def resident_bytes(process: int) -> int:
    """Memory held, shared pages included [bytes]; 0 if the process is gone."""
    with suppress(OSError):
        return int(Path(f"/proc/{process}/statm").read_text().split()[1]) * PAGE_BYTES
    return 0


def processor_s(process: int) -> float:
    """Processor time used so far [s]; 0 if the process is gone."""
    with suppress(OSError, IndexError):
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[USER]) + int(fields[SYSTEM])) / TICKS_PER_S
    return 0.0


def open_files(process: int) -> int:
    """Descriptors that are open; 0 if the process is gone."""
    with suppress(OSError):
        return len(os.listdir(f"/proc/{process}/fd"))
    return 0


def left_over(text: str, patience_s: float = 10.0) -> int:
    """How many of :func:`in_environment` are left after so long [s]; the last end a bit late."""
    end = time.monotonic() + patience_s
    while (found := in_environment(text)) and time.monotonic() < end:
        time.sleep(0.1)
    return len(found)


def in_environment(text: str) -> list[int]:
    """Other processes whose environment holds this text: all that a job started, at any depth."""
    found = []
    for folder in Path("/proc").iterdir():
        if folder.name.isdigit() and int(folder.name) != os.getpid():
            with suppress(OSError):
                if text in (folder / "environ").read_bytes().decode(errors="replace"):
                    found.append(int(folder.name))
    return found
