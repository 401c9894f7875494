"""Hooks of MkDocs: pages whose source lies outside docs/, and links that lead out of it."""

from __future__ import annotations

import logging
import re
from pathlib import Path, PurePosixPath
from posixpath import normpath, relpath
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
#: Pages of the site that are files elsewhere in the repository.
ELSEWHERE = {
    "architecture.md": "ARCHITECTURE.md",
    "changelog.md": "CHANGELOG.md",
    "contributing.md": "CONTRIBUTING.md",
    "model-card.md": "configs/weights/small.md",
    "model-card-of-detector.md": "configs/weights/detector.md",
}
LINK = re.compile(r"(?<!!)\[([^\]]*)\]\(([^)\s]+)\)")
LOG = logging.getLogger("mkdocs.hooks")


def on_files(files: Any, config: Any) -> Any:
    """Add the pages from elsewhere."""
    from mkdocs.structure.files import File

    for page, source in ELSEWHERE.items():
        text = (ROOT / source).read_text(encoding="utf-8")
        files.append(File.generated(config, page, content=text))
    return files


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Turn links between files of the repository into links between pages."""
    here = page.file.src_uri
    source = ELSEWHERE.get(here, f"docs/{here}")
    return LINK.sub(lambda link: _link(link, here, source), markdown)


def _link(link: re.Match[str], here: str, source: str) -> str:
    """Return a link to a page, one from elsewhere too, or the words alone of what is no page."""
    words, target = link.groups()
    path, mark, anchor = target.partition("#")
    if not path or "://" in target or target.startswith("mailto:"):
        return link[0]
    meant = normpath(str(PurePosixPath(source).parent / path))
    pages = {file: page for page, file in ELSEWHERE.items()}
    page = pages.get(meant, meant.removeprefix("docs/") if meant.startswith("docs/") else None)
    if page is not None and page.endswith((".md", ".html", ".json")):
        return f"[{words}]({relpath(page, str(PurePosixPath(here).parent))}{mark}{anchor})"
    if not (ROOT / meant).exists():
        LOG.warning("%s: links to %s, which is not there", source, target)
    return words
