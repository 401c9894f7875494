"""Native readers of files from strangers: what they may take, and what their deaths say."""

from __future__ import annotations

import resource
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, TypeVar

from ..description import DescriptionError
from ..processes.isolation import Failure, Limits, WarmChild

T = TypeVar("T")
#: Time only ends what hangs, and is no verdict.
LIMITS = Limits(wall_s=120.0, memory_bytes=4 * 2**30)
#: MuJoCo's compiler has a limit of memory of its own.
COMPILE_LIMITS = Limits(wall_s=120.0, memory_bytes=8 * 2**30)
#: Of MuJoCo's compiler, beyond what the process holds before [bytes]; real objects take 0.1 GiB.
COMPILER_BYTES = 2 * 2**30
#: Of USD's library, which maps its files as well, and of what is made of them.
READER_BYTES = 3 * 2**30
#: What MuJoCo says where it gets no memory; the second, of whatever its own code throws.
_WORDS = ("Could not allocate memory", "Caught an unknown exception")


def read_apart(function: Callable[[Path], T], path: Path) -> T:
    """Have MuJoCo compile a file in a child that may crash; errors of :func:`ask_of`."""
    with WarmChild() as child:
        return ask_of(child, path.name, function, path, limits=COMPILE_LIMITS)


def ask_of(
    child: WarmChild, name: str, function: Callable[..., T], *args: Any, limits: Limits = LIMITS
) -> T:
    """Call a native reader in a child; a file that it dies of twice cannot be read.

    The call is that of :meth:`WarmChild.call`; ``name``, the file's, opens the sentence.

    What a reader answers or raises is its word, and so is a fault that it dies of.

    Raises:
        DescriptionError: what the function raises, ``unreadable`` or ``too_large``.
        TimeoutError: it hung: nobody can say.
        ChildProcessError: somebody killed it, or it did not start: the same.
    """
    outcome = child.call(function, *args, limits=limits)
    if outcome.failure is Failure.CRASHED and not outcome.killed:
        outcome = child.call(function, *args, limits=limits)
    if isinstance(outcome.error, DescriptionError):
        raise outcome.error
    said = f"{name}: what reads it gave no answer: {outcome.detail}"
    if outcome.failure is Failure.TIMEOUT:
        raise TimeoutError(said)
    if outcome.failure is Failure.CRASHED and (outcome.exited or not outcome.deaths):
        raise ChildProcessError(said)
    if outcome.failure is not None:
        code = "too_large" if isinstance(outcome.error, MemoryError) else "unreadable"
        raise DescriptionError(code, f"{name}: its reader fails: {outcome.detail}")
    return outcome.unwrap()


@contextmanager
def memory_bounded(most: int) -> Iterator[None]:
    """Limit how much more address space the process may take; only in a killable child.

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
