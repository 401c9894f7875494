"""Folders and files behind a URL that fsspec understands; nothing said of one names a secret."""

from __future__ import annotations

import importlib
import os
import re
from typing import Any, Final
from urllib.parse import unquote, urlsplit

from ..errors import ConfigError

_URL = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*(::[^:]+)*://")
#: What object stores call the MD5 of a file that was sent in one piece.
_ETAG = re.compile(r'"?([0-9a-f]{32})"?')
_MOST_SAID = 300
#: How variables of the environment end that hold what nobody shall read.
_SECRET_NAMES = ("SECRET_ACCESS_KEY", "TOKEN", "PASSWORD")
#: The local file system's own scheme.
LOCAL: Final = "file"


def is_url(text: str) -> bool:
    """Return whether a text is a URL, and no path."""
    return _URL.match(text) is not None


def shown(url: str) -> str:
    """Return a URL without what may be a secret, a password, a query, a fragment; paths whole."""
    scheme, mark, rest = url.partition("://")
    place, slash, path = re.split(r"[?#]", rest, maxsplit=1)[0].partition("/")
    return f"{scheme}{mark}{place.rpartition('@')[2]}{slash}{path}"


def told(error: BaseException, url: str) -> str:
    """Return what an error says, on one line, without the secrets of the URL that it is about."""
    text = " ".join(str(error).split()) or type(error).__name__
    # Longest first: a part of a secret must not spoil the rest of it.
    for secret in sorted(_secrets(url), key=len, reverse=True):
        text = text.replace(secret, "***")
    return text[:_MOST_SAID]


def located(url: str) -> tuple[Any, str]:
    """Return the file system that a URL names, and the path there.

    Raises:
        ConfigError: fsspec, or what it needs for such URLs, is not installed; or there is no such
            protocol.
    """
    try:
        fsspec: Any = importlib.import_module("fsspec")
        system, path = fsspec.core.url_to_fs(url)
    except ImportError as error:
        needed = error.name or told(error, url)
        hint = "pip install 'asset-factory[s3]'" if url.startswith("s3:") else f"install {needed}"
        raise ConfigError(f"{shown(url)}: needs {needed}, which is not installed; {hint}") from None
    except ValueError as error:
        raise ConfigError(f"{shown(url)}: {told(error, url)}") from None
    return system, path


def stored_md5(details: dict[str, Any]) -> str:
    """Return the MD5 that a store keeps of a file, as its listing says; empty where it has none."""
    found = _ETAG.fullmatch(str(details.get("ETag", "")))
    return found[1] if found else ""


def version(details: dict[str, Any]) -> str:
    """Return what changes with a remote file, as its listing says; empty where it says nothing."""
    names = ("ETag", "etag", "md5Hash", "LastModified", "last_modified", "mtime", "created")
    return next((f"{name} {details[name]}" for name in names if details.get(name)), "")


def _secrets(url: str) -> set[str]:
    parts = urlsplit(url)
    user = parts.netloc.rpartition("@")[0]
    values = {user, *user.split(":", 1)[1:], parts.query}
    values |= {pair.partition("=")[2] for pair in parts.query.split("&")}
    values |= {value for name, value in os.environ.items() if name.endswith(_SECRET_NAMES)}
    return {each for value in values for each in (value, unquote(value)) if len(each) > 2}
