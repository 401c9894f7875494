"""How much memory MuJoCo's compiler may take: a small file can ask for any amount."""

from __future__ import annotations

import resource
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

#: Beyond what the process holds before [bytes]. Files of real objects take 0.1 GiB.
COMPILER_BYTES = 2 * 2**30
#: What MuJoCo says where it gets no memory; the second, of whatever its own code throws.
_WORDS = ("Could not allocate memory", "Caught an unknown exception")


@contextmanager
def memory_bounded(most: int = COMPILER_BYTES) -> Iterator[None]:
    """Within this, the process may take so much more address space; only in a killable child.

    Raises:
        MemoryError: it asked for more.
    """
    usual = resource.getrlimit(resource.RLIMIT_AS)
    with suppress(OSError):
        held = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
        limits = [limit for limit in usual if limit != resource.RLIM_INFINITY]
        resource.setrlimit(resource.RLIMIT_AS, (min([held + most, *limits]), usual[1]))
    try:
        yield
    except Exception as error:
        if isinstance(error, MemoryError) or any(words in str(error) for words in _WORDS):
            raise MemoryError(f"it takes over {most / 2**30:g} GiB of memory: {error}") from error
        raise
    finally:
        resource.setrlimit(resource.RLIMIT_AS, usual)
