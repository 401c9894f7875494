"""Every format that an asset is written in, one file of this package each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from ..errors import ConfigError
from ..runtime.layout import MJCF, URDF
from .glb import write_glb_asset
from .links import Layout
from .mjcf import mjcf_text
from .sdf import sdf_text
from .text import write_text
from .urdf import urdf_text


@dataclass(frozen=True)
class Format:
    """A description that is written of an asset whose meshes are laid out in the file's folder.

    ``needs`` is the module without which it cannot be; the extra of its name, as ``--formats`` has
    it, installs that.
    """

    name: str
    file: str
    write: Callable[[Layout, Path], None]
    needs: str = ""


def as_text(text: Callable[[Layout], str]) -> Callable[[Layout, Path], None]:
    """Return a writer of what a function says of a layout."""

    def write(layout: Layout, file: Path) -> None:
        write_text(file, text(layout))

    return write


def _write_usd(layout: Layout, file: Path) -> None:
    from .usd import write_usd

    write_usd(layout, file)


FORMATS = (
    Format("urdf", URDF, as_text(urdf_text)),
    Format("mjcf", MJCF, as_text(mjcf_text)),
    Format("sdf", "asset.sdf", as_text(sdf_text)),
    Format("usd", "asset.usd", _write_usd, "pxr"),
    Format("glb", "asset.glb", write_glb_asset),
)


def formats_named(names: tuple[str, ...]) -> tuple[Format, ...]:
    """Return those formats, in the table's order, and URDF and MJCF, which the checks read.

    Raises:
        ConfigError: there is no such format, or what it needs is not installed.
    """
    known = [each.name for each in FORMATS]
    for name in names:
        if name not in known:
            raise ConfigError(f"formats: no format {name!r}; there are {', '.join(known)}")
    asked = {"urdf", "mjcf", *names}
    chosen = tuple(each for each in FORMATS if each.name in asked)
    for each in chosen:
        if each.needs and find_spec(each.needs) is None:
            lacking = f"{each.name} needs {each.needs}, which is not installed"
            raise ConfigError(f"formats: {lacking}; pip install 'asset-factory[{each.name}]'")
    return chosen
