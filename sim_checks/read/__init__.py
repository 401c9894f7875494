"""Files in, :class:`Description` out: what is written, not what some simulator made of it."""

from .read import read_description

__all__ = ["read_description"]
