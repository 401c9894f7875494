"""Verdicts of inputs by content, settings and libraries."""

from __future__ import annotations

from functools import lru_cache

from asset_factory import __version__
from asset_factory.sim_checks.config import LIMIT

from ..articulate.stage import ARTICULATE
from ..config import BuildConfig
from ..intake.load import LOAD
from ..intake.source import Source
from ..manufacture.decompose.decompose import DECOMPOSE
from ..manufacture.solids.build import SOLIDS
from ..manufacture.stage import FINISH
from ..runtime.code import code_digest
from ..runtime.keys import settings_of
from ..runtime.store import digest_bytes, stage_key
from ..verify.validate import INSPECT, VALIDATE

#: Every stage whose result is kept, in order.
STAGES = (LOAD, ARTICULATE, SOLIDS, DECOMPOSE, FINISH, INSPECT, VALIDATE)
#: What runs them, and does what is done anew each time.
PIPELINE = "asset_factory.factory.build"


def build_key(loaded: str, config: BuildConfig) -> str:
    """Return the key of all that an asset and its verdict follow from; ``loaded``: the input's."""
    return digest_bytes(f"{loaded} {_pipeline_key(config)}".encode())


def source_key(source: Source) -> str:
    """Return :func:`build_key` of a loaded input; empty if its files kept changing."""
    if not (source.keyed and source.reads):
        return ""
    return build_key(source.loaded_key, source.config)


def failure_key(built: str, config: BuildConfig) -> str:
    """Return the key of an input without a verdict: another version or limit may give one.

    ``built`` is the input's :func:`build_key`, empty if it is not known.
    """
    if not built:
        return ""
    settings = settings_of(config, without=())
    return stage_key("failure", __version__, built, settings).removeprefix("failure-")


@lru_cache(maxsize=4)
def _pipeline_key(config: BuildConfig) -> str:
    settings = settings_of(config, without=(LIMIT,))
    identities = [stage.identity(config) for stage in STAGES]
    return stage_key("build", settings, identities, code_digest(PIPELINE))
