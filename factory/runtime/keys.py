"""What the result of a stage depends on, declared once beside it; its cache key follows.

A result is made again when its inputs, the settings, libraries or tables that the stage declares,
or the source that it runs are other ones, and only then.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, is_dataclass
from functools import lru_cache, reduce
from importlib import resources
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from asset_factory.sim_checks.config import LIMIT

from ..config import GATE
from .code import code_digest
from .store import digest_bytes, stage_key


@dataclass(frozen=True)
class Stage:
    """A stage of the pipeline, as far as its result can be kept.

    Attributes:
        name: e.g. ``decompose``.
        code: modules that do it, each with what it imports, and packages, see
            :func:`~.code.code_digest`.
        settings: sections or single settings of the configuration, e.g. ``separate`` or
            ``decompose.max_vertices``; all fields of a section count, but for limits and gates.
        libraries: distributions that can change the result.
        data: files of ``configs/`` that it reads.
        also: what else it reads, as JSON data, e.g. digests of weights.
    """

    name: str
    code: tuple[str, ...]
    settings: tuple[str, ...] = ()
    libraries: tuple[str, ...] = ()
    data: tuple[str, ...] = ()
    also: Callable[[Any], object] = lambda config: None

    def key(self, config: object, *inputs: object) -> str:
        """Return the name of the result of these inputs, see :func:`~.store.stage_key`."""
        settings = {
            path: settings_of(reduce(getattr, path.split("."), config)) for path in self.settings
        }
        return stage_key(self.name, settings, self.identity(config), *inputs)

    def identity(self, config: object) -> list[object]:
        """Return what would make another result of the same settings: libraries, tables, code."""
        return [
            self.name,
            [f"{library} {installed_version(library)}" for library in self.libraries],
            [_table_digest(name) for name in self.data],
            code_digest(*self.code),
            self.also(config),
        ]


def settings_of(value: object, *, without: tuple[str, ...] = (LIMIT, GATE)) -> Any:
    """Return the settings as JSON data, but for those marked.

    Args:
        value: a setting, or a dataclass of settings.
        without: marks, as in the fields' metadata.
    """
    if not is_dataclass(value):
        return value
    return {
        field.name: settings_of(getattr(value, field.name), without=without)
        for field in fields(value)
        if not any(mark in field.metadata for mark in without)
    }


@lru_cache(maxsize=64)
def installed_version(distribution: str) -> str:
    """Return a distribution's version; ``absent`` where it is not installed."""
    try:
        return version(distribution)
    except PackageNotFoundError:
        return "absent"


@lru_cache(maxsize=16)
def _table_digest(name: str) -> str:
    return digest_bytes((resources.files("asset_factory") / "configs" / name).read_bytes())
