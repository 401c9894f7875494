"""Files in, :class:`Description` out: as written, not as some simulator took it."""
