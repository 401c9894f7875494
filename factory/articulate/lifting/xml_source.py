"""Reading somebody else's XML: no entities, no surprises, and no file outside the description's folder."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path
from urllib.parse import unquote
from xml.parsers import expat

import numpy as np

from ...errors import InputRejected
from ...mesh.mesh import FloatArray

SCHEMES = ("package://", "model://", "file://")


def read_xml(path: Path, max_bytes: int) -> ET.Element:
    """The root element of an XML file.

    Raises:
        InputRejected: ``missing_file``; ``too_large``: more than ``max_bytes``; ``unreadable``: not
            well-formed, or it declares a document type or entities, which can expand without bound.
    """
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
        text = path.read_bytes()
    except FileNotFoundError as error:
        raise InputRejected("missing_file", f"{path.name}: is not there") from error
    except OSError as error:
        raise InputRejected("unreadable", f"{path.name}: cannot be read: {error.strerror}") from error
    _refuse_declarations(text, path.name)
    try:
        return ET.fromstring(text)
    except ET.ParseError as error:
        raise InputRejected("unreadable", f"{path.name}: is not well-formed XML: {error}") from error


def _refuse_declarations(text: bytes, name: str) -> None:
    def refuse(*_: object) -> None:
        raise InputRejected(
            "unreadable", f"{name}: declares a document type or entities; remove the <!DOCTYPE ...> to have it read"
        )

    parser = expat.ParserCreate()
    parser.StartDoctypeDeclHandler = refuse
    parser.EntityDeclHandler = refuse
    try:
        parser.Parse(text, True)
    except (expat.ExpatError, ValueError, LookupError) as error:
        raise InputRejected("unreadable", f"{name}: is not well-formed XML: {error}") from error


def numbers(text: str | None, count: int, default: tuple[float, ...], where: str) -> FloatArray:
    """``count`` finite numbers of an attribute, or ``default`` when it is absent, shape [count].

    Raises:
        InputRejected: ``unreadable``: not that many finite numbers; ``where`` opens the sentence.
    """
    if text is None or not text.strip():
        return np.asarray(default, dtype=np.float64)
    try:
        values = np.array([float(word) for word in text.split()])
    except ValueError:
        values = np.zeros(0)
    if values.shape != (count,) or not np.isfinite(values).all():
        raise InputRejected("unreadable", f"{where}: is {text!r}, want {count} finite numbers")
    return values


def find_reference(reference: str, folder: Path, where: str, base: Path | None = None) -> Path:
    """The file that ``reference`` means, which lies below ``folder``; relative ones start at ``base``, if given.

    ``package://name/a/b.obj`` and ``model://name/a/b.obj`` mean the longest of ``name/a/b.obj``,
    ``a/b.obj``, ``b.obj`` that exists below ``folder``; there are no packages to ask.

    Raises:
        InputRejected: ``external_reference`` or ``missing_file``; ``where`` opens the sentence.
    """
    text = unquote(reference.strip()).replace("\\", "/")
    scheme = next((s for s in SCHEMES if text.lower().startswith(s)), "")
    if not scheme and "://" in text:
        raise InputRejected("external_reference", f"{where}: {reference!r} is an address; want a file beside it")
    tail = text[len(scheme) :]
    root = folder.resolve()
    if scheme in ("package://", "model://"):
        words = [word for word in tail.split("/") if word not in ("", ".")]
        candidates = [root.joinpath(*words[start:]) for start in range(len(words))]
    else:
        candidates = [(base or root) / tail]
    inside = [c.resolve() for c in candidates if c.resolve().is_relative_to(root)]
    if not inside:
        raise InputRejected(
            "external_reference",
            f"{where}: {reference!r} leads out of the description's folder; want its files in or below that folder",
        )
    for candidate in inside:
        if candidate.is_file():
            return candidate
    raise InputRejected("missing_file", f"{where}: {reference!r} is not there; want it below the description's folder")
