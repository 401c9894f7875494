"""Which inputs may be used: an input's license, against those that the configuration allows."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fnmatch import fnmatchcase

from ..errors import InputRejected

#: How a configuration allows inputs that do not say under which license they stand.
UNKNOWN = "unknown"
_LETTERS_SAID = 160


def is_allowed(license: str | None, allowed: Sequence[str]) -> bool:
    """Return whether an input may be used; arguments as for :func:`require_allowed`."""
    stated = _stated(license)
    if not allowed:
        return True
    if not stated or stated.casefold() == UNKNOWN:
        # An input that calls its own license "unknown" says nothing either.
        return any(_stated(name).casefold() == UNKNOWN for name in allowed)
    names = [_stated(name).casefold() for name in allowed]
    # A name may have brackets, which mean something else in a pattern; and a pattern must not match
    # a second license.
    parts = [part.strip() for part in stated.casefold().split(";") if part.strip()]
    each = all(any(fnmatchcase(p, name) or p == name for name in names) for p in parts)
    return stated.casefold() in names or (bool(parts) and each)


def combined(license: str | None, others: Iterable[str]) -> str | None:
    """Return the terms of several licenses at once, ``;`` between them.

    Without ``others`` the first one stays as it is; ``None`` is that of an input of which nobody
    says.
    """
    stated = [part.strip() for part in (license or UNKNOWN).split(";")]
    added = sorted(set(others) - set(stated))
    return "; ".join([*stated, *added]) if added else license


def _stated(license: str | None) -> str:
    return " ".join((license or "").split())


def require_allowed(
    what: str, license: str | None, allowed: Sequence[str], digest: str = ""
) -> None:
    """Reject an input under none of the allowed licenses.

    Args:
        what: opens the sentence.
        license: of the input, as its sidecar or its file says; ``None`` or blank where nobody says.
            Where several are named, with ``;`` between them, each must be allowed.
        allowed: names such as ``CC-BY-4.0``, or shell patterns such as ``CC0-*``, in any case;
            ``unknown`` allows inputs that say nothing; empty: everything is allowed.
        digest: over all files of the input.

    Raises:
        InputRejected: code ``license_disallowed``, naming its license and those allowed.
    """
    if is_allowed(license, allowed):
        return
    stated = _stated(license)
    said = f"its license is {stated[:_LETTERS_SAID]!r}"
    advice = ""
    if not stated:
        said = "nobody says under which license it stands"
        advice = "; name it in its sidecar, or allow 'unknown'"
    message = f"{what}: {said}, and the configuration allows only {', '.join(allowed)}{advice}"
    raise InputRejected("license_disallowed", message, digest=digest)
