"""Files in, :class:`Description` out: as written, not as some simulator took it."""

from .read import read_description

__all__ = ["read_description"]
