"""Where a process is in its work, on the disk, so that it is known after the process died."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

PLACE_NAME = "place"
#: Of a name, at most.
_BYTES = 64

_names: list[str] = []
_descriptors: list[int] = []


def keep_place(folder: Path) -> None:
    """Have this process write down where it is, in a folder that outlives it."""
    _descriptors[:] = [os.open(folder / PLACE_NAME, os.O_WRONLY | os.O_CREAT, 0o600)]
    leave_places()


def leave_places() -> None:
    """Forget where this process is: it has something new to do."""
    _names.clear()
    _write("")


@contextmanager
def at(name: str) -> Iterator[None]:
    """Note that within this the process is at ``name``; places may be nested."""
    _names.append(name)
    _write(name)
    try:
        yield
    finally:
        del _names[-1:]
        _write(_names[-1] if _names else "")


def place_in(folder: Path) -> str:
    """Return where the process was that kept its place in a folder; empty if it was nowhere."""
    try:
        return (folder / PLACE_NAME).read_bytes().decode(errors="replace").strip()
    except OSError:
        return ""


def _write(name: str) -> None:
    # One write of one length: whoever reads it finds one name, whole.
    for descriptor in _descriptors:
        os.pwrite(descriptor, name.encode()[:_BYTES].ljust(_BYTES), 0)
