"""Which inputs may be built, by their licenses."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from ...config import IntakeConfig
from ...errors import InputRejected
from ...intake.files import InputFiles
from ...intake.licenses import UNKNOWN, is_allowed
from ...intake.naming import well_formed
from ...intake.sidecar import read_sidecar
from ...report.nightly.report import LeftOut


@dataclass(frozen=True)
class Licenses:
    """Which licenses inputs may have; patterns such as ``CC0-*`` too, no names: all of them."""

    allowed: tuple[str, ...] = ()
    unknown: bool = True

    @property
    def names(self) -> tuple[str, ...]:
        """Return the same as the build's settings have it."""
        if self.unknown:
            return (*self.allowed, UNKNOWN) if self.allowed else ()
        return self.allowed or ("*",)

    def allow(self, license: str) -> bool:
        """Return whether an input under this license may be built."""
        return is_allowed(license, self.names)


def sort_out(
    inputs: Sequence[Path], licenses: Licenses
) -> tuple[tuple[Path, ...], tuple[LeftOut, ...]]:
    """Separate inputs that may be built from those whose sidecar states a license not allowed.

    What only the file itself states is known once it is loaded: then it is rejected.
    """
    left = {}
    for path in inputs if licenses.allowed else ():
        stated = _stated(path)
        if stated and not licenses.allow(stated):
            left[path] = LeftOut(well_formed(str(path)), stated)
    return tuple(path for path in inputs if path not in left), tuple(left.values())


def _stated(path: Path) -> str:
    """Return what an input's sidecar states; empty where none can be read: loading says why."""
    with suppress(InputRejected, OSError):
        return read_sidecar(path, InputFiles(path.parent, IntakeConfig())).license or ""
    return ""
