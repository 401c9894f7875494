"""Whatever USD's library makes of a damaged file is a refusal, told as a sentence."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

from ...description import DescriptionError
from ...processes.isolation import Failure, Limits, WarmChild
from ..native import require_word

T = TypeVar("T")
_LETTERS_SAID = 240
#: A damaged file has thousands of faults, and its library tells each.
_LETTERS_READ = 10_000
#: In an error of its library, beside where that is in its source.
_ITS_WORDS = re.compile(r" at line \d+ in file \S+ : '(.*?)'(?=, Error in |\)$|$)", re.DOTALL)
#: Time only ends what hangs, and is no verdict.
LIMITS = Limits(wall_s=120.0, memory_bytes=4 * 2**30)


@contextmanager
def refusing(name: str, folder: Path) -> Iterator[None]:
    """Turn exceptions of USD's library, few of which pickle, into a refusal.

    Args:
        name: of the file, which opens the sentence.
        folder: its own, which the sentence does not tell.

    Raises:
        DescriptionError: ``unreadable``, or ``too_large`` where memory did not do; its own kind
            passes.
    """
    try:
        yield
    except DescriptionError:
        raise
    except MemoryError as error:
        raise DescriptionError("too_large", f"{name}: does not fit into memory") from error
    except Exception as error:
        said = f"{type(error).__name__}: {error}"[:_LETTERS_READ]
        said = " ".join(" ".join(_ITS_WORDS.findall(said) or [said]).split())
        words = said.replace(str(folder), "")[:_LETTERS_SAID]
        raise DescriptionError("unreadable", f"{name}: USD cannot read it: {words}") from error


def ask_of(
    child: WarmChild, name: str, function: Callable[..., T], *args: Any, limits: Limits = LIMITS
) -> T:
    """Call what reads USD in a child; a file that it dies of twice cannot be read.

    Args:
        child: to be asked.
        name: of the file, which opens the sentence.
        function: as for :meth:`WarmChild.call`; what it raises is raised here.
        *args: its arguments.
        limits: of each call.

    Raises:
        DescriptionError: ``unreadable``, ``too_large``.
        TimeoutError, ChildProcessError: nobody can say.
    """
    outcome = child.call(function, *args, limits=limits)
    if outcome.failure is Failure.CRASHED and not outcome.killed:
        outcome = child.call(function, *args, limits=limits)
    require_word(outcome, name)
    if isinstance(outcome.error, MemoryError):
        raise DescriptionError("too_large", f"{name}: {outcome.detail}")
    if outcome.failure is Failure.CRASHED:
        raise DescriptionError("unreadable", f"{name}: USD dies of it: {outcome.detail}")
    return outcome.unwrap()
