"""One reader per mesh format, from bytes to a soup; each checks sizes before it allocates."""
