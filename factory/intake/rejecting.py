"""What a reader of descriptions refuses, as the rejection of an input."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from asset_factory.sim_checks.description import DescriptionError

from ..errors import InputRejected
from .limits import unreadable
from .reads import ABSENT, ReadLog

#: Codes of inputs by those of descriptions; any other is ``unreadable``.
_CODES = {
    "missing_file": "missing_file",
    "outside_folder": "external_reference",
    "too_large": "too_large",
    "unknown_format": "unsupported",
}


@contextmanager
def rejecting(name: str, folder: Path, log: ReadLog | None = None) -> Iterator[None]:
    """Turn errors over a file from anybody into a rejection: the file is at fault.

    Args:
        name: opens the sentence of what no reader says itself.
        folder: of the input; sentences do not tell where it is.
        log: notes which files were looked for, and which links lead out of the folder.

    Raises:
        InputRejected: ``missing_file``, ``external_reference``, ``too_large``, ``unsupported``,
            ``unreadable``, or a rejection that is raised as such.
        TimeoutError, ChildProcessError: nobody can say.
    """
    try:
        yield
    except (InputRejected, TimeoutError, ChildProcessError):
        raise
    except DescriptionError as error:
        if log is not None:
            _note_places(error, folder, log)
        code = _CODES.get(error.code, "unreadable")
        raise InputRejected(code, error.message) from error
    except MemoryError as error:
        raise InputRejected("too_large", f"{name}: does not fit into memory") from error
    except Exception as error:
        said = error.strerror if isinstance(error, OSError) else None
        words = said or str(error).replace(str(folder.resolve()), "")
        raise unreadable(name, f"{type(error).__name__}: {words}") from error


def _note_places(error: DescriptionError, folder: Path, log: ReadLog) -> None:
    """Note where a file was looked for: the input is another one once it lies there."""
    for place in error.places:
        if error.code == "outside_folder":
            log.note_link_out(place, folder.resolve())
        else:
            log.note(place, ABSENT)
