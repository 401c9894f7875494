"""Reading untrusted XML: no entities, no surprises, no file outside the description's folder."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from urllib.parse import unquote
from xml.etree.ElementTree import Element

import numpy as np

from asset_factory.sim_checks.read.regular import read_regular

from ...errors import InputRejected
from ...mesh import FloatArray
from ...runtime.store import digest_bytes
from ..declarations import parse_xml
from ..limits import require_at_most
from ..reads import ABSENT, note_link_out, note_read

SCHEMES = ("package://", "model://", "file://")
MAX_BYTES = 64 * 1024 * 1024
#: Elements and attributes of one file: each takes a hundred times the memory that it takes in the
#: file.
MAX_ITEMS = 1_000_000
#: No position [m], angle [rad] or ratio of a household thing is larger; whatever is, is a slip or
#: an attack.
ABSURD = 1e6
#: Folders of a package's path that are tried.
MAX_DEPTH = 32


def read_xml(path: Path, max_bytes: int) -> Element:
    """Return the root element of an XML file.

    Raises:
        InputRejected: ``missing_file``; ``too_large``: more than ``max_bytes`` or
            :data:`MAX_BYTES`, or too many elements; ``unreadable``: not well-formed, or it declares
            a document type or entities, which can expand without bound.
    """
    max_bytes = min(max_bytes, MAX_BYTES)
    try:
        size = path.stat().st_size
        if size > max_bytes:
            raise InputRejected(
                "too_large",
                f"{path.name}: has {size} bytes, want at most {max_bytes}",
                value=size,
                unit="bytes",
                limit=max_bytes,
            )
        text = read_regular(path, max_bytes)
        note_read(path, digest_bytes(text))
    except FileNotFoundError as error:
        raise InputRejected("missing_file", f"{path.name}: is not there") from error
    except OSError as error:
        raise InputRejected(
            "unreadable", f"{path.name}: cannot be read: {error.strerror}"
        ) from error
    require_at_most(
        path.name, text.count(b"<") + text.count(b"="), MAX_ITEMS, "elements and attributes"
    )
    return parse_xml(text, path.name)


def numbers(text: str | None, count: int, default: tuple[float, ...], where: str) -> FloatArray:
    """``count`` numbers of an attribute, or ``default`` when it is absent, shape [count].

    Commas between them are read as spaces, as other readers do.

    Raises:
        InputRejected: ``unreadable``: not that many numbers, or one beyond ABSURD; ``where`` opens
            the sentence.
    """
    if text is None or not text.strip():
        return np.asarray(default, dtype=np.float64)
    try:
        values = np.array([float(word) for word in text.replace(",", " ").split()])
    except ValueError:
        values = np.zeros(0)
    # NaN compares as false.
    if values.shape != (count,) or not (np.abs(values) <= ABSURD).all():
        said = repr(text[:80])
        raise InputRejected(
            "unreadable", f"{where}: is {said}, want {count} finite numbers up to {ABSURD:g}"
        )
    return values


def find_reference(reference: str, folder: Path, where: str, base: Path | None = None) -> Path:
    """The file that ``reference`` names below ``folder``; relative ones start at ``base``, if any.

    ``package://name/a/b.obj`` and ``model://name/a/b.obj`` mean the longest of ``name/a/b.obj``,
    ``a/b.obj``, ``b.obj`` that exists below ``folder``; there are no packages to ask.

    Raises:
        InputRejected: ``external_reference`` or ``missing_file``; ``where`` opens the sentence.
    """
    text = unquote(reference.strip()).replace("\\", "/")
    scheme = next((s for s in SCHEMES if text.lower().startswith(s)), "")
    if not scheme and "://" in text:
        raise InputRejected(
            "external_reference",
            f"{where}: {reference[:160]!r} is an address; want a file beside it",
        )
    tail = text[len(scheme) :]
    root = folder.resolve()
    said = repr(reference[:160])
    if scheme in ("package://", "model://"):
        words = [word for word in tail.split("/") if word not in ("", ".")]
        candidates = [
            root.joinpath(*words[start:])
            for start in range(max(0, len(words) - MAX_DEPTH), len(words))
        ]
    else:
        candidates = [(base or root) / tail]
    places = [_followed(candidate) for candidate in candidates]
    inside = [place for place in places if place is not None and place.is_relative_to(root)]
    if not inside:
        for candidate in candidates:
            note_link_out(candidate, base or root)
        raise InputRejected(
            "external_reference",
            f"{where}: {said} leads out of the description's folder; "
            "want its files in or below that folder",
        )
    for candidate in inside:
        if _is_file(candidate):
            return candidate
        note_read(candidate, ABSENT)
    raise InputRejected(
        "missing_file", f"{where}: {said} is not there; want it below the description's folder"
    )


def _followed(path: Path) -> Path | None:
    """Return where a path leads; ``None`` for a name that no file can have."""
    # Path.resolve raises at links in a circle.
    with suppress(OSError, ValueError):
        return Path(os.path.realpath(path))
    return None


def _is_file(path: Path) -> bool:
    # Path.is_file raises at names that are too long.
    with suppress(OSError):
        return path.is_file()
    return False
