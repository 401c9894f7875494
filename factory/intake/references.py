"""What files and folders the text of a description names, found without parsing it."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from asset_factory.sim_checks.read.document import inside
from asset_factory.sim_checks.read.regular import open_regular

#: What names a file in a URDF or MJCF, or a folder of them; no path has more letters.
REFERENCE = re.compile(rb"""\b(filename|file|meshdir|assetdir)\s*=\s*["']([^"']{0,4096})["']""")
#: Documents included in one another are followed so far.
DEEPEST = 3
#: Documents that one description may include, itself among them.
MOST_DOCUMENTS = 64
#: The text of one document, and text and names of all documents of a search [bytes, names]: under a
#: minute of work. Meshes named beyond that count as inputs of their own; what is wrong with the
#: description is told by its own reader.
MOST_BYTES = 64 * 2**20
MOST_BYTES_READ = 16 * MOST_BYTES
MOST_NAMES = 5_000_000


class References:
    """Reads what descriptions in one folder name, within bounds.

    Text is searched by an expression that takes time in proportion to it, nothing is built of it,
    and so no process of its own is needed.

    Args:
        root: nothing outside this folder is read, links followed.
    """

    def __init__(self, root: Path) -> None:
        self._real = root.resolve()
        self._left = MOST_BYTES_READ
        self._names = iter(range(MOST_NAMES))

    def of(self, description: Path) -> Iterator[str]:
        """Yield the names in a description and what it includes.

        A folder that an MJCF looks into is named by a file ``x`` in it.
        """
        waiting = [(description, 0)]
        seen = {os.path.realpath(description)}
        for path, depth in waiting:
            for attribute, value in self._named_in(path):
                yield f"{value}/x" if attribute.endswith("dir") else value
                if not value.lower().endswith(".xml") or depth == DEEPEST:
                    continue
                target = path.parent / value
                real = _real(target)
                if real and real not in seen and len(seen) < MOST_DOCUMENTS:
                    seen.add(real)
                    waiting.append((target, depth + 1))

    def _named_in(self, path: Path) -> Iterator[tuple[str, str]]:
        """Yield the attributes that name something, and what."""
        data = b""
        if inside(path, self._real):
            with suppress(OSError), open_regular(path) as file:
                data = file.read(min(MOST_BYTES, self._left))
        self._left -= len(data)
        for found, _ in zip(REFERENCE.finditer(data), self._names, strict=False):
            yield found[1].decode(), found[2].decode("utf-8", "replace")


def _real(path: Path) -> str:
    """Return where a path leads; empty for a name that no file can have."""
    with suppress(OSError, ValueError):
        return os.path.realpath(path)
    return ""
