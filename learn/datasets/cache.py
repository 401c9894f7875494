"""Every object of a dataset as a sampled object, made once.

``CACHE/<kind>-<settings>/<key>.npz`` is an object, ``<key>.json`` beside it the reason why there
is none, and ``<dataset>.json`` the report of the last pass. The key is a digest of the object's
name and files, the settings and the
versions: an altered object has another one.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from threading import Lock, local

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.intake.naming import safe_name
from asset_factory.factory.runtime.code import code_digest
from asset_factory.factory.runtime.store import stage_key
from asset_factory.sim_checks.processes.isolation import WarmChild, preload, processors

from .catalog import source
from .item import SourceItem
from .making import make_sampled
from .refusal import ItemRefusal, read_refusal, write_refusal
from .report import SourceReport, names_read
from .settings import SourceSettings
from .split import read_split

#: A child is replaced when it holds more than this [bytes].
LARGE_CHILD = 1536 * 1024 * 1024
COMMON_MODULES = ("scipy.spatial", "scipy.sparse.csgraph", "asset_factory.learn.datasets.making")


@dataclass(frozen=True)
class Prepared:
    """A dataset in the cache.

    Attributes:
        sampled objects: their files, in the order of ``report.read``.
        report: what became of every object.
    """

    sampled_objects: tuple[Path, ...]
    report: SourceReport


def prepare(
    kind: str,
    path: Path,
    cache: Path,
    *,
    split: Path | None = None,
    settings: SourceSettings | None = None,
    workers: int | None = None,
    on_progress: Callable[[int, int], None] | None = None,
) -> Prepared:
    """Bring a dataset into the cache; samples in it are not made again.

    Every object is read in a process that may crash, hang or run out of memory; that costs the
    object, which is passed over with its reason, and nothing else. Such accidents are tried again
    by the next pass; refusals are kept.

    Args:
        kind: of dataset, one of ``SOURCES``.
        path: its folder.
        cache: where sampled objects are kept; made if it is not there.
        split: a text file with the names of the objects wanted; all of them if ``None``.
        settings: of the reading.
        workers: processes at once; as many as there are processors if ``None``.
        on_progress: told how many objects are done, and how many there are.

    Raises:
        ConfigError: no such kind, folder or split, a library that the kind needs is missing, or
            nothing found there.
    """
    chosen = settings or SourceSettings()
    found = find_all(kind, path)
    items = found if split is None else _named(found, split)
    there = [importlib.util.find_spec(module) is not None for module in source(kind).modules]
    digest = stage_key("sampled", code_digest(__name__), kind, chosen.decisive, there)[-16:]
    folder = cache / f"{kind}-{digest}"
    folder.mkdir(parents=True, exist_ok=True)
    outcomes = _Pass(kind, folder, chosen, len(items), on_progress).over(
        items, workers or processors()
    )
    skipped: dict[str, dict[str, str]] = {}
    for item, outcome in zip(items, outcomes, strict=True):
        if outcome.refusal is not None:
            skipped.setdefault(outcome.refusal.reason, {})[item.name] = outcome.refusal.message
    read = {
        item.name: o.path for item, o in zip(items, outcomes, strict=True) if o.path is not None
    }
    said = folder / f"{safe_name(Path(path.resolve().name + '.json'))}.json"
    gone = tuple(sorted(set(names_read(said)) - {item.name for item in found}))
    report = SourceReport(kind, tuple(read), skipped, sum(o.is_new for o in outcomes), gone)
    report.write(said)
    return Prepared(tuple(read.values()), report)


def find_all(kind: str, path: Path) -> tuple[SourceItem, ...]:
    """Return a dataset's objects, not read yet. Raises ConfigError: no such kind, or empty."""
    known = source(kind)
    if not path.is_dir():
        raise ConfigError(f"dataset {path}: is no folder")
    items = known.find(path)
    if not items:
        raise ConfigError(f"dataset {path}: holds no object of kind {kind}; want {known.wants}")
    return items


def _named(items: tuple[SourceItem, ...], split: Path) -> tuple[SourceItem, ...]:
    wanted = read_split(split)
    chosen = tuple(item for item in items if item.name in wanted)
    if not chosen:
        raise ConfigError(
            f"split {split}: names none of the dataset's objects, "
            f"which are called e.g. {items[0].name}"
        )
    return chosen


@dataclass(frozen=True)
class _Outcome:
    """Of one object: its sampled object's file, or why there is none."""

    path: Path | None
    refusal: ItemRefusal | None = None
    is_new: bool = False


class _Pass:
    """One pass over a dataset's objects, several at once, each thread with a child of its own."""

    def __init__(
        self,
        kind: str,
        folder: Path,
        settings: SourceSettings,
        count: int,
        on_progress: Callable[[int, int], None] | None,
    ) -> None:
        self._kind = kind
        self._folder = folder
        self._settings = settings
        self._count = count
        self._done = 0
        self._on_progress = on_progress
        self._own = local()
        self._children: list[WarmChild] = []
        self._lock = Lock()

    def over(self, items: tuple[SourceItem, ...], workers: int) -> list[_Outcome]:
        """Return what became of every object, in their order."""
        preload(COMMON_MODULES)
        try:
            with ThreadPoolExecutor(max_workers=workers, thread_name_prefix="source") as pool:
                return list(pool.map(self._one, items))
        finally:
            for child in self._children:
                child.close()

    def _one(self, item: SourceItem) -> _Outcome:
        outcome = self._found_or_made(item)
        with self._lock:
            self._done += 1
            if self._on_progress is not None:
                self._on_progress(self._done, self._count)
        return outcome

    def _found_or_made(self, item: SourceItem) -> _Outcome:
        try:
            key = stage_key("sampled", item.name, item.category, item.digest())
        except OSError as error:
            return _Outcome(
                None,
                ItemRefusal("unreadable", f"{item.name}: {error.strerror or type(error).__name__}"),
            )
        path = self._folder / f"{key}.npz"
        refused = self._folder / f"{key}.json"
        if path.exists():
            return _Outcome(path)
        kept = read_refusal(refused)
        if kept is not None:
            return _Outcome(None, kept)
        limits = self._settings.limits
        made = self._child().call(
            make_sampled, self._kind, item, self._settings, key, path, limits=limits
        )
        if made.failure is not None:
            return _Outcome(None, ItemRefusal(made.failure, f"{item.name}: {made.detail}"))
        if made.value is not None:
            write_refusal(refused, made.value)
            return _Outcome(None, made.value)
        return _Outcome(path, is_new=True)

    def _child(self) -> WarmChild:
        if not hasattr(self._own, "child"):
            self._own.child = WarmChild(resident_bytes=LARGE_CHILD)
            with self._lock:
                self._children.append(self._own.child)
        child: WarmChild = self._own.child
        return child
