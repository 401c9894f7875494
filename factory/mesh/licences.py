"""Which inputs a team may use: the licence an input comes with, against those that the configuration allows."""

from __future__ import annotations

from collections.abc import Sequence
from fnmatch import fnmatchcase

from ..errors import InputRejected

#: How a configuration allows inputs that do not say under which licence they stand.
UNKNOWN = "unknown"
_LETTERS_SAID = 160


def require_allowed(what: str, licence: str | None, allowed: Sequence[str]) -> None:
    """Reject with ``licence_disallowed`` what stands under none of the allowed licences.

    Args:
        what: opens the sentence.
        licence: of the input, as its sidecar or its file says; ``None`` or blank where nobody says.
        allowed: names such as ``CC-BY-4.0``, or shell patterns such as ``CC0-*``, in any case; ``unknown`` allows
            inputs that say nothing; empty: everything is allowed.

    Raises:
        InputRejected: code ``licence_disallowed``, naming what it is and what is allowed.
    """
    if not allowed:
        return
    stated = " ".join((licence or "").split())
    wanted = (stated or UNKNOWN).casefold()
    # An input that calls its own licence "unknown" says nothing either.
    if any(fnmatchcase(wanted, pattern.casefold()) for pattern in allowed if stated or pattern.casefold() == UNKNOWN):
        return
    said = f"its licence is {stated[:_LETTERS_SAID]!r}" if stated else "nobody says under which licence it stands"
    advice = "" if stated else "; name it in its sidecar, or allow 'unknown'"
    raise InputRejected(
        "licence_disallowed", f"{what}: {said}, and the configuration allows only {', '.join(allowed)}{advice}"
    )
