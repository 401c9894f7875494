"""The pages of the site, from the templates beside this file."""

from __future__ import annotations

import base64
import gzip
import hashlib
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from asset_factory.sim_checks import Severity, Status

from ...runtime.layout import SOLVING
from ..pages import environment, trusted
from .told import AssetPage

if TYPE_CHECKING:
    from jinja2 import Environment

#: What comes with the package: built by ``make site``, or written by hand.
STATIC = Path(__file__).parent / "static"
STATIC_FILES = ("base.css", "site.css", "grid.js", "asset.js", "licenses.txt")


def asset_html(
    page: AssetPage, films: Sequence[str] = (), seconds: Mapping[str, float] | None = None
) -> str:
    """Return the page of an asset in a site: pictures, model and scripts lie beside it.

    ``films`` are named ``<id>-<joint>-<robot>.mp4``; ``seconds`` [s] are its stages'.
    """
    shown = {"films": films, "folder": f"../../../{SOLVING}/", "seconds": seconds or {}}
    return _templates().get_template("asset.html.j2").render(page=page, alone=None, **shown)


def alone_html(page: AssetPage, live: bool = False) -> str:
    """Return the page of an asset as one file that needs nothing else.

    If ``live``, it is served, and files may be dropped on it.
    """
    model = packed(page.model)
    texts = {name: (STATIC / name).read_text(encoding="utf-8") for name in STATIC_FILES}
    js = f'factoryModel="{model}";\n{texts["asset.js"]}'
    digest = base64.b64encode(hashlib.sha256(js.encode()).digest()).decode()
    alone = {
        "css": trusted(texts["base.css"] + texts["site.css"]),
        "js": trusted(js),
        "digest": trusted(f"'sha256-{digest}'"),
        "licenses": trusted(texts["licenses.txt"]),
    }
    shown = {"films": (), "seconds": {}, **({"live": True} if live else {})}
    return _templates().get_template("asset.html.j2").render(page=page, alone=alone, **shown)


def grid_html(rows: Sequence[Mapping[str, Any]], lists: int, title: str) -> str:
    """Return the grid's page."""
    counts = {status: sum(row["status"] == status for row in rows) for status in Status}
    template = _templates().get_template("grid.html.j2")
    return template.render(total=len(rows), counts=counts, lists=lists, title=title)


def list_html(rows: Sequence[Mapping[str, Any]], number: int, lists: int, title: str) -> str:
    """Render a plain list of assets, for browsers without scripts; ``number`` from 1."""
    template = _templates().get_template("list.html.j2")
    return template.render(rows=rows, number=number, lists=lists, title=title)


def packed(model: bytes) -> str:
    """Return a GLB as it stands in a script: gzip in base64, the same for the same bytes."""
    return base64.b64encode(gzip.compress(model, 4, mtime=0)).decode()


@cache
def _templates() -> Environment:
    known = {"PASSED": Status.PASSED, "STATUSES": tuple(Status), "SEVERITIES": tuple(Severity)}
    return environment(__package__, **known)
