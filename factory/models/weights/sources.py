"""Where published weights come from, and under which terms."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from functools import lru_cache
from importlib import resources
from pathlib import Path
from types import MappingProxyType

from ...errors import ConfigError
from ...runtime.store import digest_file
from ...runtime.terminal import complain

HUB = "hf:"
#: How a hub's file is named: a commit and a digest make it the same file for ever.
ADDRESS = f"{HUB}owner/repository/file@commit#sha256"
_ADDRESS = re.compile(
    rf"{HUB}(?P<repository>[^/@#]+/[^/@#]+)/(?P<file>[^@#]+)"
    r"(?:@(?P<revision>[0-9a-f]{40}))?(?:#(?P<sha256>[0-9a-f]{64}))?"
)
PAPER = "paper"
"""The name of the published weights of Particulate and of the features that they ask for."""
SHIPPED = "shipped"
"""The name of the weights that come with the package."""


@dataclass(frozen=True)
class WeightsProvenance:
    """Who made a network's weights, and what may be done with them.

    Attributes:
        network: its name.
        source: the published file, as :data:`ADDRESS`; without a digest, for none could be taken
            where this was written: :func:`fetch` says what a user can pin.
        terms: of the published weights, one sentence.
        outputs: the license that their terms put on whatever they help to make; empty if none.
    """

    network: str
    source: str
    terms: str
    outputs: str = ""


PARTICULATE = WeightsProvenance(
    "Part Articulation Transformer",
    "hf:rayli/Particulate/model.pt",
    "Published by the authors of Particulate (arXiv 2512.11798) under CC-BY-4.0: "
    "name them when you pass it on.",
)
PARTFIELD = WeightsProvenance(
    "PartField",
    "hf:mikaelaangel/partfield-ckpt/model_objaverse.ckpt",
    "Published by NVIDIA (arXiv 2504.11451) for NON-COMMERCIAL use only, "
    "and so is whatever is derived from it.",
    outputs="LicenseRef-NVIDIA-NonCommercial",
)


_ELSEWHERE: ContextVar[Mapping[str, Path]] = ContextVar("weights_at", default=MappingProxyType({}))


@contextmanager
def weights_at(places: Mapping[str, Path]) -> Iterator[None]:
    """Have checkpoints fetched from ``places`` within this, by their configured names."""
    before = _ELSEWHERE.set(places)
    try:
        yield
    finally:
        _ELSEWHERE.reset(before)


@dataclass(frozen=True)
class HubFile:
    """A file of a hub.

    Attributes:
        repository: ``owner/name``.
        file: its path there.
        revision: the commit, 40 hexadecimal digits; ``None``: the newest.
        sha256: of its content; ``None``: any.
    """

    repository: str
    file: str
    revision: str | None = None
    sha256: str | None = None

    def __str__(self) -> str:
        commit = f"@{self.revision}" if self.revision else ""
        digest = f"#{self.sha256}" if self.sha256 else ""
        return f"{HUB}{self.repository}/{self.file}{commit}{digest}"


def parse_address(address: str) -> HubFile:
    """Return what a hub's address names.

    Raises:
        ConfigError: it is malformed, or names a branch or tag, which is another file tomorrow.
    """
    found = _ADDRESS.fullmatch(address)
    if found is None:
        digits = "a commit has 40 hexadecimal digits, a SHA-256 64"
        raise ConfigError(f"{address}: want {ADDRESS}, as {PARTICULATE.source}; {digits}")
    return HubFile(**found.groupdict())


def shipped_file(name: str) -> Path:
    """Return where a file of ``configs/weights`` lies."""
    return Path(str(resources.files("asset_factory") / "configs" / "weights" / name))


def fetch(checkpoint: str) -> Path:
    """Return a checkpoint's file: the path itself, the package's own, or a download.

    Within :func:`weights_at`, the file that it names. A download is what its address says before
    anybody reads it; where that says no commit or no digest, this is told once, with both.

    Raises:
        ConfigError: no such file, a malformed address, a download that failed, or one with another
            digest.
    """
    if checkpoint in _ELSEWHERE.get():
        return _ELSEWHERE.get()[checkpoint]
    if not checkpoint.startswith(HUB):
        own = checkpoint == SHIPPED
        path = shipped_file("small.safetensors") if own else Path(checkpoint).expanduser()
        if not path.is_file():
            want = f"want a checkpoint, {SHIPPED}, or {ADDRESS}"
            raise ConfigError(f"{checkpoint}: no such file; {want}")
        return path
    wanted = parse_address(checkpoint)
    path = _downloaded(wanted)
    found = path.stat()
    _require_wanted(wanted, path, found.st_ino, found.st_size, found.st_mtime_ns)
    return path


@lru_cache(maxsize=8)
def _require_wanted(wanted: HubFile, path: Path, *_state: int) -> None:
    """Refuse a download with another digest; tell of one that may be another one tomorrow."""
    digest = digest_file(path)
    if wanted.sha256 not in (None, digest):
        raise ConfigError(f"{wanted}: its SHA-256 is {digest}; it is not the file that was asked")
    # The hub's cache has a folder for each commit.
    commits = (part for part in path.parts if re.fullmatch("[0-9a-f]{40}", part))
    revision = wanted.revision or next(commits, None)
    pinned = HubFile(wanted.repository, wanted.file, revision, digest)
    if pinned != wanted:
        complain(f"{wanted}: may be another file tomorrow; this one is {pinned}")


def _downloaded(wanted: HubFile) -> Path:
    try:
        from huggingface_hub import hf_hub_download
        from huggingface_hub.errors import (
            HfHubHTTPError,
            HFValidationError,
            LocalEntryNotFoundError,
        )
    except ImportError as error:
        needs = "downloads need huggingface_hub: pip install huggingface_hub"
        raise ConfigError(f"{wanted}: {needs}") from error
    try:
        place = hf_hub_download(
            repo_id=wanted.repository, filename=wanted.file, revision=wanted.revision
        )
    except (HfHubHTTPError, HFValidationError, LocalEntryNotFoundError, OSError) as error:
        first = (str(error).strip().splitlines() or [type(error).__name__])[0]
        raise ConfigError(f"{wanted}: download failed: {first}") from error
    return Path(place)
