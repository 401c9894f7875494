"""Whether an asset's files are still those that were validated."""

from pathlib import Path

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
    try:
        manifest = digest_bytes((asset.folder / MANIFEST).read_bytes())
        asset.urdf.stat()
    except OSError as error:
        there = sorted(path.parent.name for path in asset.folder.parent.glob(f"*/{MANIFEST}"))
        raise RegistryError(
            f"asset {asset.id!r}: {error.filename} is gone since the registry was read; "
            f"there are {listed(there)}"
        ) from error
    if manifest != asset.digest:
        raise RegistryError(
            f"asset {asset.id!r}: {MANIFEST} changed since the registry was "
            "read; make the task again"
        )
    registered = _registered_digests(asset.folder)
    if registered is not None:
        found = file_digests(asset.folder)
        wrong = sorted(
            name
            for name in registered.keys() | found.keys()
            if registered.get(name) != found.get(name)
        )
        if wrong:
            raise RegistryError(
                f"asset {asset.id!r}: {listed(wrong)} not as registered (SHA-256); build it again"
            )


def _registered_digests(folder: Path) -> dict[str, str] | None:
    try:
        return read_report(folder).files
    except (RegistryError, ValueError):
        return None
