"""Whatever USD's library makes of a damaged file is a refusal, told as a sentence."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ...description import DescriptionError

_LETTERS_SAID = 240
#: A damaged file has thousands of faults, and its library tells each.
_LETTERS_READ = 10_000
#: In an error of its library, beside where that is in its source.
_ITS_WORDS = re.compile(r" at line \d+ in file \S+ : '(.*?)'(?=, Error in |\)$|$)", re.DOTALL)


@contextmanager
def refusing(name: str, folder: Path) -> Iterator[None]:
    """Turn exceptions of USD's library, few of which pickle, into a refusal.

    The sentence begins with the file's name, and does not tell its folder.

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
