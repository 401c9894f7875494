"""Where published weights come from, and under which terms."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from types import MappingProxyType

from ...errors import ConfigError

HUB = "hf:"
SHIPPED = "shipped"
"""The name of the weights that come with the package."""


@dataclass(frozen=True)
class WeightsProvenance:
    """Who made a network's weights, and what may be done with them.

    Attributes:
        network: its name.
        source: the published file, as ``hf:owner/repository/file``.
        terms: of the published weights, one sentence.
    """

    network: str
    source: str
    terms: str


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
)


_ELSEWHERE: ContextVar[Mapping[str, Path]] = ContextVar("weights_at", default=MappingProxyType({}))


@contextmanager
def weights_at(places: Mapping[str, Path]) -> Iterator[None]:
    """Within this, checkpoints lie where ``places`` says, by what configurations call them."""
    before = _ELSEWHERE.set(places)
    try:
        yield
    finally:
        _ELSEWHERE.reset(before)


def fetch(checkpoint: str) -> Path:
    """The checkpoint's file: the path itself, the package's own, or a download kept by the hub.

    Within :func:`weights_at`, the file that it names.

    Args:
        checkpoint: a path, ``shipped``, or ``hf:owner/repository/file``.

    Raises:
        ConfigError: no such file, a malformed address, or a download that failed.
    """
    if checkpoint in _ELSEWHERE.get():
        return _ELSEWHERE.get()[checkpoint]
    if not checkpoint.startswith(HUB):
        own = resources.files("asset_factory") / "configs" / "weights" / "small.safetensors"
        path = Path(str(own)) if checkpoint == SHIPPED else Path(checkpoint).expanduser()
        if not path.is_file():
            raise ConfigError(
                f"{checkpoint}: no such file; "
                f"want a checkpoint, {SHIPPED}, or {HUB}owner/repository/file"
            )
        return path
    owner, _, rest = checkpoint.removeprefix(HUB).partition("/")
    repository, _, name = rest.partition("/")
    if not (owner and repository and name):
        raise ConfigError(f"{checkpoint}: want {HUB}owner/repository/file, as {PARTICULATE.source}")
    try:
        from huggingface_hub import hf_hub_download
        from huggingface_hub.errors import (
            HfHubHTTPError,
            HFValidationError,
            LocalEntryNotFoundError,
        )
    except ImportError as error:
        raise ConfigError(
            f"{checkpoint}: downloads need huggingface_hub: pip install huggingface_hub"
        ) from error
    try:
        return Path(hf_hub_download(repo_id=f"{owner}/{repository}", filename=name))
    except (HfHubHTTPError, HFValidationError, LocalEntryNotFoundError, OSError) as error:
        first = (str(error).strip().splitlines() or [type(error).__name__])[0]
        raise ConfigError(f"{checkpoint}: download failed: {first}") from error
