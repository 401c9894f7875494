"""What the judge does not see, and what one engine sees that is not there: each with the reason."""

from collections.abc import Iterator
from dataclasses import dataclass

from .exhibits import Builder, urdf
from .good_things import laptop


@dataclass(frozen=True)
class BlindSpot:
    """A file on which the judge errs.

    Attributes:
        name: unique in the corpus.
        build: writes it into an empty folder and returns the description's path.
        fault: what is wrong with it, as a code; ``None`` for a sound one that is rejected.
        reason: why it is missed, in a sentence.
    """

    name: str
    build: Builder
    fault: str | None
    reason: str


def blind_spots() -> Iterator[BlindSpot]:
    """Every one known."""
    reason = "PyBullet keeps 1 mm around every hull: what is less than 2 mm apart jams there"
    yield BlindSpot("tight_laptop.urdf", urdf(laptop(0.0018)), None, reason)
