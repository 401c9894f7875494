"""A self-contained copy of a description that refers to files beyond its own folder.

What reads and simulates it needs to know one folder only, and is never told of another.
"""

from __future__ import annotations

import errno
import os
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import unquote

from ..description import DescriptionError
from ..report import Finding, Severity
from .document import find_file, parse_document
from .meshes import MAX_MESH_BYTES
from .references import (
    DOCUMENTS,
    SRDF,
    MujocoModel,
    NamedFile,
    follow_models,
    named_in_mesh,
    urdf_references,
)
from .regular import read_regular
from .roots import ReadOptions, Roots
from .xacro import expand_xacro, is_xacro

#: Of all files of one description together [bytes], and how many.
MOST_BYTES = 2 * 2**30
MOST_FILES = 20_000
#: Where a compiler element of an MJCF sends readers, which copies name in full.
FOLDERS = ("meshdir", "texturedir", "assetdir", "strippath")


@dataclass(frozen=True)
class Gathered:
    """A description whose files all lie in its own folder.

    Attributes:
        path: the description to read: the original where that is so, else the copy.
        files: the originals of copies, in the order of first use.
        findings: what a reader of the report is told.
    """

    path: Path
    files: tuple[Path, ...] = ()
    findings: tuple[Finding, ...] = ()


def gather(path: Path, folder: Path, options: ReadOptions) -> Gathered:
    """Return a description with all that it refers to in one folder; an empty one is for copies.

    Raises:
        DescriptionError: ``outside_folder``, ``missing_file``, ``too_large``, ``unreadable``,
            ``nested_too_deep``, and whatever is wrong with an inner document.
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
        models = follow_models(path, document, allows=roots.allows)
        for number, model in enumerate(models):
            _copy_model(model, copies, copies.place(model.main) if number else target)
    else:
        _copy_urdf(path, document, copies, target)
        # One that somebody names may lie anywhere.
        srdf = options.srdf or path.with_name(target.name).with_suffix(SRDF)
        if os.path.isfile(srdf):
            target.with_suffix(SRDF).write_bytes(copies.read(srdf))
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
        follow_models(path, document)
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


def _copy_model(model: MujocoModel, copies: Copies, target: Path) -> None:
    """Write a model's own file to ``target``, and what it includes; copy every file it names."""
    for named in model.named:
        place = Path(os.path.relpath(_copied(named, copies), target.parent))
        named.element.set(named.key, place.as_posix())
    for number, (at, root) in enumerate(model.documents):
        for compiler in root.iter("compiler"):
            for key in FOLDERS:
                compiler.attrib.pop(key, None)
        copies.write(root, at, copies.place(at.resolve()) if number else target)


def _copied(named: NamedFile, copies: Copies) -> Path:
    """Return where the copy of a file that an element names lies, or will."""
    if not named.files:
        raise DescriptionError("missing_file", f"{named.said}: no such file")
    file = named.files[0]
    return copies.place(file) if named.element.tag in DOCUMENTS else copies.take(file)


class Copies:
    """Copies of files in one folder, each once, in its place, with what they name themselves.

    Attributes:
        originals: the files that were read, in the order of first use.
    """

    def __init__(self, folder: Path, roots: Roots) -> None:
        folder.mkdir(parents=True)
        self.folder = folder
        self.roots = roots
        self.originals: dict[Path, None] = {}
        self._left = MOST_BYTES

    def place(self, file: Path) -> Path:
        """Return where the copy of a file, by its resolved path, lies."""
        return self.folder / self.roots.copied_to(file)

    def take(self, file: Path) -> Path:
        """Copy a file and, of a mesh, its materials and pictures; returns the copy's place."""
        waiting = [file]
        while waiting:
            original = waiting.pop()
            if original in self.originals:
                continue
            data = self.read(original)
            place = self.place(original)
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(data)
            for name in named_in_mesh(original, data):
                beside = [original.parent / name, original.parent / unquote(name)]
                within = filter(self.roots.allows, beside)
                waiting += [place.resolve() for place in within if os.path.isfile(place)]
        return self.place(file)

    def read(self, file: Path) -> bytes:
        """Return the content of a file, within what all may hold together.

        Raises:
            DescriptionError: ``too_large``, or ``unreadable_mesh``.
        """
        self.originals[file] = None
        try:
            if len(self.originals) > MOST_FILES:
                raise OSError(errno.EFBIG, f"is one of over {MOST_FILES} files")
            data = read_regular(file, min(MAX_MESH_BYTES, self._left))
        except OSError as error:
            code = "too_large" if error.errno == errno.EFBIG else "unreadable_mesh"
            raise DescriptionError(code, f"{file.name}: {error.strerror}") from error
        self._left -= len(data)
        return data

    def write(self, document: ET.Element, original: Path, place: Path) -> None:
        """Write a document, changed, in its place."""
        self.originals[original] = None
        text: bytes = ET.tostring(document, encoding="utf-8")
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(text)
