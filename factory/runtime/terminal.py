"""The one way to a terminal: names in files may hold sequences that would steer it."""

import sys
from collections.abc import Iterable

from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment

_KEPT = frozenset("\n\t")


def printable(text: str) -> str:
    r"""Return a text with everything escaped that is not seen, ``\x1b`` and the like.

    Line breaks and tabs stay; bytes of a name that are no UTF-8 are escaped too.
    """
    if text.isascii() and text.isprintable():
        return text
    return "".join(
        letter
        if letter.isprintable() or letter in _KEPT
        else letter.encode("unicode_escape").decode("ascii")
        for letter in text
    )


def one_line(text: str) -> str:
    """Return a text as :func:`printable`, without line breaks, which could pose as other lines."""
    return printable(" ".join(text.split("\n")))


def say(text: object, *, end: str = "\n") -> None:
    """Print a text to standard output."""
    sys.stdout.write(f"{printable(str(text))}{end}")
    sys.stdout.flush()


def complain(text: object, *, end: str = "\n") -> None:
    """Print a text to standard error."""
    sys.stderr.write(f"{printable(str(text))}{end}")
    sys.stderr.flush()


class Terminal(Console):
    """A console that prints text alone; what steers the terminal is Rich's own."""

    def render(
        self, renderable: RenderableType, options: ConsoleOptions | None = None
    ) -> Iterable[Segment]:
        """Yield segments as Rich does, their text printable."""
        for segment in super().render(renderable, options):
            if segment.control:
                yield segment
            else:
                yield Segment(printable(segment.text), segment.style)
