"""``factory list`` and ``factory show``: what a registry holds."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path

from tyro.conf import Positional

from .. import console
from ..registry import Registry
from . import exits


@dataclass(frozen=True)
class List:
    """List what a registry holds."""

    output: Path
    """The registry's folder."""
    json: bool = False
    """Print JSON."""


@dataclass(frozen=True)
class Show:
    """Show one asset: its files, its joints, and what the judge said."""

    id: Positional[str]
    """As `factory list` prints it."""
    output: Path
    """The registry's folder."""
    json: bool = False
    """Print JSON."""


def run_list(command: List) -> int:
    """Print the rows; returns the exit code."""
    entries = Registry(command.output).entries()
    if command.json:
        print(json.dumps([asdict(entry) for entry in entries], indent=2))
    else:
        console.print_entries(entries)
    return exits.OK


def run_show(command: Show) -> int:
    """Print one row and its report; returns the exit code."""
    registry = Registry(command.output)
    entry = registry.entry(command.id)
    if command.json:
        folder = registry.folder(entry)
        manifest = folder / "asset.json"
        data = {
            **asdict(entry),
            "folder": str(folder),
            "manifest": json.loads(manifest.read_text()) if manifest.is_file() else None,
            "report": registry.report(entry).to_dict(),
        }
        print(json.dumps(data, indent=2))
    else:
        console.print_entry(entry, registry.folder(entry), registry.report(entry))
    return exits.OK
