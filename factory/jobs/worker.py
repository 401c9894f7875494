"""A worker's side of a job: one input after the other, with validators that stay warm."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from pathlib import Path

from asset_factory.sim_checks.config import CheckConfig
from asset_factory.sim_checks.judge import Judge

from ..build import make_asset
from ..config import BuildConfig
from ..models.service import Address, asking
from ..models.weights.sources import weights_at
from ..registry.product import Product

_JUDGES: dict[tuple[CheckConfig, int], Judge] = {}


def build_here(
    source: Path,
    staging: Path,
    config: BuildConfig,
    cache: Path | None,
    address: Address | None,
    place: Path | None = None,
    weights: Mapping[str, Path] | None = None,
    engines: int = 1,
) -> Product:
    """Make one input in this process, which somebody else may kill.

    What an earlier try left in ``staging`` is removed. ``place`` is where the input lies for
    whoever registers it, and ``weights`` are where checkpoints lie here, if that is elsewhere. So
    many ``engines`` may run at once; verdicts do not depend on it.

    Returns:
        The product, for the registry.
    """
    shutil.rmtree(staging, ignore_errors=True)
    staging.mkdir(parents=True)
    with asking(address), weights_at(weights or {}):
        return make_asset(source, staging, config, cache, _judge(config.checks, engines), place)


def _judge(config: CheckConfig, engines: int) -> Judge:
    """Return this process's validator with those thresholds; its children end with the process."""
    if (config, engines) not in _JUDGES:
        close_judges()
        _JUDGES[config, engines] = Judge(config, engines)
    return _JUDGES[config, engines]


def close_judges() -> None:
    """End this process's validators and their children."""
    while _JUDGES:
        _JUDGES.popitem()[1].close()
