"""Whether an asset's files are still those that were validated."""

from __future__ import annotations

from asset_factory.factory.errors import RegistryError
from asset_factory.factory.registry.report_file import file_digests, read_report
from asset_factory.factory.runtime.layout import MANIFEST
from asset_factory.factory.runtime.store import digest_bytes

from .assets import RegisteredAsset, listed


def check_unaltered(asset: RegisteredAsset) -> None:
    """Raise RegistryError if the asset was deleted or altered since it was registered.

    The report's ``files``, where it has them, are the digests at registration; else the manifest
    must be what it was when the registry was read.
    """
    name = f"asset {asset.id!r}"
    try:
        manifest = digest_bytes((asset.folder / MANIFEST).read_bytes())
        asset.urdf.stat()
    except OSError as error:
        there = sorted(path.parent.name for path in asset.folder.parent.glob(f"*/{MANIFEST}"))
        gone = f"{error.filename} is gone since the registry was read"
        raise RegistryError(f"{name}: {gone}; there are {listed(there)}") from error
    if manifest != asset.digest:
        changed = f"{MANIFEST} changed since the registry was read"
        raise RegistryError(f"{name}: {changed}; make the task again")
    try:
        registered = read_report(asset.folder).files
    except (RegistryError, ValueError):
        return
    found = file_digests(asset.folder)
    files = registered.keys() | found.keys()
    wrong = sorted(file for file in files if registered.get(file) != found.get(file))
    if wrong:
        words = f"{listed(wrong)} not as registered (SHA-256)"
        raise RegistryError(f"{name}: {words}; build it again")
