"""Which files compose a USD asset, found before composing: none may be outside its folder."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from ...description import DescriptionError
from .multiplied import refuse_multiplied
from .refusing import refusing

SUFFIXES = frozenset({".usd", ".usda", ".usdc", ".usdz"})
MOST_LAYERS = 4096
MOST_BYTES = 2**30
_SCHEME = re.compile(r"^[A-Za-z][A-Za-z0-9+.-]+:")


def is_usd(path: Path) -> bool:
    """Return whether a file is called like a USD layer."""
    return path.suffix.lower() in SUFFIXES


def require_inside(path: Path, folder: Path, most_bytes: int = MOST_BYTES) -> tuple[Path, ...]:
    """Refuse an asset that leads out of a folder by composition arcs, or is too large.

    It is followed through sublayers, references and payloads. Opening a layer opens no other; only
    composing does, and that comes later. Textures and materials named in attributes are never
    opened. Everything lies in or below the folder, symbolic links followed.

    Returns:
        The files that it is composed of, in order of their names; at most so many bytes together.

    Raises:
        DescriptionError: ``outside_folder``, ``missing_file``, ``unreadable``, ``unknown_format``
            (other files; value clips and computed references, whose files cannot be known
            beforehand), ``too_large``, also once it would be composed.
    """
    from pxr import Sdf

    root = folder.resolve()
    waiting = [str(path.resolve())]
    layers: dict[str, Any] = {}
    named: dict[tuple[str, str], str] = {}
    files: dict[Path, int] = {}
    while waiting:
        identifier = waiting.pop()
        if identifier in layers:
            continue
        file = _own_file(identifier, root)
        files[file] = file.stat().st_size
        number = len(layers) + 1
        total = sum(files.values())
        if number > MOST_LAYERS or total > most_bytes:
            limit = f"the limit is {MOST_LAYERS:,} and {most_bytes:,}"
            message = f"{path.name}: {number:,} layers of {total:,} bytes together, {limit}; "
            raise DescriptionError("too_large", message + "simplify it or raise the limit")
        with refusing(Path(identifier).name, root):
            layer = Sdf.Layer.FindOrOpen(identifier)
            if layer is None:
                raise DescriptionError("unreadable", f"{Path(identifier).name}: is no USD layer")
            layers[identifier] = layer
            _refuse_clips(layer)
            for reference in filter(None, layer.GetCompositionAssetDependencies()):
                named[identifier, reference] = _identifier(reference, layer)
                waiting.append(named[identifier, reference])
    with refusing(path.name, root):
        refuse_multiplied(path.name, str(path.resolve()), layers, named)
    return tuple(sorted(files))


def _identifier(reference: str, layer: Any) -> str:
    """Return what a reference in a layer would open, without opening it."""
    from pxr import Sdf

    path, _ = Sdf.Layer.SplitIdentifier(reference)
    if "`" in path:
        message = f"reference {reference[:160]!r}: is computed; want a plain file name"
        raise DescriptionError("unknown_format", message)
    if _SCHEME.match(path) or "\0" in path:
        raise _outside(reference)
    found = str(Sdf.ComputeAssetPathRelativeToLayer(layer, path))
    # What is not beside the layer would be looked for elsewhere: here it is only missed.
    if Path(found).is_absolute() or not layer.realPath:
        return found
    return str(Path(layer.realPath).parent / found)


def _own_file(identifier: str, root: Path) -> Path:
    """Return the file that holds a layer, or the package that holds it."""
    from pxr import Ar

    outer = identifier
    while Ar.IsPackageRelativePath(outer):
        outer = Ar.SplitPackageRelativePathOuter(outer)[0]
    path = Path(outer)
    if not path.is_absolute() or not path.resolve().is_relative_to(root):
        raise _outside(outer)
    if not is_usd(path):
        message = f"{path.name}: want one of {', '.join(sorted(SUFFIXES))}"
        raise DescriptionError("unknown_format", message)
    if not path.is_file():
        raise DescriptionError("missing_file", f"{path.name}: is named by a layer and not there")
    return path.resolve()


def _refuse_clips(layer: Any) -> None:
    """Refuse value clips, which name files in ways that only composition knows."""
    from pxr import Sdf

    found: list[str] = []

    def look(path: Any) -> None:
        is_prim = path.IsPrimPath() or path.IsPrimVariantSelectionPath()
        spec = layer.GetPrimAtPath(path) if is_prim else None
        if spec is not None and spec.HasInfo("clips"):
            found.append(str(path))

    layer.Traverse(Sdf.Path.absoluteRootPath, look)
    if found:
        message = f"prim {found[0]}: has value clips; want geometry that stands still"
        raise DescriptionError("unknown_format", message)


def _outside(reference: str) -> DescriptionError:
    leads = f"reference to {Path(reference).name[:160]!r} leads outside the object's folder"
    return DescriptionError("outside_folder", f"{leads}; put the file there")
