"""Every file that a description names, directly or not, lies in its folder.

This is known before any is opened.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..description import DescriptionError
from .document import (
    inside,
    is_file,
    is_there,
    locate,
    outside_error,
    parse_document,
    refuse_address,
)
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
        said: the element and its reference, for a sentence.
        places: where in the folder MuJoCo may look for it.
        files: those that lie there, resolved, each once.
    """

    said: str
    places: tuple[Path, ...]
    files: tuple[Path, ...]


@dataclass(frozen=True)
class MujocoModel:
    """A main file and what it includes, which share one set of folders.

    Attributes:
        allows: tells whether a path may be opened.
        base: the main file's own folder.
        documents: path and root element, the main file first.
    """

    allows: Allows
    base: Path
    documents: tuple[tuple[Path, ET.Element], ...]

    def settings(self, key: str) -> list[str]:
        """Return what the compiler elements say of ``key``, the last word first."""
        found = [item.get(key) for _, root in self.documents for item in root.iter("compiler")]
        return [value for value in reversed(found) if value is not None]

    def places(self, element: ET.Element, key: str, document: Path) -> list[Path]:
        """Return where MuJoCo may look for a file; the first is where it should."""
        reference = _plain(element.get(key, ""))
        if element.tag in DOCUMENTS:
            return [self.base / reference, document.parent / reference]
        own = self.settings("texturedir" if element.tag == "texture" else "meshdir")
        folders = [_plain(folder) for folder in (*own, *self.settings("assetdir"))] or [""]
        names = [reference]
        if "true" in self.settings("strippath"):
            names.insert(0, Path(reference).name)
        bases = [self.base, document.parent]
        return [base / folder / name for name in names for folder in folders for base in bases]

    def inner(self, element: ET.Element, document: Path) -> tuple[Path, ...]:
        """Return the documents that an element of :data:`DOCUMENTS` may mean, of those there."""
        places = self.places(element, "file", document) if element.get("file") else []
        return found([place for place in places if self.allows(place)])

    def naming(self) -> Iterator[tuple[ET.Element, str, Path]]:
        """Yield every attribute that names a file: its element, its key and its document."""
        for document, root in self.documents:
            for element in root.iter():
                keys = (key for key in element.attrib if key.startswith("file"))
                yield from ((element, key, document) for key in keys if element.get(key))

    def attached(self) -> dict[Path, None]:
        """Return the models that this one attaches, each once."""
        named = ((item, at) for at, root in self.documents for item in root.iter("model"))
        return dict.fromkeys(model for item, at in named for model in self.inner(item, at))


def _plain(reference: str) -> str:
    return reference.rpartition("://")[2].replace("\\", "/")


def named_files(
    path: Path, document: ET.Element, parse: Parser = parse_document
) -> tuple[NamedFile, ...]:
    """Return every file that an MJCF model names, in every document that it includes or attaches.

    The outermost file is given with its root element; ``parse`` reads inner documents.

    Raises:
        DescriptionError: ``outside_folder``; ``nested_too_deep`` for documents that hold each
            other; and whatever is wrong with an inner document.
    """
    folder = path.parent.resolve()
    walk = ModelWalk(lambda place: inside(place, folder), parse)
    walk.follow(folder / path.name, document)
    return tuple(walk.named)


class ModelWalk:
    """Follows an MJCF into the documents that it includes and attaches.

    Args:
        allows: tells whether a path may be opened; whatever leads elsewhere is refused.
        parse: reads an inner document.

    Attributes:
        named: every file that was named so far.
    """

    def __init__(self, allows: Allows, parse: Parser = parse_document) -> None:
        self._allows = allows
        self._parse = parse
        self._left = MOST_DOCUMENTS
        self.named: list[NamedFile] = []

    def model(self, path: Path, document: ET.Element, above: tuple[Path, ...] = ()) -> MujocoModel:
        """Return a main file, nested in the documents ``above``, with all that it includes."""
        documents = tuple(self._with_included(path, document, path.parent, above))
        return MujocoModel(self._allows, path.parent, documents)

    def follow(
        self, path: Path, document: ET.Element, above: tuple[Path, ...] = ()
    ) -> list[MujocoModel]:
        """Return a model and those that it attaches, whose files are noted."""
        model = self.model(path, document, above)
        models = [model]
        for element, key, at in model.naming():
            if element.tag != "include":
                self._note(element, key, model.places(element, key, at))
        for inner in model.attached():
            models += self.follow(inner, self._parse(inner), _nested(inner, (*above, path)))
        return models

    def _with_included(
        self, path: Path, document: ET.Element, base: Path, above: tuple[Path, ...]
    ) -> Iterator[tuple[Path, ET.Element]]:
        """Yield a document and those that it includes."""
        self._left -= 1
        if self._left < 0:
            holds = f"{path.name}: the model holds over {MOST_DOCUMENTS} documents"
            raise DescriptionError("nested_too_deep", f"{holds}, at most so many are read")
        yield path, document
        model = MujocoModel(self._allows, base, ())
        for element in document.iter("include"):
            for inner in self._note(element, "file", model.places(element, "file", path)):
                chain = _nested(inner, (*above, path))
                yield from self._with_included(inner, self._parse(inner), base, chain)

    def _note(self, element: ET.Element, key: str, places: Sequence[Path]) -> tuple[Path, ...]:
        """Return the files that an element may mean, of those there; refuse what leads out."""
        reference = element.get(key, "")
        if not reference:
            return ()
        refuse_address(reference)
        outside = [place for place in places if not self._allows(place)]
        # Which rule it goes by depends on its version: a place it might look at counts where
        # something lies there.
        if places[0] in outside or any(is_there(place) for place in outside):
            raise outside_error(reference, outside)
        within = tuple(place for place in places if place not in outside)
        files = found(within)
        self.named.append(NamedFile(f"<{element.tag}> {reference[:160]!r}", within, files))
        return files


def found(places: Sequence[Path]) -> tuple[Path, ...]:
    """Return those of some places where a file lies, links followed, each once."""
    return tuple(dict.fromkeys(place.resolve() for place in places if is_file(place)))


def _nested(inner: Path, chain: tuple[Path, ...]) -> tuple[Path, ...]:
    """Return the documents that hold an inner one. Raises DescriptionError ``nested_too_deep``."""
    nested_in = f"{inner.name} is nested in"
    if inner in chain:
        raise DescriptionError("nested_too_deep", f"{nested_in} itself; want documents that end")
    if len(chain) > MOST_NESTED:
        message = f"{nested_in} {len(chain)} documents, at most {MOST_NESTED} are read"
        raise DescriptionError("nested_too_deep", message)
    return chain


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
