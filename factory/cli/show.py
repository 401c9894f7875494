"""``factory show``: one asset, and what was said of it."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass

from ..errors import Exit
from ..registry import Registry
from ..runtime.layout import MANIFEST
from ..runtime.terminal import say
from .flags import AssetId, OfRegistry, Printed


@dataclass(frozen=True)
class Show(Printed, OfRegistry):
    """Show one asset: its files, its joints, what the validator said, and how to load it.

    Example: factory show fridge-264720b5fe --output out/
    """

    id: AssetId
    """As `factory list` prints it, or its beginning."""


def run(command: Show) -> int:
    """Print one row and its report; returns the exit code."""
    from . import showing

    registry = Registry(command.output)
    entry = registry.named(command.id)
    told = registry.told(entry)
    if command.json:
        folder = registry.folder(entry)
        manifest = folder / MANIFEST
        data = {
            **asdict(entry),
            "folder": str(folder),
            "manifest": json.loads(manifest.read_text()) if manifest.is_file() else None,
            "report": told.report.to_dict(),
            "changes": [repair.to_dict() for repair in told.repairs],
        }
        say(json.dumps(data, indent=2))
    else:
        showing.print_entry(entry, registry.root, told, registry.manifest(entry))
    return Exit.OK
