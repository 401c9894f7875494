"""What ``factory show`` prints of one asset."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from rich.markup import escape
from rich.table import Table

from asset_factory.sim_checks import Status

from ..registry import Entry
from ..registry.logged import logged_build
from ..registry.report_file import BuildReport
from ..runtime.layout import ASSETS, REJECTED
from . import console

if TYPE_CHECKING:
    from ..export.manifest import Manifest, ManifestJoint


def print_entry(entry: Entry, root: Path, told: BuildReport, manifest: Manifest | None) -> None:
    """Print one asset: what it is, its joints and files, its findings, and how to load it."""
    passed = entry.status is Status.PASSED
    folder = root / (ASSETS if passed else REJECTED) / entry.id
    terminal = console.terminal()
    size = f", {manifest.size} m, {manifest.mass:.3g} kg" if manifest else ""
    counts = f"{entry.parts} parts, {entry.joints} movable joints, {entry.hulls} hulls"
    terminal.print(f"{entry.id}: {counts}{size}", markup=False, soft_wrap=True)
    terminal.print(f"{folder}: {', '.join(_files(folder))}", markup=False, soft_wrap=True)
    logged = logged_build(root, entry.id)
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
    if manifest is not None and passed:
        from ..report.loading import loading_snippets

        for snippet in loading_snippets(root, entry.id, manifest):
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
    return f"{1000 * value:.0f} mm" if joint.unit == "m" else f"{np.degrees(value):.0f} deg"


def _files(folder: Path) -> Iterator[str]:
    """Yield names in a folder; those of subfolders are counted."""
    for path in sorted(folder.iterdir()):
        yield f"{path.name}/ ({len(list(path.iterdir()))})" if path.is_dir() else path.name
