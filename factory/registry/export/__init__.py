"""Part of a registry as a folder or an archive to hand on: the same bytes for the same assets."""

from .contents import contents
from .writing import Written, write_export

__all__ = ["Written", "contents", "write_export"]
