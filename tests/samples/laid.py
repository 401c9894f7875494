"""A file in a folder that is made for it."""

from pathlib import Path


def laid(path: Path, content: str | bytes = "x") -> Path:
    """The path, once there is that text or are those bytes."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path
