"""XML from strangers: parsed without entities, and never a file outside its folder."""

from __future__ import annotations

import errno
import os
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path, PurePosixPath

from defusedxml.common import DTDForbidden
from defusedxml.ElementTree import XMLParser, fromstring

from ..description import DescriptionError
from .regular import read_regular

MAX_DOCUMENT_BYTES = 64 * 2**20
#: Elements and attributes of one document: each takes a hundred times the memory that it takes in
#: the file.
MAX_ITEMS = 1_000_000
#: Folders of a package's path that are tried.
MAX_DEPTH = 32
#: Schemes of references that begin with a package's name.
PACKAGED = ("package", "model")
#: What helps where a file may not be read.
REMEDY = "--root DIR lets another folder be read, --allow-outside any"


def parse_document(path: Path, most: int = MAX_DOCUMENT_BYTES) -> ET.Element:
    """Return the root element of an XML file that declares no document type and so no entities.

    Args:
        path: of the file.
        most: largest file that is read [bytes].

    Raises:
        DescriptionError: ``missing_file``, ``unreadable``, ``too_large``, ``invalid_xml`` or
            ``forbidden_doctype``.
    """
    return parse_xml(read_document(path, most), path.name)


def read_document(path: Path, most: int = MAX_DOCUMENT_BYTES) -> bytes:
    """Return the text of an XML file, unparsed; arguments and errors as above."""
    most = min(most, MAX_DOCUMENT_BYTES)
    try:
        return read_regular(path, most)
    except FileNotFoundError as error:
        raise DescriptionError("missing_file", f"{path.name}: is not there", (path,)) from error
    except OSError as error:
        if error.errno == errno.EFBIG:
            message = f"{path.name}: {path.stat().st_size} bytes of XML, at most {most} are read"
            raise DescriptionError("too_large", message) from error
        message = f"{path.name}: cannot be read: {error.strerror}"
        raise DescriptionError("unreadable", message) from error


def parse_xml(data: bytes, name: str) -> ET.Element:
    """Return the root element of an XML text; ``name`` opens the sentence of a refusal."""
    items = data.count(b"<") + data.count(b"=")
    if items > MAX_ITEMS:
        message = f"{name}: {items} elements and attributes, at most {MAX_ITEMS} are read"
        raise DescriptionError("too_large", message)
    with _refusing(name):
        root: ET.Element = fromstring(data, forbid_dtd=True)
        return root


def refuse_doctype(data: bytes, name: str) -> None:
    """Refuse XML that declares a document type, in any encoding: entities expand without bound.

    Raises:
        DescriptionError: ``forbidden_doctype``, or ``invalid_xml``.
    """
    with _refusing(name):
        # It has no method for any event, and so nothing is built.
        guard = XMLParser(target=object(), forbid_dtd=True)
        guard.feed(data)
        guard.close()


@contextmanager
def _refusing(name: str) -> Iterator[None]:
    try:
        yield
    except DTDForbidden as error:
        remedy = "remove the <!DOCTYPE ...> to have it read"
        message = f"{name}: declares a document type or entities; {remedy}"
        raise DescriptionError("forbidden_doctype", message) from error
    except (ET.ParseError, ValueError, LookupError) as error:
        raise DescriptionError("invalid_xml", f"{name}: is no XML: {error}") from error


def find_file(reference: str, folder: Path) -> Path:
    """Return the file that a description in ``folder`` means by ``reference``.

    ``package://name/rest`` has no package path here: ``name/rest`` and then ever shorter tails of
    it are looked for in the folder.

    Raises:
        DescriptionError: ``outside_folder`` or ``missing_file``.
    """
    places = locate(reference, folder.resolve())
    for place in places:
        if os.path.isfile(place):
            return place.resolve()
    message = f"{reference[:160]!r}: no such file in the description's folder"
    raise DescriptionError("missing_file", message, places)


def locate(reference: str, folder: Path) -> list[Path]:
    """Return where in ``folder``, a resolved path, the file of a reference may lie.

    Raises:
        DescriptionError: ``outside_folder``.
    """
    refuse_address(reference)
    scheme, _, rest = reference.rpartition("://")
    if scheme.lower() in PACKAGED:
        parts = PurePosixPath(rest).parts
        starts = range(max(0, len(parts) - MAX_DEPTH), len(parts))
        places = [folder.joinpath(*parts[start:]) for start in starts]
    else:
        places = [folder / rest.replace("\\", "/")]
    within = [place for place in places if inside(place, folder)]
    if not within:
        raise outside_error(reference, places)
    return within


def refuse_address(reference: str) -> None:
    """Refuse a reference that names no file. Raises DescriptionError ``outside_folder``."""
    scheme = reference.rpartition("://")[0].lower()
    if scheme not in ("", "file", *PACKAGED):
        message = f"{reference[:160]!r} is an address; only files on this machine are read"
        raise DescriptionError("outside_folder", message)


def outside_error(reference: str, places: Sequence[Path]) -> DescriptionError:
    """Return the refusal of a reference that leads to where nothing may be read."""
    message = f"{reference[:160]!r} leads out of the folders that may be read; {REMEDY}"
    return DescriptionError("outside_folder", message, places)


def inside(path: Path, folder: Path) -> bool:
    """Return whether a path, every link in it followed, lies in ``folder``, a resolved path."""
    # Path.resolve raises at links in a circle; a name that no file can have leads nowhere.
    with suppress(OSError, ValueError):
        return Path(os.path.realpath(path)).is_relative_to(folder)
    return False
