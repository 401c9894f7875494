"""One row of the registry: what became of one input."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from typing import Any, Literal

from asset_factory.sim_checks import Status

from ..errors import RegistryError
from ..runtime.layout import ASSETS, REJECTED
from ..runtime.store import digest_bytes

Split = Literal["train", "test"]
SPLITS: tuple[Split, ...] = ("train", "test")
#: Share of all assets that are kept for testing.
TEST_SHARE = 0.2


def split_of(asset_id: str) -> Split:
    """Return an asset's split, from its id alone, so that a growing registry moves nothing."""
    return "test" if int(digest_bytes(asset_id.encode())[:8], 16) < TEST_SHARE * 2**32 else "train"


#: Unknown, opened, not opened.
SOLVED = ("", "yes", "no")
#: What may be the name of a folder in a registry, on every file system.
_ID = re.compile(r"[A-Za-z0-9_][A-Za-z0-9._-]{0,199}")
_TAG = re.compile(r"[A-Za-z0-9][A-Za-z0-9._:-]{0,99}")
_MAX_TEXT = 100_000
_MAX_COUNT = 2**53


@dataclass(frozen=True)
class Entry:
    """One row: what became of one input.

    Attributes:
        id: name and the first digits of the input's digest.
        name: the input's name.
        category: of the object; empty if unknown.
        status: what became of it.
        reason: code of the first error; empty if it passed.
        parts, joints, hulls: how many parts, movable joints and convex pieces.
        key: what it was made from, hexadecimal: inputs, settings, versions of stages and libraries;
            empty if unknown.
        message: the first error's sentence; empty if it passed.
        license: of the input; empty if unknown.
        split: ``train`` or ``test``; follows from the id.
        tags: what people call it, sorted.
        solved: ``yes`` or ``no``: whether a robot opened one of its joints; empty if nobody tried.
    """

    id: str
    name: str
    category: str
    status: Status
    reason: str
    parts: int
    joints: int
    hulls: int
    key: str = ""
    message: str = ""
    license: str = ""
    split: Split = field(init=False)
    tags: tuple[str, ...] = ()
    solved: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "status", Status(self.status))
        object.__setattr__(self, "split", split_of(self.id))
        object.__setattr__(self, "tags", tuple(sorted(set(self.tags))))

    @property
    def folder(self) -> str:
        """Return where its files are, relative to the registry's folder."""
        return f"{ASSETS if self.status is Status.PASSED else REJECTED}/{self.id}"


#: What an asset's own folder says of it; the rest is noted beside it.
MUTABLE = ("tags", "solved")
_LASTING = [each for each in fields(Entry) if each.name not in MUTABLE]
_TEXTS = tuple(each.name for each in _LASTING if each.type in ("str", "Status"))
_COUNTS = tuple(f.name for f in fields(Entry) if f.type == "int")


def lasting_data(entry: Entry) -> dict[str, Any]:
    """Return JSON data of every field that does not change while the asset stays as it is."""
    return {name: value for name, value in asdict(entry).items() if name not in MUTABLE}


def entry_from(data: object, *, tags: tuple[str, ...] = (), solved: str = "") -> Entry:
    """Return the entry that :func:`lasting_data` described; fields that are missing are empty.

    Raises:
        ValueError: it is not one, or its id could not be a folder's name.
    """
    if not isinstance(data, Mapping):
        raise ValueError(f"an entry must be an object, not {type(data).__name__}")
    texts = {name: data.get(name, "") for name in _TEXTS}
    counts = {name: data.get(name, 0) for name in _COUNTS}
    for name, value in texts.items():
        if not isinstance(value, str) or len(value) > _MAX_TEXT:
            raise ValueError(f"an entry's {name} must be a text, not {str(value)[:50]!r}")
    for name, value in counts.items():
        if type(value) is not int or not 0 <= value <= _MAX_COUNT:
            raise ValueError(f"an entry's {name} must be a count, not {str(value)[:50]!r}")
    if not is_id(texts["id"]):
        want = "letters, digits, '_', '-' and '.'"
        raise ValueError(f"an entry's id must be of {want}, not {texts['id'][:50]!r}")
    if texts["status"] not in set(Status):
        want = ", ".join(Status)
        raise ValueError(f"an entry's status must be one of {want}, not {texts['status'][:50]!r}")
    return Entry(**texts, **counts, tags=tags, solved=solved)


def is_id(text: str) -> bool:
    """Return whether a text can be an asset's id and its folder's name."""
    return _ID.fullmatch(text) is not None


def require_tags(tags: tuple[str, ...]) -> None:
    """Raise RegistryError for a tag that cannot be one."""
    for tag in tags:
        if _TAG.fullmatch(tag) is None:
            want = "want up to 100 letters, digits and '._:-', a letter or digit first"
            raise RegistryError(f"tag {tag[:50]!r}: {want}")
