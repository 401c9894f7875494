"""Every file that a description names, directly or not, lies in its folder.

This is known before any is opened.
"""

import re
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from ..description import DescriptionError
from .document import inside, is_file, locate, parse_document
from .meshes import MAX_MESH_BYTES
from .regular import read_regular

#: Documents that may be nested in one another.
MOST_NESTED = 16
#: Documents in all: twenty that each name the next one twice would be a million.
MOST_DOCUMENTS = 256
#: Elements whose files are whole documents, which name files of their own.
DOCUMENTS = ("include", "model")


#: Returns the root element of a document.
Parser = Callable[[Path], ET.Element]


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
        folder: nothing outside is opened, a resolved path.
        base: the main file's own.
        documents: path and root element, the main file first.
    """

    folder: Path
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
        names = (
            [Path(reference).name, reference]
            if "true" in self.settings("strippath")
            else [reference]
        )
        bases = [self.base, document.parent]
        return [base / folder / name for name in names for folder in folders for base in bases]

    def inner(self, element: ET.Element, document: Path) -> tuple[Path, ...]:
        """Return the documents that an element of :data:`DOCUMENTS` may mean, of those there."""
        places = self.places(element, "file", document) if element.get("file") else []
        return _found([place for place in places if inside(place, self.folder)])


def _plain(reference: str) -> str:
    return reference.rpartition("://")[2].replace("\\", "/")


def named_files(
    path: Path, document: ET.Element, parse: Parser = parse_document
) -> tuple[NamedFile, ...]:
    """Return every file that an MJCF model names, in every document that it includes or attaches.

    Args:
        path: the outermost file.
        document: its root element.
        parse: reads an inner document.

    Raises:
        DescriptionError: ``outside_folder``; ``nested_too_deep`` for documents that hold each
            other; and whatever is wrong with an inner document.
    """
    folder = path.parent.resolve()
    walk = _Walk(folder, parse)
    walk.follow(folder / path.name, document)
    return tuple(walk.named)


def read_model(path: Path, document: ET.Element, folder: Path) -> MujocoModel:
    """Read what a model's main file includes.

    Args:
        path: of the main file.
        document: its root element.
        folder: nothing outside is opened, a resolved path.

    Raises:
        DescriptionError: as :func:`named_files`.
    """
    return _Walk(folder, parse_document).model(path, document)


class _Walk:
    """Follows an MJCF into the documents that it includes and attaches.

    Attributes:
        named: every file that was named so far.
    """

    def __init__(self, folder: Path, parse: Parser) -> None:
        self._folder = folder
        self._parse = parse
        self._left = MOST_DOCUMENTS
        self.named: list[NamedFile] = []

    def model(self, path: Path, document: ET.Element, above: tuple[Path, ...] = ()) -> MujocoModel:
        """Return a main file, nested in the documents ``above``, with all that it includes."""
        documents = tuple(self._with_included(path, document, path.parent, above))
        return MujocoModel(self._folder, path.parent, documents)

    def follow(self, path: Path, document: ET.Element, above: tuple[Path, ...] = ()) -> None:
        """Note the files of a model and of those that it attaches."""
        model = self.model(path, document, above)
        for at, root in model.documents:
            for element in root.iter():
                for key in element.attrib:
                    if key.startswith("file") and element.tag != "include":
                        self._note(element, key, model.places(element, key, at))
        for at, root in model.documents:
            for element in root.iter("model"):
                for inner in model.inner(element, at):
                    self.follow(inner, self._parse(inner), _nested(inner, (*above, path)))

    def _with_included(
        self, path: Path, document: ET.Element, base: Path, above: tuple[Path, ...]
    ) -> Iterator[tuple[Path, ET.Element]]:
        """Yield a document and those that it includes."""
        self._left -= 1
        if self._left < 0:
            message = (
                f"{path.name}: the model holds over {MOST_DOCUMENTS} documents, "
                "at most so many are read"
            )
            raise DescriptionError("nested_too_deep", message)
        yield path, document
        model = MujocoModel(self._folder, base, ())
        for element in document.iter("include"):
            for inner in self._note(element, "file", model.places(element, "file", path)):
                chain = _nested(inner, (*above, path))
                yield from self._with_included(inner, self._parse(inner), base, chain)

    def _note(self, element: ET.Element, key: str, places: Sequence[Path]) -> tuple[Path, ...]:
        """Return the files that an element may mean, of those there; refuse what leads out."""
        reference = element.get(key, "")
        if not reference:
            return ()
        if "://" in reference:
            locate(reference, self._folder)
        outside = [place for place in places if not inside(place, self._folder)]
        # Which rule it goes by depends on its version: a place it might look at counts where
        # something lies there.
        if places[0] in outside or any(_exists(place) for place in outside):
            message = f"{reference[:160]!r} leaves the description's folder; copy it inside"
            raise DescriptionError("outside_folder", message, outside)
        within = tuple(place for place in places if place not in outside)
        files = _found(within)
        self.named.append(NamedFile(f"<{element.tag}> {reference[:160]!r}", within, files))
        return files


def _found(places: Sequence[Path]) -> tuple[Path, ...]:
    return tuple(dict.fromkeys(place.resolve() for place in places if is_file(place)))


def _exists(place: Path) -> bool:
    # Path.exists raises at names that are too long.
    with suppress(OSError):
        return place.exists()
    return False


def _nested(inner: Path, chain: tuple[Path, ...]) -> tuple[Path, ...]:
    if inner in chain:
        raise DescriptionError(
            "nested_too_deep", f"{inner.name} is nested in itself; want documents that end"
        )
    if len(chain) > MOST_NESTED:
        message = (
            f"{inner.name} is nested in {len(chain)} documents, at most {MOST_NESTED} are read"
        )
        raise DescriptionError("nested_too_deep", message)
    return chain


def refuse_outside_urdf(path: Path, document: ET.Element) -> None:
    """Refuse a URDF that names a file outside its folder, even one that only an engine reads.

    Raises:
        DescriptionError: ``outside_folder``.
    """
    folder = path.parent.resolve()
    for element in document.iter():
        # A plugin is the name of a library of some other program.
        reference = element.get("filename") if element.tag != "plugin" else None
        if reference:
            locate(reference, folder)
    beside = path.with_suffix(".srdf")
    if beside.exists() and not inside(beside, folder):
        raise DescriptionError(
            "outside_folder", f"{beside.name} leaves the description's folder; copy it inside"
        )


#: How mesh files name others, by suffix: materials, and their pictures.
_NAMED = {
    ".obj": re.compile(rb"^[ \t]*mtllib[ \t]+([^\r\n]+)", re.MULTILINE),
    ".mtl": re.compile(
        rb"^[ \t]*(?:map_\w+|bump|disp|decal|refl|norm)[ \t]+([^\r\n]+)",
        re.MULTILINE | re.IGNORECASE,
    ),
    ".dae": re.compile(rb"<(?:\w+:)?(?:init_from|ref)>([^<]+)<"),
    ".glb": re.compile(rb'"uri"\s*:\s*"((?!data:)[^"]+)"'),
    ".ply": re.compile(rb"^comment[ \t]+TextureFile[ \t]+([^\r\n]+)", re.MULTILINE),
}


def refuse_outside_mesh(path: Path, folder: Path) -> None:
    """Refuse a mesh file with materials or pictures outside a folder: an engine might read them.

    Raises:
        DescriptionError: ``outside_folder``.
    """
    pattern = _NAMED.get(path.suffix.lower())
    if pattern is None:
        return
    try:
        data = read_regular(path, MAX_MESH_BYTES)
    except OSError as error:
        message = f"{path.name}: cannot be read: {error.strerror}"
        raise DescriptionError("unreadable_mesh", message) from error
    for match in pattern.finditer(data):
        words = match.group(1).decode("utf-8", "replace").strip().replace("\\", "/")
        # Options may stand before a picture's name, and a name may hold spaces.
        for name in dict.fromkeys((words, words.split()[-1] if words else "")):
            place = path.parent / name.removeprefix("file://")
            if not inside(place, folder):
                raise DescriptionError(
                    "outside_folder", f"{path.name} names {name!r} outside the description's folder"
                )
            if path.suffix.lower() == ".obj" and place.suffix.lower() == ".mtl" and place.is_file():
                refuse_outside_mesh(place.resolve(), folder)
