"""A self-contained copy of a description that refers to files beyond its own folder.

What reads and simulates it needs to know one folder only, and is never told of another.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

from ..description import DescriptionError
from ..report import Finding, Severity
from .copies import Copies
from .document import find_file, is_file, parse_document
from .gather_mjcf import copy_mjcf
from .references import named_files, urdf_references
from .roots import ReadOptions, Roots
from .srdf import SUFFIX as SRDF
from .xacro import expand_xacro, is_xacro


@dataclass(frozen=True)
class Gathered:
    """A description whose files all lie in its own folder.

    Attributes:
        path: the description to read: the original where that is so, else the copy.
        files: the originals of what was copied, in the order of first use.
        findings: what a reader of the report is told.
    """

    path: Path
    files: tuple[Path, ...] = ()
    findings: tuple[Finding, ...] = ()


def gather(path: Path, folder: Path, options: ReadOptions) -> Gathered:
    """Return a description with all that it refers to in one folder.

    Args:
        path: of any file.
        folder: an empty one, for the copy.
        options: what may be read beyond the description's own folder.

    Raises:
        DescriptionError: ``outside_folder``, ``missing_file``, ``too_large``, ``unreadable``.
    """
    try:
        document = parse_document(path)
    except DescriptionError:
        # Its reader says what is wrong with it.
        return Gathered(path)
    made = is_xacro(path, document)
    included: tuple[Path, ...] = ()
    if made:
        document, included = expand_xacro(path, options)
    find_strays = {"robot": _urdf_strays, "mujoco": _mjcf_strays}.get(document.tag)
    strays = find_strays is not None and find_strays(path, document)
    if not (made or strays or options.srdf):
        return Gathered(path)
    roots = Roots(path, options)
    copies = Copies(folder / (path.absolute().parent.name or "root"), roots)
    stem = path.name.removesuffix(path.suffix).removesuffix(".urdf")
    target = copies.folder / (f"{stem}.urdf" if made else path.name)
    if document.tag == "mujoco":
        copy_mjcf(path, document, copies, target)
    else:
        _copy_urdf(path, document, copies, target)
        _copy_srdf(options.srdf or path.with_name(target.name).with_suffix(SRDF), copies, target)
    told = Finding("read_by_xacro", Severity.NOTE, f"{path.name} was expanded by xacro")
    findings = (*([told] if made else []), *([_told(path, roots)] if strays else []))
    return Gathered(target, (*included, *copies.originals), findings)


def _told(path: Path, roots: Roots) -> Finding:
    words = f"{path.name} refers to files in other folders that may be read"
    if roots.package is not None:
        levels = len(roots.looked) - 1
        above = f"{levels} folder{'' if levels == 1 else 's'} above"
        words = f"{path.name} refers to files of its package, whose package.xml lies {above} it"
    return Finding("read_from_root", Severity.NOTE, words)


def _urdf_strays(path: Path, document: ET.Element) -> bool:
    """Return whether a URDF refers to what its folder alone does not explain."""
    for element in urdf_references(document):
        reference = element.get("filename", "")
        try:
            find_file(reference, path.parent)
        except DescriptionError as error:
            # A plain name that is missing here is missing anywhere.
            if error.code == "outside_folder" or "://" in reference or "%" in reference:
                return True
    return False


def _mjcf_strays(path: Path, document: ET.Element) -> bool:
    """Return whether an MJCF, or what it includes, refers to files outside its folder."""
    try:
        named_files(path, document)
    except DescriptionError as error:
        return error.code == "outside_folder"
    return False


def _copy_urdf(path: Path, document: ET.Element, copies: Copies, target: Path) -> None:
    for element in urdf_references(document):
        try:
            file = copies.roots.find(element.get("filename", ""))
        except DescriptionError as error:
            # Physics goes on without a picture.
            if element.tag == "mesh" or error.code != "missing_file":
                raise
            element.set("filename", f"missing/{element.get('filename', '').rpartition('/')[2]}")
        else:
            element.set("filename", copies.take(file).relative_to(copies.folder).as_posix())
    copies.write(document, path, target)


def _copy_srdf(srdf: Path, copies: Copies, target: Path) -> None:
    """Copy an SRDF beside the copy of its URDF; one that somebody names may lie anywhere."""
    if is_file(srdf):
        target.with_suffix(SRDF).write_bytes(copies.read(srdf))
