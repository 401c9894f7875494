"""What the page of one asset says, as data: read from its folder, believed only as text."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import asdict, dataclass, field
from functools import cached_property
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
    """A finding, where it is if that is known, and the place's number on the page, else -1."""

    finding: Finding
    fault: Fault | None
    place: int


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
        repairs: what was changed.
        manifest: ``asset.json``; ``None`` where there is none that can be read.
        registry: name of its registry's folder; empty for a file that is only viewed.
        model: GLB of ours; empty where there is none.
        start: the fault that is shown first; by default the first error.
    """

    entry: Entry
    report: Report = field(default_factory=lambda: Report(""))
    repairs: tuple[Repair, ...] = ()
    manifest: Manifest | None = None
    registry: str = ""
    model: bytes = field(default=b"", repr=False)
    start: Fault | None = None

    @cached_property
    def scene(self) -> SceneGraph | None:
        """Return the shown model; ``None`` where there is none."""
        return scene_from(self.model) if self.model else None

    @property
    def folder(self) -> str:
        """Return a link to the asset's own folder; empty for a file that is only viewed."""
        return f"../../../{self.entry.folder}/" if self.registry else ""

    @property
    def edit(self) -> str:
        """Return the command with which somebody says what opens; empty where nothing is shown."""
        known = self.registry and self.model
        return f"factory edit {self.registry}/{self.entry.folder}" if known else ""

    @property
    def hypotheses(self) -> tuple[str, ...]:
        """Return sentences on other hypotheses of the input."""
        return tuple(f.message for f in self.report.findings if f.code == OTHER_HYPOTHESIS)

    @cached_property
    def _places(self) -> Places | None:
        return None if self.scene is None else Places(self.scene, self.report.measurements)

    @cached_property
    def findings(self) -> tuple[FindingTold, ...]:
        """Return the findings, errors first."""
        told = []
        number = 0
        # The validator says the same of the URDF and of the MJCF.
        once = {told_once(each): each for each in reversed(self.report.findings)}
        findings = (each for each in self.report.findings if each is once[told_once(each)])
        ordered = [each for group in group_findings(tuple(findings)) for each in group]
        for finding in ordered[:_MAX_FINDINGS]:
            if finding.code == OTHER_HYPOTHESIS:
                continue
            fault = None if self._places is None else self._places.of(finding)
            told.append(FindingTold(finding, fault, -1 if fault is None else number))
            number += fault is not None
        return tuple(told)

    @property
    def _first_error(self) -> Fault | None:
        """Return where it is; ``None`` where that is not known, or of an asset that passed."""
        if self.entry.status is Status.PASSED:
            return None
        errors = (told for told in self.findings if told.finding.severity is Severity.ERROR)
        return next((told.fault for told in errors if told.fault is not None), None)

    @property
    def fault(self) -> Fault | None:
        """Return what the picture points at; ``None`` for one that passed."""
        return None if self.entry.status is Status.PASSED else self._first_error or Fault({})

    @property
    def clearance(self) -> float | None:
        """Return the smallest gap that was measured, negative for a depth [mm]."""
        return None if self._places is None else self._places.clearance()

    @property
    def data(self) -> dict[str, Any]:
        """Return what the page's script needs, JSON data; empty where nothing is shown."""
        places = self._places
        if self.scene is None or places is None:
            return {}
        excluded = self.manifest.excluded_pairs if self.manifest else ()
        start = self.start or self._first_error
        return {
            "name": self.entry.id,
            "view": [round(float(x), 4) for x in Viewpoint(self.scene).axes[2]],
            "excess": PenetrationConfig().excess_m,
            "ignored": [*places.ignored(), *excluded],
            "places": [asdict(told.fault) for told in self.findings if told.fault is not None],
            "sweeps": {name: asdict(told) for name, told in places.sweeps().items()},
            "start": None if start is None else asdict(start),
        }

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
    return AssetPage(
        entry,
        told.report,
        told.repairs,
        manifest=read_manifest(folder),
        registry=root.absolute().name,
        model=_model(folder),
    )


def _model(folder: Path) -> bytes:
    """Return the model of an asset; of one that was published without, what its URDF shows."""
    with suppress(OSError, ValueError):
        return read_model(folder / MODEL)
    with suppress(OSError, ValueError, InputRejected):
        return glb_of(scene_of_file(folder / URDF))
    return b""
