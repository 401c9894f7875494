"""What a USD layer leads to, followed before anything is composed: nothing outside its folder."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ...description import DescriptionError

SUFFIXES = frozenset({".usd", ".usda", ".usdc", ".usdz"})
MOST_LAYERS = 4096
MOST_BYTES = 2**30


def require_inside(path: Path) -> None:
    """Refuse an asset of which a sublayer, reference or payload lies outside its folder.

    Raises:
        DescriptionError: ``outside_folder``, ``missing_file``, ``too_large``, ``unreadable``.
    """
    from pxr import Sdf, Tf

    folder = path.resolve().parent
    waiting = [str(path.resolve())]
    seen: set[str] = set()
    total = 0
    while waiting:
        name = waiting.pop()
        if name in seen:
            continue
        seen.add(name)
        total += _file(name, folder).stat().st_size
        if len(seen) > MOST_LAYERS or total > MOST_BYTES:
            raise DescriptionError(
                "too_large",
                f"{path.name}: over {MOST_LAYERS} layers, or {MOST_BYTES} bytes together",
            )
        try:
            layer = Sdf.Layer.FindOrOpen(name)
        except Tf.ErrorException:
            layer = None
        if layer is None:
            raise DescriptionError("unreadable", f"{Path(name).name}: is no USD layer")
        _refuse_clips(layer)
        for reference in layer.GetCompositionAssetDependencies():
            if reference:
                if "`" in reference:
                    raise DescriptionError("outside_folder", "a layer computes which file it needs")
                outer, _ = Sdf.Layer.SplitIdentifier(reference)
                waiting.append(str(layer.ComputeAbsolutePath(outer)))


def _file(name: str, folder: Path) -> Path:
    """The file that a layer is in; of a package, the package."""
    file = Path(name.partition("[")[0]).resolve()
    if not file.is_relative_to(folder) or file.suffix.lower() not in SUFFIXES:
        raise DescriptionError(
            "outside_folder", f"{name[-160:]!r}: want a USD file in the asset's own folder or below"
        )
    if not file.is_file():
        raise DescriptionError("missing_file", f"{file.name}: there is no such file")
    return file


def _refuse_clips(layer: Any) -> None:
    """Which files value clips open is known only once they are open."""
    from pxr import Sdf

    clipped: list[str] = []

    def look(path: Any) -> None:
        prim = layer.GetPrimAtPath(path)
        if prim is not None and prim.HasInfo("clips"):
            clipped.append(str(path))

    layer.Traverse(Sdf.Path.absoluteRootPath, look)
    if clipped:
        raise DescriptionError("outside_folder", f"{clipped[0]}: takes values from other files")
