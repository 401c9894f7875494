"""Which files compose a USD asset, found before composing: none may be outside its folder."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from ...errors import InputRejected
from ..limits import require_at_most, unreadable

SUFFIXES = frozenset({".usd", ".usda", ".usdc", ".usdz"})
_SCHEME = re.compile(r"^[A-Za-z][A-Za-z0-9+.-]+:")
MOST_LAYERS = 4096


def require_own_layers(main: Path, folder: Path, max_bytes: int) -> tuple[Path, ...]:
    """Refuse an asset that leads out of its folder by composition arcs, or is too large.

    The arcs are sublayers, references and payloads.

    Opening a layer opens no other; only composing does, and that comes later. Textures and
    materials named in attributes are never opened.

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
    from pxr import Sdf, Tf

    root = folder.resolve()
    waiting = [str(main.resolve())]
    seen = set()
    files = set()
    while waiting:
        identifier = waiting.pop()
        if identifier in seen:
            continue
        seen.add(identifier)
        require_at_most(main.name, len(seen), MOST_LAYERS, "layers")
        files.add(_own_file(identifier, root))
        require_at_most(
            "all layers together", sum(file.stat().st_size for file in files), max_bytes, "bytes"
        )
        try:
            layer = Sdf.Layer.FindOrOpen(identifier)
        except Tf.ErrorException as error:
            raise unreadable(Path(identifier).name, _plain(error, root)) from error
        if layer is None:
            raise unreadable(Path(identifier).name, "is no USD layer")
        _refuse_clips(layer)
        for reference in layer.GetCompositionAssetDependencies():
            if reference:
                waiting.append(_identifier(reference, layer))
    return tuple(sorted(files))


def _identifier(reference: str, layer: Any) -> str:
    """What a reference in a layer would open, without opening it."""
    from pxr import Sdf

    path, _ = Sdf.Layer.SplitIdentifier(reference)
    if "`" in path:
        raise InputRejected(
            "unsupported", f"reference {reference[:160]!r}: is computed; want a plain file name"
        )
    if _SCHEME.match(path) or "\0" in path:
        raise _external(reference)
    found = str(Sdf.ComputeAssetPathRelativeToLayer(layer, path))
    # What is not beside the layer would be looked for elsewhere: here it is only missed.
    return (
        found
        if Path(found).is_absolute() or not layer.realPath
        else str(Path(layer.realPath).parent / found)
    )


def _own_file(identifier: str, root: Path) -> Path:
    """The file that holds a layer, or the package that holds it."""
    from pxr import Ar

    outer = identifier
    while Ar.IsPackageRelativePath(outer):
        outer = Ar.SplitPackageRelativePathOuter(outer)[0]
    path = Path(outer)
    if not path.is_absolute() or not path.resolve().is_relative_to(root):
        raise _external(outer)
    if path.suffix.lower() not in SUFFIXES:
        raise InputRejected(
            "unsupported", f"{path.name}: want one of {', '.join(sorted(SUFFIXES))}"
        )
    if not path.is_file():
        raise InputRejected("missing_file", f"{path.name}: is named by a layer and not there")
    return path.resolve()


def _refuse_clips(layer: Any) -> None:
    """Clips name files in ways that only composition knows."""
    from pxr import Sdf

    found: list[str] = []

    def look(path: Any) -> None:
        is_prim = path.IsPrimPath() or path.IsPrimVariantSelectionPath()
        spec = layer.GetPrimAtPath(path) if is_prim else None
        if spec is not None and spec.HasInfo("clips"):
            found.append(str(path))

    layer.Traverse(Sdf.Path.absoluteRootPath, look)
    if found:
        raise InputRejected(
            "unsupported", f"prim {found[0]}: has value clips; want geometry that stands still"
        )


def _external(reference: str) -> InputRejected:
    name = Path(reference).name[:160]
    return InputRejected(
        "external_reference",
        f"reference to {name!r} leads outside the object's folder; put the file there",
    )


def _plain(error: Exception, root: Path) -> str:
    return str(error).replace(str(root), "")
