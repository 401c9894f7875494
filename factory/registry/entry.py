"""One row of the registry: what became of one input."""

from __future__ import annotations

import re
from dataclasses import asdict, dataclass, field
from typing import Annotated, Any, Literal

import msgspec

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
Solved = Literal["", "yes", "no"]
SOLVED: tuple[Solved, ...] = ("", "yes", "no")
#: What may be the name of a folder in a registry, on every file system.
ID = r"^[A-Za-z0-9_][A-Za-z0-9._-]{0,199}\Z"
TAG = r"^[A-Za-z0-9][A-Za-z0-9._:-]{0,99}\Z"
EntryText = Annotated[str, msgspec.Meta(max_length=100_000)]
EntryCount = Annotated[int, msgspec.Meta(ge=0, le=2**53)]


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

    id: Annotated[str, msgspec.Meta(pattern=ID)]
    name: EntryText
    category: EntryText
    status: Status
    reason: EntryText
    parts: EntryCount
    joints: EntryCount
    hulls: EntryCount
    key: EntryText = ""
    message: EntryText = ""
    license: EntryText = ""
    split: Split = field(init=False, default="train")
    tags: tuple[str, ...] = ()
    solved: Solved = ""

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


def lasting_data(entry: Entry) -> dict[str, Any]:
    """Return JSON data of every field that does not change while the asset stays as it is."""
    return {name: value for name, value in asdict(entry).items() if name not in MUTABLE}


def entry_from(data: object) -> Entry:
    """Return the entry that JSON data describe.

    Raises:
        ValueError: it is not one, or its id could not be a folder's name.
    """
    try:
        return msgspec.convert(data, Entry)
    except msgspec.ValidationError as error:
        raise ValueError(f"no entry: {error}, in {str(data)[:100]!r}") from error


def is_id(text: str) -> bool:
    """Return whether a text can be an asset's id and its folder's name."""
    return re.match(ID, text) is not None


def require_tags(tags: tuple[str, ...]) -> None:
    """Raise RegistryError for a tag that cannot be one."""
    for tag in tags:
        if re.match(TAG, tag) is None:
            want = "want up to 100 letters, digits and '._:-', a letter or digit first"
            raise RegistryError(f"tag {tag[:50]!r}: {want}")
