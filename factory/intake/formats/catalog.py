"""The mesh formats that are read, a line each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ...geometry.soup import Soup
from ..files import InputFiles
from .dae import read_dae
from .gltf import read_gltf
from .obj import read_obj
from .off import read_off
from .ply import read_ply
from .stl import read_stl

Reader = Callable[[bytes, Path, InputFiles], Soup]


@dataclass(frozen=True)
class MeshFormat:
    """One mesh format.

    Attributes:
        suffix: of its files, in lower case.
        read: from a file's bytes, its path and what may be read beside it. Whatever it raises is a
            fault of the file.
        y_up: the format says that y is up; otherwise z is taken to be.
        stands_alone: such a file may be built by itself; otherwise it is read where a
            description names it.
    """

    suffix: str
    read: Reader
    y_up: bool = False
    stands_alone: bool = True


FORMATS = (
    MeshFormat(".glb", read_gltf, y_up=True),
    MeshFormat(".gltf", read_gltf, y_up=True),
    MeshFormat(".obj", read_obj),
    MeshFormat(".ply", read_ply),
    MeshFormat(".stl", read_stl),
    MeshFormat(".off", read_off),
    MeshFormat(".dae", read_dae, stands_alone=False),
)


def format_of(path: Path) -> MeshFormat | None:
    """Return the format that a file's name speaks of; ``None`` if it is not read."""
    return next((form for form in FORMATS if form.suffix == path.suffix.lower()), None)


def is_mesh(path: Path) -> bool:
    """Return whether a file may be built by itself, by its name."""
    form = format_of(path)
    return form is not None and form.stands_alone
