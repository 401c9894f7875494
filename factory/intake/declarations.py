"""XML from anybody: no document type, since its entities expand without bound or name files."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from xml.etree.ElementTree import Element, ParseError

from defusedxml.common import DefusedXmlException
from defusedxml.ElementTree import XMLParser, fromstring

from ..errors import InputRejected


class _Unbuilt:
    """What a parser builds that is only to look."""

    def close(self) -> None:
        """The end of the document."""


def parse_xml(text: bytes, name: str) -> Element:
    """Return the root element of an XML file, in whatever encoding it is written.

    Raises:
        InputRejected: ``unreadable``: it declares a document type, or is not well-formed; ``name``
            opens the sentence.
    """
    with _rejecting(name):
        root: Element = fromstring(text, forbid_dtd=True)
        return root


def refuse_declarations(text: bytes, name: str) -> None:
    """Reject what :func:`parse_xml` would, for a library that parses it itself."""
    with _rejecting(name):
        parser = XMLParser(target=_Unbuilt(), forbid_dtd=True)
        parser.feed(text)
        parser.close()


@contextmanager
def _rejecting(name: str) -> Iterator[None]:
    try:
        yield
    except DefusedXmlException as error:
        raise InputRejected(
            "unreadable",
            f"{name}: declares a document type or entities; "
            "remove the <!DOCTYPE ...> to have it read",
        ) from error
    except (ParseError, ValueError, LookupError) as error:
        raise InputRejected("unreadable", f"{name}: is not well-formed XML: {error}") from error
