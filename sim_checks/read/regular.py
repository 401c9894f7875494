"""Bytes of files from strangers: of regular files only, and never more than a limit."""

import errno
import os
import stat
from io import BufferedReader
from pathlib import Path


def open_regular(path: Path) -> BufferedReader:
    """Open a regular file, links followed; a pipe or a device is neither waited for nor read.

    Raises:
        OSError: it cannot be opened, or is no regular file.
    """
    # A pipe without a writer would block the opening itself.
    descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise OSError(errno.EINVAL, "is not a regular file", path.name)
    return os.fdopen(descriptor, "rb")


def read_regular(path: Path, most: int) -> bytes:
    """Return the content of a regular file.

    Args:
        path: links are followed.
        most: largest content that is read [bytes].

    Raises:
        OSError: it cannot be opened, is no regular file, or is larger (``EFBIG``).
    """
    with open_regular(path) as file:
        size = os.fstat(file.fileno()).st_size
        # It may grow while it is read.
        data = b"" if size > most else file.read(most + 1)
    if max(size, len(data)) > most:
        raise OSError(errno.EFBIG, f"is over {most} bytes", path.name)
    return data
