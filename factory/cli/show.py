"""``factory show``: one asset, and what was said of it."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from rich.markup import escape
from rich.table import Table

from asset_factory.sim_checks import Status

from ..errors import Exit
from ..registry import Entry, Registry
from ..registry.logged import logged_build
from ..registry.registry import read_manifest
from ..registry.report_file import BuildReport
from ..runtime.layout import MANIFEST
from ..runtime.terminal import say
from . import console
from .flags import AssetId, OfRegistry, Printed

if TYPE_CHECKING:
    from ..export.manifest import Manifest, ManifestJoint


@dataclass(frozen=True)
class Show(Printed, OfRegistry):
    """Show one asset: its files, its joints, what the validator said, and how to load it.

    Example: factory show fridge-264720b5fe --output out/
    """

    id: AssetId
    """As `factory list` prints it, or its beginning."""


def run(command: Show) -> int:
    """Print one row and its report; returns the exit code."""
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
        print_entry(registry, entry, told)
    return Exit.OK


def print_entry(registry: Registry, entry: Entry, told: BuildReport) -> None:
    """Print one asset: what it is, its joints and files, its findings, and how to load it."""
    folder = registry.folder(entry)
    manifest = read_manifest(folder)
    terminal = console.terminal()
    size = f", {manifest.size} m, {manifest.mass:.3g} kg" if manifest else ""
    counts = f"{entry.parts} parts, {entry.joints} movable joints, {entry.hulls} hulls"
    terminal.print(f"{entry.id}: {counts}{size}", markup=False, soft_wrap=True)
    terminal.print(f"{folder}: {', '.join(_files(folder))}", markup=False, soft_wrap=True)
    logged = logged_build(registry.root, entry.id)
    if logged is not None and logged.stages:
        stages = ", ".join(f"{name} {seconds:.2g}" for name, seconds in logged.stages.items())
        terminal.print(f"seconds of its last build: {stages}", markup=False, soft_wrap=True)
    if manifest is not None and manifest.movable:
        terminal.print(_joints(manifest))
    console.print_report(told.report)
    for repair in told.repairs:
        terminal.print(f"  [green]repair[/] {escape(repair.sentence)}", soft_wrap=True)
    for part, proposal in manifest.proposed.items() if manifest else ():
        terminal.print(f"  [blue]part[/] {escape(f'{part}: {proposal.told}')}", soft_wrap=True)
    if manifest is not None and entry.status is Status.PASSED:
        from ..report.loading import loading_snippets

        for snippet in loading_snippets(registry.root, entry.id, manifest):
            terminal.print(f"\nin {snippet.program}:", highlight=False)
            terminal.print(snippet.code, markup=False, soft_wrap=True, highlight=False)


def _joints(manifest: Manifest) -> Table:
    """Return the movable joints as a table."""
    table = Table("joint", "kind", "moves", "from", "to", "held by", box=None)
    for joint in manifest.movable.values():
        held = joint.handle.source.replace("_", " ") if joint.handle else "-"
        ends = (_shown(joint, value) for value in (joint.lower, joint.upper))
        table.add_row(escape(joint.name), joint.kind, escape(joint.child), *ends, escape(held))
    return table


def _shown(joint: ManifestJoint, value: float) -> str:
    """Return a joint's value as people read it."""
    if joint.kind == "continuous":
        return "endless"
    return f"{1000 * value:.0f} mm" if joint.unit == "m" else f"{math.degrees(value):.0f} deg"


def _files(folder: Path) -> Iterator[str]:
    """Yield names in a folder; those of subfolders are counted."""
    for path in sorted(folder.iterdir()):
        yield f"{path.name}/ ({len(list(path.iterdir()))})" if path.is_dir() else path.name
