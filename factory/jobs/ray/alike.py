"""What a node has in common with the machine that registers, or it makes other assets."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable
from functools import lru_cache
from typing import Any

from asset_factory import __version__

from ...registry.keys import STAGES
from ...runtime.code import code_digest
from ...runtime.keys import installed_version

#: Less room for temporary files than this, and a node is given no work [bytes].
LEAST_FREE = 64 * 1024**2
_PACKAGES = ("factory", "sim_checks")

Versions = tuple[tuple[str, str], ...]
"""Names and versions of whatever can change an asset."""


@lru_cache(maxsize=1)
def versions() -> Versions:
    """Return versions of this package, its sources, and libraries of its stages on this machine."""
    digests = {name: code_digest(f"asset_factory.{name}")[:12] for name in _PACKAGES}
    sources = ((f"sources of {name}", digest) for name, digest in digests.items())
    libraries = sorted({library for stage in STAGES for library in stage.libraries})
    found = ((library, installed_version(library)) for library in libraries)
    return (("asset-factory", __version__), *sources, *found)


def difference(here: Versions, there: Versions) -> str:
    """Return what a node has otherwise, in words; its first three are enough to see why."""
    other = dict(there)
    words = [
        f"{name} {other.get(name, 'absent')}, here {version}"
        for name, version in here
        if other.get(name, "absent") != version
    ]
    more = f", and {len(words) - 3} more" if len(words) > 3 else ""
    return "; ".join(words[:3]) + more


def room() -> int:
    """Return the room for temporary files [bytes]."""
    return shutil.disk_usage(tempfile.gettempdir()).free


def looking_first() -> Callable[..., tuple[str, str, Any]]:
    """Return what Ray is given to call; it travels as code: a node may have another package.

    It answers with a word, the node's id and a value: ``absent`` and why this package cannot be
    imported, ``other`` and the node's versions, ``full`` and the bytes that are left there, or
    what :func:`~.worker.carry_out` says.
    """

    def look_and_work(
        packed: bytes, wanted: Any, data: bytes, weights: Any
    ) -> tuple[str, str, Any]:
        import signal

        import ray

        # A cancelled task that runs already ends all the same; one that waits never begins.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        node = str(ray.get_runtime_context().get_node_id())
        try:
            from asset_factory.factory.jobs.ray.alike import room, versions
            from asset_factory.factory.jobs.ray.worker import carry_out

            there = versions()
        except ImportError as error:
            return "absent", node, str(error)
        if there != wanted:
            return "other", node, there
        left = room()
        if left < LEAST_FREE:
            return "full", node, left
        word, value = carry_out(packed, data, weights)
        left = room()
        return ("full", node, left) if left < LEAST_FREE or word == "full" else (word, node, value)

    return look_and_work
