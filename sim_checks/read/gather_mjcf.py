"""A copy of an MJCF model whose files lie in other folders than its own."""

from __future__ import annotations

import os
import xml.etree.ElementTree as ET
from pathlib import Path

from ..description import DescriptionError
from .copies import Copies
from .references import DOCUMENTS, ModelWalk, MujocoModel, found, nested

#: Where a compiler element sends readers, which copies name in full.
FOLDERS = ("meshdir", "texturedir", "assetdir", "strippath")


def copy_mjcf(path: Path, document: ET.Element, copies: Copies, target: Path) -> None:
    """Write a model to ``target``, what it includes and attaches, and every file these name.

    Raises:
        DescriptionError: ``outside_folder``, ``missing_file``, ``nested_too_deep``, and whatever
            is wrong with an inner document.
    """
    here = path.parent.resolve() / path.name
    ModelWalk(copies.roots.allows).follow(here, document)
    walk = ModelWalk(copies.roots.allows)
    _copy_model(here, document, target, walk, copies)


def _copy_model(
    path: Path,
    document: ET.Element,
    target: Path,
    walk: ModelWalk,
    copies: Copies,
    above: tuple[Path, ...] = (),
) -> None:
    model = walk.model(path, document, above)
    attached = [
        inner
        for at, root in model.documents
        for element in root.iter("model")
        for inner in model.inner(element, at)
    ]
    written = [
        (element, key, _copied(element, key, model, at, copies))
        for at, root in model.documents
        for element in root.iter()
        for key in element.attrib
        if key.startswith("file") and element.get(key)
    ]
    for element, key, place in written:
        element.set(key, Path(os.path.relpath(place, target.parent)).as_posix())
    for at, root in model.documents:
        for compiler in root.iter("compiler"):
            for key in FOLDERS:
                compiler.attrib.pop(key, None)
        copies.write(root, at, target if at == path else copies.place(at.resolve()))
    for inner in dict.fromkeys(attached):
        chain = nested(inner, (*above, path))
        _copy_model(inner, walk.parse(inner), copies.place(inner), walk, copies, chain)


def _copied(
    element: ET.Element, key: str, model: MujocoModel, document: Path, copies: Copies
) -> Path:
    """Return where the copy of a file that an element names lies, or will."""
    files = found([p for p in model.places(element, key, document) if copies.roots.allows(p)])
    if not files:
        message = f"<{element.tag}> {element.get(key, '')[:160]!r}: no such file"
        raise DescriptionError("missing_file", message)
    return copies.place(files[0]) if element.tag in DOCUMENTS else copies.take(files[0])
