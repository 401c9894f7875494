"""What became of a dataset's objects; refusals are kept, so that nobody asks again."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import msgspec

from asset_factory.factory.runtime.store import write_json


@dataclass(frozen=True)
class ItemRefusal:
    """Why an object is passed over: a stable code, and one sentence."""

    reason: str
    message: str


def read_refusal(path: Path) -> ItemRefusal | None:
    """Return the refusal kept in a file; ``None`` if there is none, or it is damaged."""
    try:
        return msgspec.json.decode(path.read_bytes(), type=ItemRefusal)
    except (OSError, msgspec.DecodeError):
        return None


@dataclass(frozen=True)
class SourceReport:
    """One pass over a dataset.

    Attributes:
        kind: of dataset.
        read: by name of the objects that are sampled objects now, their files in the cache.
        skipped: why the others are not, by reason code: names, each with a sentence.
        made: how many of ``read`` were not in the cache before.
    """

    kind: str
    read: dict[str, Path]
    skipped: dict[str, dict[str, str]]
    made: int

    @property
    def counts(self) -> dict[str, int]:
        """Return skipped objects by reason, most frequent first."""
        counted = Counter({reason: len(names) for reason, names in self.skipped.items()})
        return dict(counted.most_common())

    def lines(self) -> list[str]:
        """Return lines for people: the objects read, and each reason with its first object."""
        total = len(self.read) + sum(self.counts.values())
        said = [f"{self.kind}: {len(self.read)} of {total} objects read, {self.made} of them new"]
        for reason, count in self.counts.items():
            name, message = next(iter(self.skipped[reason].items()))
            said.append(f"  {count} skipped: {reason}; first {name}: {message}")
        return said

    def write(self, path: Path) -> None:
        """Write JSON, complete or not there."""
        skipped = {
            reason: dict(sorted(names.items())) for reason, names in sorted(self.skipped.items())
        }
        write_json(path, {"kind": self.kind, "read": list(self.read), "skipped": skipped})
