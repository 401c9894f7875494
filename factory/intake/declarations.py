"""Untrusted XML: no document type, no entities, which expand without bound or name files."""

from __future__ import annotations

from xml.parsers import expat

from ..errors import InputRejected


def refuse_declarations(text: bytes, name: str) -> None:
    """Reject XML that declares a document type or entities, in whatever encoding it is written.

    Raises:
        InputRejected: ``unreadable``; also for what is not well-formed.
    """

    def refuse(*_: object) -> None:
        raise InputRejected(
            "unreadable",
            f"{name}: declares a document type or entities; "
            "remove the <!DOCTYPE ...> to have it read",
        )

    parser = expat.ParserCreate()
    parser.StartDoctypeDeclHandler = refuse
    parser.EntityDeclHandler = refuse
    try:
        parser.Parse(text, True)
    except (expat.ExpatError, ValueError, LookupError) as error:
        raise InputRejected("unreadable", f"{name}: is not well-formed XML: {error}") from error
