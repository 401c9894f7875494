"""The page and the files that it is made of."""

from __future__ import annotations

from pathlib import Path

from ..report.pages import environment
from ..report.site.render import STATIC

_OWN = Path(__file__).parent / "static"
_KINDS = {".css": "text/css", ".js": "text/javascript"}
_SHARED = tuple(STATIC / name for name in ("base.css", "site.css", "asset.js"))
#: By name: nothing else of any folder is within a browser's reach.
STATIC_FILES = {path.name: path for path in (*_SHARED, *sorted(_OWN.iterdir()))}


def page_html(name: str) -> str:
    """Return the page on which the mesh of that name is edited."""
    template = environment(__package__).get_template("edit.html.j2")
    return template.render(name=name, top="", alone=None)


def static_file(name: str) -> tuple[bytes, str]:
    """Return the content and the kind of one of ``STATIC_FILES``."""
    path = STATIC_FILES[name]
    return path.read_bytes(), _KINDS[path.suffix]
