"""The page of one file, complete in itself."""

from __future__ import annotations

from pathlib import Path

from asset_factory.sim_checks import Status

from ...errors import InputRejected
from ...intake.naming import safe_name
from ...registry import Entry
from ...runtime.layout import MODEL, URDF
from ...scene.described import scene_of_file
from ...scene.scene import Scene
from ...scene.stored import read_scene
from .render import alone_html
from .told import AssetPage, with_scene


def page_of_file(path: Path) -> str:
    """One HTML file that shows a URDF, an MJCF, a mesh or an asset's folder.

    Raises:
        InputRejected: it cannot be shown, with a reason code.
    """
    if not path.exists():
        raise InputRejected("missing_file", f"{path.name}: no such file")
    scene = _scene(path)
    entry = Entry(
        id=safe_name(path),
        name=scene.name,
        category="",
        status=Status.PASSED,
        reason="",
        parts=len(scene.links),
        joints=len(scene.movable),
        hulls=len(scene.hulls),
    )
    return alone_html(with_scene(AssetPage(entry), scene))


def _scene(path: Path) -> Scene:
    if path.is_dir():
        path = next((path / name for name in (MODEL, URDF) if (path / name).is_file()), path)
    if path.is_dir():
        raise InputRejected("missing_file", f"{path.name}: no {MODEL} or {URDF} in this folder")
    if path.suffix.lower() == ".glb":
        try:
            return read_scene(path)
        except (OSError, ValueError):
            # Somebody else's GLB is a mesh.
            pass
    return scene_of_file(path)
