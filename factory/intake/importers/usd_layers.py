"""The files of a USD asset, within the limits of an input; refused in the words of one."""

from __future__ import annotations

from pathlib import Path

from asset_factory.sim_checks.description import DescriptionError
from asset_factory.sim_checks.read.usd.layers import MOST_LAYERS, layer_files

from ...errors import InputRejected
from ..limits import require_at_most

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
    try:
        for number, file in enumerate(layer_files(main, folder), start=1):
            require_at_most(main.name, number, MOST_LAYERS, "layers")
            files.add(file)
            size = sum(each.stat().st_size for each in files)
            require_at_most("all layers together", size, max_bytes, "bytes")
    except DescriptionError as error:
        raise InputRejected(_CODES.get(error.code, error.code), error.message) from error
    return tuple(sorted(files))
