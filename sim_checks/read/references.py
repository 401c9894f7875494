"""Every file that a description names, directly or not, lies in its folder.

This is known before any is opened.
"""

from __future__ import annotations

import os
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain
from pathlib import Path

from ..description import DescriptionError
from .document import inside, locate, outside_error, parse_document, refuse_address
from .meshes import MAX_MESH_BYTES
from .regular import read_regular

#: Documents that may be nested in one another.
MOST_NESTED = 16
#: Documents in all: twenty that each name the next one twice would be a million.
MOST_DOCUMENTS = 256
#: Elements whose files are whole documents, which name files of their own.
DOCUMENTS = ("include", "model")
#: How the file beside a URDF ends that says which of its links may pass through each other.
SRDF = ".srdf"
#: Returns the root element of a document.
Parser = Callable[[Path], ET.Element]
#: Tells whether a path, every link in it followed, may be opened.
Allows = Callable[[Path], bool]


@dataclass(frozen=True)
class NamedFile:
    """A file that an element of an MJCF names.

    Attributes:
        element, key: the element, and its attribute.
        places: where in the folder MuJoCo may look for it.
        files: those that lie there, resolved, each once.
    """

    element: ET.Element
    key: str
    places: tuple[Path, ...]
    files: tuple[Path, ...]

    @property
    def said(self) -> str:
        """Return the element and its reference, for a sentence."""
        return f"<{self.element.tag}> {self.element.get(self.key, '')[:160]!r}"


@dataclass
class MujocoModel:
    """A main file and what it includes, which share one set of folders.

    Attributes:
        documents: path and root element, the main file first.
        named: every file that they name.
    """

    documents: list[tuple[Path, ET.Element]] = field(default_factory=list)
    named: list[NamedFile] = field(default_factory=list)

    @property
    def main(self) -> Path:
        """Return the path of the main file."""
        return self.documents[0][0]

    @cached_property
    def inner(self) -> Mapping[ET.Element, tuple[Path, ...]]:
        """Return the documents that an element of :data:`DOCUMENTS` may mean, of those there."""
        whole = (each for each in self.named if each.element.tag in DOCUMENTS)
        return {each.element: each.files for each in whole if each.key == "file"}

    @cached_property
    def attached(self) -> tuple[Path, ...]:
        """Return the models that this one attaches, each once."""
        named = (files for element, files in self.inner.items() if element.tag == "model")
        return tuple(dict.fromkeys(chain.from_iterable(named)))

    def settings(self, key: str) -> list[str]:
        """Return what the compiler elements say of ``key``, the last word first."""
        found = [item.get(key) for _, root in self.documents for item in root.iter("compiler")]
        return [value for value in reversed(found) if value is not None]

    def places(self, element: ET.Element, key: str, document: Path) -> list[Path]:
        """Return where MuJoCo may look for a file; the first is where it should."""
        reference = _plain(element.get(key, ""))
        bases = [self.main.parent, document.parent]
        if element.tag in DOCUMENTS:
            return [base / reference for base in bases]
        own = self.settings("texturedir" if element.tag == "texture" else "meshdir")
        folders = [_plain(folder) for folder in (*own, *self.settings("assetdir"))] or [""]
        stripped = [Path(reference).name] if "true" in self.settings("strippath") else []
        names = [*stripped, reference]
        return [base / folder / name for name in names for folder in folders for base in bases]


def _plain(reference: str) -> str:
    return reference.rpartition("://")[2].replace("\\", "/")


def follow_models(
    path: Path, document: ET.Element, parse: Parser = parse_document, allows: Allows | None = None
) -> list[MujocoModel]:
    """Return an MJCF model and those that it attaches, with every file that they name.

    Args:
        path: of the outermost file.
        document: its root element.
        parse: reads an inner document.
        allows: tells whether a path may be opened; ``None`` for those in the file's folder.
            Whatever leads elsewhere is refused.

    Raises:
        DescriptionError: ``outside_folder``; ``nested_too_deep`` for documents that hold each
            other; and whatever is wrong with an inner document.
    """
    folder = path.parent.resolve()
    walk = _ModelWalk(parse, allows or (lambda place: inside(place, folder)))
    return walk.follow(folder / path.name, document, ())


class _ModelWalk:
    """Follows an MJCF into the documents that it includes and attaches."""

    def __init__(self, parse: Parser, allows: Allows) -> None:
        self._parse = parse
        self._allows = allows
        self._left = MOST_DOCUMENTS

    def follow(
        self, path: Path, document: ET.Element, above: tuple[Path, ...]
    ) -> list[MujocoModel]:
        """Return a model that is nested in the documents ``above``, and those that it attaches."""
        model = MujocoModel()
        self._include(model, path, document, above)
        for at, root in model.documents:
            for element in root.iter():
                # Included documents were noted on the way.
                keys = element.attrib if element.tag != "include" else ()
                for key in filter(lambda key: key.startswith("file"), keys):
                    self._note(model, element, key, at)
        models = [model]
        for inner in model.attached:
            models += self.follow(inner, self._parse(inner), _nested(inner, (*above, path)))
        return models

    def _include(
        self, model: MujocoModel, path: Path, document: ET.Element, above: tuple[Path, ...]
    ) -> None:
        """Add a document to a model, with those that it includes."""
        self._left -= 1
        if self._left < 0:
            holds = f"{path.name}: the model holds over {MOST_DOCUMENTS} documents"
            raise DescriptionError("nested_too_deep", f"{holds}, at most so many are read")
        model.documents.append((path, document))
        for element in document.iter("include"):
            for inner in self._note(model, element, "file", path):
                self._include(model, inner, self._parse(inner), _nested(inner, (*above, path)))

    def _note(
        self, model: MujocoModel, element: ET.Element, key: str, document: Path
    ) -> tuple[Path, ...]:
        """Return the files that an element may mean, of those there; refuse what leads out."""
        reference = element.get(key, "")
        if not reference:
            return ()
        refuse_address(reference)
        places = model.places(element, key, document)
        outside = [place for place in places if not self._allows(place)]
        # Which rule it goes by depends on its version: a place it might look at counts where
        # something lies there.
        if places[0] in outside or any(os.path.exists(place) for place in outside):
            raise outside_error(reference, outside)
        within = tuple(place for place in places if place not in outside)
        files = tuple(dict.fromkeys(place.resolve() for place in within if os.path.isfile(place)))
        model.named.append(NamedFile(element, key, within, files))
        return files


def _nested(inner: Path, above: tuple[Path, ...]) -> tuple[Path, ...]:
    """Return the documents that hold an inner one. Raises DescriptionError ``nested_too_deep``."""
    nested_in = f"{inner.name} is nested in"
    if inner in above:
        raise DescriptionError("nested_too_deep", f"{nested_in} itself; want documents that end")
    if len(above) > MOST_NESTED:
        message = f"{nested_in} {len(above)} documents, at most {MOST_NESTED} are read"
        raise DescriptionError("nested_too_deep", message)
    return above


def urdf_references(document: ET.Element) -> list[ET.Element]:
    """Return the elements of a URDF that name a file; a plugin names some program's library."""
    return [item for item in document.iter() if item.get("filename") and item.tag != "plugin"]


def refuse_outside_urdf(path: Path, document: ET.Element) -> None:
    """Refuse a URDF that names a file outside its folder, even one that only an engine reads.

    Raises:
        DescriptionError: ``outside_folder``.
    """
    folder = path.parent.resolve()
    for element in urdf_references(document):
        locate(element.get("filename", ""), folder)
    beside = path.with_suffix(SRDF)
    if beside.exists() and not inside(beside, folder):
        raise outside_error(beside.name, (beside,))


#: How mesh files name others, by suffix: materials, and their pictures.
_NAMED = {
    ".obj": re.compile(rb"^[ \t]*mtllib[ \t]+([^\r\n]+)", re.MULTILINE),
    ".mtl": re.compile(
        rb"^[ \t]*(?:map_\w+|bump|disp|decal|refl|norm)[ \t]+([^\r\n]+)",
        re.MULTILINE | re.IGNORECASE,
    ),
    ".dae": re.compile(rb"<(?:\w+:)?(?:init_from|ref)>([^<]+)<"),
    **dict.fromkeys((".glb", ".gltf"), re.compile(rb'"uri"\s*:\s*"((?!data:)[^"]+)"')),
    ".ply": re.compile(rb"^comment[ \t]+TextureFile[ \t]+([^\r\n]+)", re.MULTILINE),
}


def refuse_outside_mesh(path: Path, folder: Path) -> None:
    """Refuse a mesh file with materials or pictures outside a folder: an engine might read them.

    Raises:
        DescriptionError: ``outside_folder``.
    """
    if path.suffix.lower() not in _NAMED:
        return
    try:
        data = read_regular(path, MAX_MESH_BYTES)
    except OSError as error:
        message = f"{path.name}: cannot be read: {error.strerror}"
        raise DescriptionError("unreadable_mesh", message) from error
    for name in named_in_mesh(path, data):
        place = path.parent / name
        if not inside(place, folder):
            message = f"{path.name} names {name!r} outside the description's folder"
            raise DescriptionError("outside_folder", message)
        if path.suffix.lower() == ".obj" and place.suffix.lower() == ".mtl" and place.is_file():
            refuse_outside_mesh(place.resolve(), folder)


def named_in_mesh(path: Path, data: bytes) -> Iterator[str]:
    """Yield the names of materials and pictures in a mesh file's content.

    Options may stand before a picture's name, and a name may hold spaces.
    """
    pattern = _NAMED.get(path.suffix.lower())
    for match in pattern.finditer(data) if pattern else ():
        words = match.group(1).decode("utf-8", "replace").strip().replace("\\", "/")
        for name in dict.fromkeys((words, words.split()[-1] if words else "")):
            yield name.removeprefix("file://")
