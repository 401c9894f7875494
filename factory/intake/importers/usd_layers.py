"""The files of a USD asset, within the limits of an input; refused in the words of one."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from asset_factory.sim_checks.description import DescriptionError
from asset_factory.sim_checks.read.usd.layers import MOST_LAYERS, layer_files

from ...errors import InputRejected
from ..limits import require_at_most, unreadable

#: What a reader of descriptions says otherwise.
_CODES = {"outside_folder": "external_reference", "unknown_format": "unsupported"}


def require_own_layers(main: Path, folder: Path, max_bytes: int) -> tuple[Path, ...]:
    """Refuse an asset that leads out of its folder by composition arcs, or is too large.

    Args:
        main: the layer to begin with.
        folder: everything lies in or below it, symbolic links followed.
        max_bytes: of all layers' files together [bytes].

    Returns:
        The files that it is composed of, in order of their names.

    Raises:
        InputRejected: ``external_reference``, ``missing_file``, ``unreadable``, ``unsupported``
            (value clips and computed references, whose files cannot be known beforehand),
            ``too_large``.
    """
    files = set()
    with rejecting(main):
        for number, file in enumerate(layer_files(main, folder), start=1):
            require_at_most(main.name, number, MOST_LAYERS, "layers")
            files.add(file)
            size = sum(each.stat().st_size for each in files)
            require_at_most("all layers together", size, max_bytes, "bytes")
    return tuple(sorted(files))


@contextmanager
def rejecting(path: Path) -> Iterator[None]:
    """Within this, a refusal of USD's reader, or an exception of its library, is a rejection.

    Args:
        path: of the root layer.

    Raises:
        InputRejected: ``unreadable``, ``too_large``, or what the refusal says.
        TimeoutError, ChildProcessError: nobody can say.
    """
    try:
        yield
    except (InputRejected, TimeoutError, ChildProcessError):
        raise
    except DescriptionError as error:
        raise InputRejected(_CODES.get(error.code, error.code), error.message) from error
    except MemoryError as error:
        raise InputRejected("too_large", f"{path.name}: does not fit into memory") from error
    except Exception as error:
        words = str(error).replace(str(path.resolve().parent), "")
        raise unreadable(path.name, f"{type(error).__name__}: {words}") from error
