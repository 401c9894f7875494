"""One reader per file format: bytes in, :class:`~..soup.Soup` out; each checks sizes before it allocates."""
