"""``report.json`` of an entry: what the validator said, and what it was registered as."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from asset_factory.sim_checks import Report
from asset_factory.sim_checks.reasons import GPU_LIMITS

from ..errors import RegistryError
from ..manufacture.repair import Repair, older_repair
from ..runtime.layout import REPORT
from ..runtime.store import NOT_A_FILE, digest_bytes, folder_digests, write_json
from .entry import Entry, lasting_data

_MAX_BYTES = 256_000_000
_DIGEST = re.compile("[0-9a-f]{64}")


@dataclass(frozen=True)
class BuildReport:
    """The report of one build.

    Attributes:
        report: of the validator, or why it was not asked.
        repairs: changes before that.
    """

    report: Report
    repairs: tuple[Repair, ...] = ()


@dataclass(frozen=True)
class StoredReport:
    """A report as it was read; nothing in it is believed before it is asked for.

    Attributes:
        data: all of it, JSON data.
        digest: SHA-256 of its file.
    """

    data: Mapping[str, Any]
    digest: str

    @property
    def report(self) -> Report:
        """Return what the validator said. Raises KeyError, TypeError or ValueError if none."""
        return Report.from_dict(self.data)

    @property
    def told(self) -> BuildReport:
        """Return it as registered. Raises RegistryError if it is none."""
        try:
            return BuildReport(self.report, self.repairs)
        except (KeyError, TypeError, ValueError) as error:
            raise RegistryError(f"{REPORT}: is none of a build ({error!r})") from error

    @property
    def entry(self) -> object:
        """Return what the asset was registered as, JSON data. Raises KeyError where it has none."""
        return self.data["entry"]

    @property
    def passed(self) -> bool:
        """Return whether it says that the asset passed."""
        return self.data.get("passed") is True

    @property
    def clean(self) -> bool:
        """Return whether it passed without any finding."""
        return self.passed and self.data.get("findings") == []

    @property
    def gpu_ready(self) -> str:
        """Return ``yes`` or ``no``, whether PhysX takes its hulls on a GPU; empty if not passed."""
        if not self.passed:
            return ""
        codes = {str(finding["code"]) for finding in self.data.get("findings", ())}
        return "yes" if codes.isdisjoint(GPU_LIMITS) else "no"

    @property
    def repairs(self) -> tuple[Repair, ...]:
        """Return the repairs. Raises KeyError, TypeError or ValueError at bad data."""
        if "changes" in self.data:
            return tuple(Repair.from_dict(each) for each in self.data["changes"])
        return tuple(older_repair(str(sentence)) for sentence in self.data.get("repairs", ()))

    @property
    def files(self) -> dict[str, str]:
        """Return SHA-256 of the asset's files when it was registered, by path.

        Raises:
            ValueError: it has none, or they are no digests.
        """
        files = self.data.get("files")
        if not isinstance(files, dict) or not all(
            isinstance(each, str) and _DIGEST.fullmatch(each) for each in files.values()
        ):
            raise ValueError("its files are no digests")
        return files


def read_report(folder: Path) -> StoredReport:
    """Return a folder's report. Raises RegistryError if it cannot be read."""
    path = folder / REPORT
    try:
        if path.is_symlink() or path.stat().st_size > _MAX_BYTES:
            raise RegistryError(f"{path}: {NOT_A_FILE} of at most {_MAX_BYTES // 1_000_000} MB")
        content = path.read_bytes()
        data = json.loads(content, parse_constant=_no_number)
    except (OSError, ValueError, RecursionError) as error:
        raise RegistryError(f"{path}: cannot be read ({error})") from error
    if not isinstance(data, dict):
        raise RegistryError(f"{path} must be an object, not {type(data).__name__}")
    return StoredReport(data, digest_bytes(content))


def write_report(folder: Path, entry: Entry, told: BuildReport, files: Mapping[str, str]) -> None:
    """Write a folder's report; ``files`` are the :func:`file_digests` of the others in it."""
    data = {
        **told.report.to_dict(),
        "id": entry.id,
        "repairs": [repair.sentence for repair in told.repairs],
        "changes": [repair.to_dict() for repair in told.repairs],
        "files": files,
        "entry": lasting_data(entry),
    }
    write_json(folder / REPORT, data)


def file_digests(folder: Path) -> dict[str, str]:
    """Return SHA-256 of every file of an asset but its report, by path, sorted."""
    return folder_digests(folder, without=(REPORT,))


def _no_number(name: str) -> float:
    raise ValueError(f"{name} is no JSON")
