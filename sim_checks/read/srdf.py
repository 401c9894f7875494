"""SRDF: which pairs of a URDF's links may pass through each other.

The format: http://wiki.ros.org/srdf.
"""

from __future__ import annotations

from pathlib import Path

from .document import parse_document

SUFFIX = ".srdf"
Pairs = frozenset[frozenset[str]]


def exempt_pairs(urdf: Path) -> Pairs:
    """Return the pairs of names that the SRDF beside a URDF, called like it, disables.

    Raises:
        DescriptionError: it is no XML.
    """
    path = urdf.with_suffix(SUFFIX)
    if not path.is_file():
        return frozenset()
    items = parse_document(path).iter("disable_collisions")
    pairs = (frozenset((item.get("link1", ""), item.get("link2", ""))) for item in items)
    return frozenset(pair for pair in pairs if len(pair) == 2 and "" not in pair)
