"""Names of files that come from elsewhere."""

MAX_NAME = 255
MAX_PATH = 1024


def is_safe_path(name: str) -> bool:
    """Return whether a path stays in the folder that it is put into, on every system.

    Relative, with ``/`` between its parts, none of them empty, ``.`` or ``..``; no backslash, colon
    or control character.
    """
    if not 0 < len(name.encode("utf-8", "replace")) <= MAX_PATH or "\\" in name or ":" in name:
        return False
    if not name.isprintable():
        return False
    return all(
        part not in ("", ".", "..") and len(part.encode()) <= MAX_NAME for part in name.split("/")
    )
