"""The folder of a site: which pages are as they should be, and which are left to write."""

from __future__ import annotations

import json
import shutil
from bisect import bisect_left
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from ...display.pictures import pictures_of
from ...display.sheet import MOST, SheetCell, contact_sheet
from ...errors import RegistryError
from ...registry import Entry, Registry
from ...registry.entry import is_id
from ...registry.logged import logged_build
from ...runtime.keys import installed_version
from ...runtime.layout import PAGES, REPORT, SOLVING
from ...runtime.store import digest_bytes, digest_file, stage_key, write_json, write_whole
from .render import STATIC, STATIC_FILES, asset_html, grid_html, list_html, packed
from .told import AssetPage, asset_page

#: In the site's folder.
INDEX = "index.html"
SHEET = "sheet.png"
_ASSETS = "a"
_ROW = "row.json"
_DATA = "assets.js"
#: Assets on one plain list.
LISTED = 1000
_LIBRARIES = ("embreex", "numpy", "pillow")


def index_of(root: Path) -> Path:
    """Return the first page of a registry's report."""
    return root / PAGES / INDEX


def stale(registry: Registry) -> Iterator[Entry]:
    """Yield entries whose page is missing or old; pages of missing entries are removed first."""
    folder = registry.root / PAGES / _ASSETS
    entries = tuple(registry.walk())
    known = {entry.id for entry in entries}
    for old in folder.iterdir() if folder.is_dir() else ():
        if old.name not in known and is_id(old.name) and not old.is_symlink():
            shutil.rmtree(old)
    films = _all_films(registry.root)
    for entry in entries:
        row = _row(folder / entry.id)
        if row is None or row["key"] != page_key(registry.root, entry, _films(films, entry)):
            yield entry


def page_key(root: Path, entry: Entry, films: Sequence[str]) -> str:
    """Return what a page follows from: the entry, its report and films, and the code."""
    try:
        told = digest_file(root / entry.folder / REPORT)
    except OSError:
        told = "unreadable"
    return stage_key("page", repr(entry), told, *films, _code())


def _all_films(root: Path) -> list[str]:
    """Return the names of a registry's films, ``<id>-<joint>-<robot>.mp4``, sorted."""
    return sorted(path.name for path in (root / SOLVING).glob("*.mp4"))


def _films(names: Sequence[str], entry: Entry) -> Sequence[str]:
    """Return those of one asset; a point comes next after a hyphen."""
    return names[bisect_left(names, f"{entry.id}-") : bisect_left(names, f"{entry.id}.")]


def write_asset(root: Path, entry: Entry) -> None:
    """Write the page of one asset with its pictures and model; its row, last, says it is whole.

    Raises:
        OSError: the site cannot be written.
    """
    folder = root / PAGES / _ASSETS / entry.id
    folder.mkdir(parents=True, exist_ok=True)
    films = _films(_all_films(root), entry)
    key = page_key(root, entry, films)
    try:
        page = asset_page(root, entry)
    except RegistryError:
        page = AssetPage(entry)
    if page.scene is not None:
        pictures = pictures_of(page.scene, page.fault)
        for name in ("closed", "opened", "hulls", "moving", "fault"):
            data = getattr(pictures, name)
            if data:
                (folder / f"{name}.webp").write_bytes(data)
        (folder / "model.js").write_bytes(f'factoryModel="{packed(page.model)}";\n'.encode())
    logged = logged_build(root, entry.id)
    html = asset_html(page, films, logged.stages if logged else None)
    write_whole(folder / INDEX, html.encode())
    write_json(folder / _ROW, {"key": key, "row": page.row()})


def write_index(registry: Registry) -> None:
    """Write the grid, the plain lists and the contact sheet of all pages.

    Raises:
        OSError: the site cannot be written.
    """
    site = registry.root / PAGES
    site.mkdir(parents=True, exist_ok=True)
    for name in STATIC_FILES:
        if not (site / name).is_file() or digest_file(site / name) != digest_file(STATIC / name):
            write_whole(site / name, (STATIC / name).read_bytes())
    rows = [_told(site / _ASSETS, entry) for entry in registry.walk()]
    rows.sort(key=lambda row: (row["name"].lower(), row["id"]))
    fields = sorted(rows[0]) if rows else []
    table = {"fields": fields, "rows": [[row[name] for name in fields] for row in rows]}
    text = json.dumps(table, separators=(",", ":"), allow_nan=False)
    write_whole(site / _DATA, f"factoryAssets={text};\n".encode())
    pages = [rows[start : start + LISTED] for start in range(0, len(rows), LISTED)] or [[]]
    title = registry.root.resolve().name
    for number, part in enumerate(pages, start=1):
        text = list_html(part, number, len(pages), title)
        write_whole(site / f"list-{number}.html", text.encode())
    write_whole(site / SHEET, _sheet(site, rows))
    write_whole(site / INDEX, grid_html(rows, len(pages), title).encode())


def _told(folder: Path, entry: Entry) -> dict[str, Any]:
    """Return what the grid says of an entry; without a page of its own, what its row says."""
    row = _row(folder / entry.id)
    return AssetPage(entry).row() if row is None else row["row"]


def _row(folder: Path) -> dict[str, Any] | None:
    try:
        row = json.loads((folder / _ROW).read_bytes())
    except (OSError, ValueError):
        return None
    complete = isinstance(row, dict) and row.keys() >= {"key", "row"}
    return row if complete and (folder / INDEX).is_file() else None


def _sheet(site: Path, rows: list[dict[str, Any]]) -> bytes:
    cells = []
    for row in rows[:MOST]:
        picture = site / _ASSETS / row["id"] / f"{row['picture']}.webp"
        data = picture.read_bytes() if row["picture"] and picture.is_file() else b""
        cells.append(SheetCell(data, row["name"], row["status"], row["reason"] or row["about"]))
    return contact_sheet(cells)


@cache
def _code() -> str:
    """Return the code and the libraries that draw pages."""
    package = Path(__file__).parents[2]
    folders = ("report", "display")
    found = (file for name in folders for file in (package / name).rglob("*"))
    files = sorted(file for file in found if file.suffix in {".py", ".j2"})
    lines = [digest_file(file) for file in files if "node_modules" not in file.parts]
    lines += [f"{name} {installed_version(name)}" for name in _LIBRARIES]
    return digest_bytes("\n".join(lines).encode())
