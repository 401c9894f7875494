"""What the page of one asset says, as data: read from its folder, believed only as text."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from itertools import groupby
from pathlib import Path, PurePath
from typing import Any

from asset_factory.sim_checks import Finding, Report, Severity, Status
from asset_factory.sim_checks.config import PenetrationConfig
from asset_factory.sim_checks.grouping import group_findings, told_once

from ...display.camera import Viewpoint
from ...display.described import scene_of_file
from ...display.glb import glb_of, read_model, scene_from
from ...display.pictures import Fault
from ...display.scene import SceneGraph
from ...errors import InputRejected
from ...export.manifest import Manifest
from ...manufacture.repair import Repair
from ...reasons import meaning_of
from ...registry import Entry
from ...registry.registry import read_manifest
from ...registry.report_file import read_report
from ...runtime.layout import MODEL, URDF
from ..loading import Snippet, loading_snippets
from .places import Places

#: Findings on other hypotheses of the input have a section of their own.
OTHER_HYPOTHESIS = "other_reading"
_MAX_FINDINGS = 300
_MESSAGE = 240


@dataclass(frozen=True)
class FindingTold:
    """A finding, and the index of its place on the page; -1 without one."""

    finding: Finding
    place: int = -1


@dataclass(frozen=True)
class FindingGroup:
    """Findings of one code and severity, and what the code means.

    Attributes:
        code: of all.
        severity: ``error``, ``warning`` or ``note``.
        meaning: of the code.
        findings: all of them.
    """

    code: str
    severity: Severity
    meaning: str
    findings: tuple[FindingTold, ...]


@dataclass(frozen=True)
class AssetPage:
    """All that the page of one asset says.

    Attributes:
        entry: its row; of a file that is only viewed, one made for it.
        report: what the validator said.
        scene: what is shown; ``None`` where there is no model.
        manifest: ``asset.json``; ``None`` where there is none that can be read.
        findings: errors first.
        hypotheses: sentences on other hypotheses of the input.
        repairs: what was changed.
        data: for the page's script, JSON data.
        folder: link to the asset's own folder; empty without one.
        registry: name of its registry's folder.
        edit: command with which somebody says what opens; empty for what is only viewed.
        clearance: the smallest gap that was measured, negative for a depth [mm].
        fault: what the picture points at; ``None`` for one that passed.
        model: GLB of the scene.
    """

    entry: Entry
    report: Report = field(default_factory=lambda: Report(""))
    scene: SceneGraph | None = None
    manifest: Manifest | None = None
    findings: tuple[FindingTold, ...] = ()
    hypotheses: tuple[str, ...] = ()
    repairs: tuple[Repair, ...] = ()
    data: Mapping[str, Any] = field(default_factory=dict)
    folder: str = ""
    registry: str = ""
    edit: str = ""
    clearance: float | None = None
    fault: Fault | None = None
    model: bytes = field(default=b"", repr=False)

    @property
    def groups(self) -> tuple[FindingGroup, ...]:
        """Return the findings by severity and code; in order, they follow one another already."""
        kinds = groupby(self.findings, lambda told: (told.finding.severity, told.finding.code))
        return tuple(FindingGroup(c, s, meaning_of(s, c), tuple(group)) for (s, c), group in kinds)

    @property
    def snippets(self) -> tuple[Snippet, ...]:
        """Return how other programs load an asset that passed."""
        if self.manifest is None or self.entry.status is not Status.PASSED:
            return ()
        return loading_snippets(PurePath(self.registry), self.entry.id, self.manifest)

    def row(self) -> dict[str, Any]:
        """Return what the grid says of it, JSON data."""
        entry = self.entry
        kinds = [] if self.scene is None else [joint.kind for joint in self.scene.movable]
        picture = "" if self.scene is None else "fault" if self.fault else "closed"
        return {
            "id": entry.id,
            "name": entry.name[:100],
            "category": entry.category[:60],
            "status": str(entry.status),
            "reason": entry.reason[:80],
            "message": entry.message[:_MESSAGE],
            "joints": entry.joints,
            "hulls": entry.hulls,
            "kinds": sorted(set(kinds)),
            "repairs": sorted({repair.kind.label for repair in self.repairs}),
            "license": entry.license[:60],
            "tags": list(entry.tags),
            "clearance": None if self.clearance is None else round(self.clearance, 2),
            "picture": picture,
            "moves": bool(kinds) and picture == "closed",
            "about": about(entry),
        }


def about(entry: Entry) -> str:
    """Return an asset in a few words: ``cabinet · 3 joints · 60 hulls``."""
    counts = [(entry.joints, "joint"), (entry.hulls, "hull")]
    told = [f"{number} {noun}{'' if number == 1 else 's'}" for number, noun in counts]
    return " · ".join([entry.category[:40], *told] if entry.category else told)


def asset_page(root: Path, entry: Entry) -> AssetPage:
    """Return what the page of a registered asset says.

    Raises:
        RegistryError: its report cannot be read.
    """
    folder = root / entry.folder
    told = read_report(folder).told
    report = told.report
    page = AssetPage(
        entry,
        report,
        manifest=read_manifest(folder),
        findings=_findings(report, None),
        hypotheses=tuple(f.message for f in report.findings if f.code == OTHER_HYPOTHESIS),
        repairs=told.repairs,
        folder=f"../../../{entry.folder}/",
        registry=root.absolute().name,
    )
    model = _model(folder)
    if not model:
        return page
    edit = f"factory edit {page.registry}/{entry.folder}"
    return with_model(replace(page, edit=edit), model)


def with_model(page: AssetPage, model: bytes) -> AssetPage:
    """Return a page with a model: findings lead to poses, and the script has its data.

    ``model`` is a GLB of ours. Raises ValueError for another.
    """
    scene = scene_from(model)
    places = Places(scene, page.report.measurements)
    found = _findings(page.report, places)
    faults = [places.of(told.finding) for told in found if told.place >= 0]
    failed = page.entry.status is not Status.PASSED
    hard = [told.place for told in found if told.finding.severity is Severity.ERROR]
    first = next((faults[place] for place in hard if place >= 0), None) if failed else None
    data = {
        "name": page.entry.id,
        "view": [round(float(x), 4) for x in Viewpoint(scene).axes[2]],
        "excess": PenetrationConfig().excess_m,
        "ignored": places.ignored() + list(page.manifest.excluded_pairs if page.manifest else ()),
        "places": [_plain(fault) for fault in faults if fault is not None],
        "sweeps": {name: asdict(told) for name, told in places.sweeps().items()},
        "start": _plain(first),
    }
    return replace(
        page,
        scene=scene,
        findings=found,
        data=data,
        clearance=places.clearance(),
        fault=first or (Fault({}) if failed else None),
        model=model,
    )


def _findings(report: Report, places: Places | None) -> tuple[FindingTold, ...]:
    told = []
    number = 0
    # The validator says the same of the URDF and of the MJCF.
    once = {told_once(each): each for each in reversed(report.findings)}
    findings = (each for each in report.findings if each is once[told_once(each)])
    ordered = [each for group in group_findings(tuple(findings)) for each in group]
    for finding in ordered[:_MAX_FINDINGS]:
        if finding.code == OTHER_HYPOTHESIS:
            continue
        found = places is not None and places.of(finding) is not None
        told.append(FindingTold(finding, number if found else -1))
        number += found
    return tuple(told)


def _plain(fault: Fault | None) -> dict[str, Any] | None:
    if fault is None:
        return None
    return {"values": dict(fault.values), "point": list(fault.point) if fault.point else None}


def _model(folder: Path) -> bytes:
    """Return the model of an asset; of one that was published without, what its URDF shows."""
    with suppress(OSError, ValueError):
        return read_model(folder / MODEL)
    with suppress(OSError, ValueError, InputRejected):
        return glb_of(scene_of_file(folder / URDF))
    return b""
