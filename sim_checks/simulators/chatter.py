"""What engines write to standard output and error, caught and made the same on every machine."""

from __future__ import annotations

import os
import re
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

#: Longest part of a loader's chatter that is kept [lines].
MOST_LINES = 40
#: Bullet's messages start with where in its source they were written, and often end without a new
#: line.
BULLET_PREFIX = r"b3(?:Warning|Printf|Error)\[[^\]]*\]:\s*"
#: In lines that an engine writes whatever the file, or that quote its source.
CHATTER = ("build time", "Failed to find system libvulkan", "warn(", "= spec.compile()")


@contextmanager
def captured_lines(lines: list[str]) -> Iterator[None]:
    """Collect what native code writes to stdout and stderr meanwhile, each line once."""
    sys.stdout.flush()
    sys.stderr.flush()
    kept = [os.dup(1), os.dup(2)]
    with tempfile.TemporaryFile() as file:
        try:
            os.dup2(file.fileno(), 1)
            os.dup2(file.fileno(), 2)
            yield
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            for descriptor, saved in zip((1, 2), kept, strict=True):
                os.dup2(saved, descriptor)
                os.close(saved)
            file.seek(0)
            text = file.read().decode("utf-8", "replace")
            found = (line.strip() for line in re.sub(BULLET_PREFIX, "\n", text).splitlines())
            told = (line for line in found if line and not any(word in line for word in CHATTER))
            lines.extend(list(dict.fromkeys(told))[:MOST_LINES])


def timeless(line: str, path: Path) -> str:
    """Return the line without clock, temporary folder, place in the code and machine."""
    line = re.sub(r"^\S+\.py:\d+: (\w+Warning: )?", "", line)
    line = re.sub(r"^\[\d{4}-\d\d-\d\d [^\]]*\]\s*", "", line)
    line = re.sub(r"[^\s\"'\[(]*/twin-[^/\s]+/", "", line)
    return line.replace(f"{path.parent.resolve()}/", "")
