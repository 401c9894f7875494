"""The page of one file, complete in itself, and of files that are dropped on it."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import suppress
from http import HTTPStatus
from pathlib import Path, PurePosixPath
from tempfile import TemporaryDirectory

from asset_factory.sim_checks import Status

from ...display.described import scene_of_file
from ...display.glb import glb_of, read_model, scene_from
from ...display.pictures import Fault
from ...errors import AssetFactoryError, ConfigError, InputRejected
from ...intake.discover import find_inputs
from ...intake.naming import safe_name, well_formed
from ...registry import Entry
from ...runtime.layout import MODEL, URDF
from .render import alone_html
from .server import NOT_FOUND, PageRequest, PageResponse
from .told import AssetPage


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
    # Only our own assets are closed at lower: another file is shown as it is.
    start = Fault(dict.fromkeys(scene.completed({}), 0.0))
    return alone_html(AssetPage(entry, model=model, start=start), live)


def _model(path: Path) -> bytes:
    if path.is_dir():
        path = next((path / name for name in (MODEL, URDF) if (path / name).is_file()), path)
    if path.is_dir():
        raise InputRejected("missing_file", f"{path.name}: no {MODEL} or {URDF} in this folder")
    if path.suffix.lower() == ".glb":
        # A GLB without joints of ours is a mesh.
        with suppress(OSError, ValueError):
            return read_model(path)
    return glb_of(scene_of_file(path))


#: Of all files of one drop [bytes].
MOST_BYTES = 2**29
TEXT = "text/plain; charset=utf-8"


class DroppedFiles:
    """Answers for the page of a file, and then of whatever is dropped on it.

    Args:
        page: the first one, HTML.
        draw: returns the page of a file, or ``None`` where no answer came; raises
            AssetFactoryError with a sentence.
    """

    def __init__(self, page: str, draw: Callable[[Path], str | None]) -> None:
        self._page = page
        self._draw = draw

    def __call__(self, asked: PageRequest) -> PageResponse:
        """Return the page, or take dropped files."""
        if asked.method == "GET" and asked.path in ("/", "/index.html"):
            return PageResponse(self._page.encode())
        if (asked.method, asked.path) != ("POST", "/drop"):
            return NOT_FOUND
        try:
            with TemporaryDirectory() as folder:
                page = self._draw(unpack_drop(asked.body, Path(folder)))
            if page is None:
                raise ConfigError("It cannot be shown: the terminal says why.")
        except AssetFactoryError as error:
            return PageResponse(str(error).encode(), TEXT, HTTPStatus.BAD_REQUEST)
        self._page = page
        return PageResponse(status=HTTPStatus.NO_CONTENT)


def unpack_drop(body: bytes, folder: Path) -> Path:
    """Write dropped files into a folder; return the one to be shown, descriptions first.

    Args:
        body: a line of JSON with names and sizes, ``[["robot/arm.urdf", 120], ...]``, then the
            bytes of all.
        folder: an empty one.

    Raises:
        ConfigError: these are no files, or there is none among them that can be shown.
    """
    head, _, rest = body.partition(b"\n")
    try:
        told = [(str(name), int(size)) for name, size in json.loads(head)]
        for name, size in told:
            path = PurePosixPath(name)
            if path.is_absolute() or ".." in path.parts or not 0 <= size <= len(rest):
                raise ValueError(name)
            target = folder / path
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(rest[:size])
            rest = rest[size:]
    except (ValueError, TypeError, OSError) as error:
        raise ConfigError(f"dropped files cannot be read: {error}") from error
    found = find_inputs([folder])
    if not found:
        names = ", ".join(name for name, _ in told[:5]) or "nothing"
        raise ConfigError(f"no URDF, MJCF or mesh is among what was dropped: {names}")
    return found[0]
