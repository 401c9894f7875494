"""Reading untrusted XML: no entities, no surprises, no file outside the description's folder."""

from __future__ import annotations

import os
from pathlib import Path
from urllib.parse import unquote
from xml.etree.ElementTree import Element

from asset_factory.sim_checks.description import DescriptionError
from asset_factory.sim_checks.read.document import locate, parse_xml, read_document

from ...runtime.store import digest_bytes
from ..reads import ABSENT, ReadLog
from ..rejecting import rejecting


def read_xml(path: Path, max_bytes: int, log: ReadLog) -> Element:
    """Return the root element of an XML file, noted as read.

    Raises:
        InputRejected: ``missing_file``; ``too_large``: more than ``max_bytes``, or too many
            elements; ``unreadable``: not well-formed, or it declares a document type or entities,
            which can expand without bound.
    """
    with rejecting(path.name, path.parent, log):
        text = read_document(path, max_bytes)
        log.note(path, digest_bytes(text))
        return parse_xml(text, path.name)


def find_reference(reference: str, folder: Path, where: str, log: ReadLog) -> Path:
    """Return the file that ``reference`` names below ``folder``, as :func:`locate` understands it.

    Raises:
        InputRejected: ``external_reference`` or ``missing_file``; ``where`` opens the sentence.
    """
    with rejecting(where, folder, log):
        for place in locate(unquote(reference.strip()).replace("\\", "/"), folder.resolve()):
            if os.path.isfile(place):
                return place.resolve()
            log.note(place, ABSENT)
        why = f"{reference[:160]!r} is not there; want it below the description's folder"
        raise DescriptionError("missing_file", f"{where}: {why}")
