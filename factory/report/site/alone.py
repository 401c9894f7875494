"""The page of one file, complete in itself."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from asset_factory.sim_checks import Status

from ...display.described import scene_of_file
from ...display.glb import glb_of
from ...display.stored import read_model, scene_from
from ...errors import InputRejected
from ...intake.naming import safe_name, well_formed
from ...registry import Entry
from ...runtime.layout import MODEL, URDF
from .render import alone_html
from .told import AssetPage, with_model


def page_of_file(path: Path, live: bool = False) -> str:
    """Return one HTML file that shows a URDF, an MJCF, a mesh or an asset's folder.

    If ``live``, it is served, and other files may be dropped on it.

    Raises:
        InputRejected: it cannot be shown, with a reason code.
    """
    if not path.exists():
        raise InputRejected("missing_file", f"{path.name}: no such file")
    model = _model(path)
    scene = scene_from(model)
    entry = Entry(
        id=safe_name(path),
        name=well_formed(path.name),
        category="",
        status=Status.PASSED,
        reason="",
        parts=len(scene.links),
        joints=len(scene.movable),
        hulls=len(scene.hulls),
    )
    page = with_model(AssetPage(entry), model)
    # Only our own assets are closed at lower: another file is shown as it is.
    start = {"values": dict.fromkeys(scene.completed({}), 0.0), "point": None}
    return alone_html(replace(page, data={**page.data, "start": start}), live)


def _model(path: Path) -> bytes:
    if path.is_dir():
        path = next((path / name for name in (MODEL, URDF) if (path / name).is_file()), path)
    if path.is_dir():
        raise InputRejected("missing_file", f"{path.name}: no {MODEL} or {URDF} in this folder")
    if path.suffix.lower() == ".glb":
        try:
            return read_model(path)
        except (OSError, ValueError):
            # A GLB without joints of ours is a mesh.
            pass
    return glb_of(scene_of_file(path))
