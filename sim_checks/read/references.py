"""Every file that a description names, directly or not, lies in its folder.

This is known before any is opened.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from ..description import DescriptionError
from .document import inside, locate, parse_document
from .meshes import MAX_MESH_BYTES
from .regular import read_regular

#: Documents that may be nested in one another.
MOST_NESTED = 16
#: Documents in all: twenty that each name the next one twice would be a million.
MOST_DOCUMENTS = 256
#: Elements whose files are whole documents, which name files of their own.
DOCUMENTS = ("include", "model")


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

    def inner(self, element: ET.Element, document: Path) -> list[Path]:
        """Return the documents that an element of :data:`DOCUMENTS` may mean, of those there."""
        places = self.places(element, "file", document) if element.get("file") else []
        return _found([place for place in places if inside(place, self.folder)])


def _plain(reference: str) -> str:
    return reference.rpartition("://")[2].replace("\\", "/")


def refuse_outside_mjcf(path: Path, document: ET.Element) -> None:
    """Refuse an MJCF model that names a file outside its folder.

    Every attribute that names a file counts, in every document that is included or attached,
    however deep.

    Args:
        path: the outermost file.
        document: its root element.

    Raises:
        DescriptionError: ``outside_folder``; ``nested_too_deep`` for documents that hold each
            other; and whatever is wrong with an inner document.
    """
    _refuse_model(path.resolve(), document, path.parent.resolve(), (), iter(range(MOST_DOCUMENTS)))


def read_model(
    path: Path,
    document: ET.Element,
    folder: Path,
    above: Sequence[Path] = (),
    left: Iterator[int] | None = None,
) -> MujocoModel:
    """Read what a model's main file includes.

    Args:
        path: of the main file, resolved.
        document: its root element.
        folder: nothing outside is opened, a resolved path.
        above: documents that this model is nested in.
        left: one item for each document that may still be read.

    Raises:
        DescriptionError: as :func:`refuse_outside_mjcf`.
    """
    left = iter(range(MOST_DOCUMENTS)) if left is None else left
    documents = tuple(_with_included(path, document, folder, path.parent, above, left))
    return MujocoModel(folder, path.parent, documents)


def _refuse_model(
    path: Path, document: ET.Element, folder: Path, above: Sequence[Path], left: Iterator[int]
) -> None:
    model = read_model(path, document, folder, above, left)
    documents = model.documents
    for at, root in documents:
        for element in root.iter():
            for key in element.attrib:
                if key.startswith("file") and element.tag != "include":
                    _refuse_places(element.get(key, ""), model.places(element, key, at), folder)
    for at, root in documents:
        for element in root.iter("model"):
            for inner in model.inner(element, at):
                _refuse_model(
                    inner, parse_document(inner), folder, _nested(inner, (*above, path)), left
                )


def _with_included(
    path: Path,
    document: ET.Element,
    folder: Path,
    base: Path,
    above: Sequence[Path],
    left: Iterator[int],
) -> Iterator[tuple[Path, ET.Element]]:
    """A document and those it includes; ``left`` has one item for each that may still be read."""
    if next(left, None) is None:
        message = (
            f"{path.name}: the model holds over {MOST_DOCUMENTS} documents, "
            "at most so many are read"
        )
        raise DescriptionError("nested_too_deep", message)
    yield path, document
    model = MujocoModel(folder, base, ())
    for element in document.iter("include"):
        places = model.places(element, "file", path)
        _refuse_places(element.get("file", ""), places, folder)
        for inner in _found(places):
            chain = _nested(inner, (*above, path))
            yield from _with_included(inner, parse_document(inner), folder, base, chain, left)


def _refuse_places(reference: str, places: Sequence[Path], folder: Path) -> None:
    outside = [place for place in places if not inside(place, folder)]
    # Which rule it goes by depends on its version: a place it might look at counts where something
    # lies there.
    if (
        reference
        and outside
        and (places[0] in outside or any(_is(Path.exists, place) for place in outside))
    ):
        raise DescriptionError(
            "outside_folder", f"{reference[:160]!r} leaves the description's folder; copy it inside"
        )


def _found(places: Sequence[Path]) -> list[Path]:
    return list(dict.fromkeys(place.resolve() for place in places if _is(Path.is_file, place)))


def _is(what: Callable[[Path], bool], place: Path) -> bool:
    # Both raise at names that are too long.
    with suppress(OSError):
        return what(place)
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
