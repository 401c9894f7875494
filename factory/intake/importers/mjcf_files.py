"""Which files an MJCF refers to, found out before MuJoCo opens any of them."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

from ...errors import InputRejected
from .xml_source import find_reference, read_xml

MAX_DOCUMENTS = 64
#: Elements that bring in another MJCF.
NESTED = ("include", "model")
FOLDERS = ("meshdir", "texturedir", "assetdir")


def referenced_files(root: ET.Element, path: Path, max_bytes: int) -> list[Path]:
    """Return every file that an MJCF and the files it includes refer to, the includes among them.

    Args:
        root: the ``<mujoco>`` element.
        path: the file it came from; all others lie in or below its folder.
        max_bytes: largest XML file [bytes].

    Raises:
        InputRejected: ``external_reference``, ``missing_file``, ``unreadable``, ``too_large``.
    """
    documents = _documents(root, path, max_bytes)
    folders = [
        "",
        *dict.fromkeys(f for document, _, _ in documents for f in _asset_folders(document)),
    ]
    stripped = any(
        c.get("strippath") == "true"
        for document, _, _ in documents
        for c in document.iter("compiler")
    )
    found = [file for _, file, _ in documents[1:]]
    for document, _, base in documents:
        for element in document.iter():
            if element.tag in NESTED:
                continue
            where = f"{path.name}: <{element.tag}> {element.get('name', '')}".rstrip()
            for reference in (
                value for key, value in element.attrib.items() if key.startswith("file") and value
            ):
                name = reference.replace("\\", "/").rsplit("/", 1)[-1] if stripped else reference
                found += _candidates(name, folders, path.parent, base, where)
    return list(dict.fromkeys(found))


def _documents(root: ET.Element, path: Path, max_bytes: int) -> list[tuple[ET.Element, Path, Path]]:
    """The file, what it includes and attaches: elements, their poses, where references start."""
    documents = [(root, path, path.parent)]
    for document, file, base in documents:
        for element in (e for e in document.iter() if e.tag in NESTED):
            reference = element.get("file", "")
            where = f"{file.name}: <{element.tag}>"
            target = find_reference(reference, path.parent, where, base)
            # What is included becomes part of the file; what is attached stands in its own folder.
            start = base if element.tag == "include" else target.parent
            documents.append((read_xml(target, max_bytes), target, start))
            if len(documents) > MAX_DOCUMENTS:
                raise InputRejected(
                    "unreadable",
                    f"{path.name}: includes over {MAX_DOCUMENTS} files, or itself; want fewer",
                    value=len(documents),
                    limit=MAX_DOCUMENTS,
                )
    return documents


def _asset_folders(document: ET.Element) -> list[str]:
    return [
        value
        for compiler in document.iter("compiler")
        for key in FOLDERS
        if (value := compiler.get(key))
    ]


def _candidates(
    reference: str, folders: list[str], root: Path, base: Path, where: str
) -> list[Path]:
    """Return the file under each folder it could mean; one is enough, none may lead outside."""
    found = []
    missing = None
    for folder in folders:
        try:
            found.append(
                find_reference(f"{folder}/{reference}" if folder else reference, root, where, base)
            )
        except InputRejected as error:
            if error.code != "missing_file":
                raise
            missing = error
    if not found and missing is not None:
        raise missing
    return found
