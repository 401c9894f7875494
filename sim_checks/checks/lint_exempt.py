"""Pairs of links that an SRDF lets pass through each other: nobody reports what they do."""

from __future__ import annotations

from collections.abc import Iterator

from ..description import Description
from ..report import Finding
from .result import warning

#: Pairs that a sentence names.
MOST_NAMED = 5


def exempt_findings(description: Description) -> Iterator[Finding]:
    """Yield how many pairs of a URDF are exempt, and which; MJCF tells each where it overlaps."""
    if description.format != "urdf" or not description.excluded:
        return
    pairs = sorted(" and ".join(sorted(pair)) for pair in description.excluded)
    more = f" and {len(pairs) - MOST_NAMED} more" if len(pairs) > MOST_NAMED else ""
    message = (
        f"its SRDF exempts {len(pairs)} pairs of links from collision: "
        f"{', '.join(pairs[:MOST_NAMED])}{more}"
    )
    yield warning("pairs_exempt", message, value=float(len(pairs)), unit="pairs")
