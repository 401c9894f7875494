"""Every object of a dataset as a sampled object, made once.

``CACHE/<kind>-<settings>/<key>.npz`` is an object, ``<key>.json`` beside it the reason why there
is none, and ``<dataset>.json`` the report of the last pass. The key is a digest of the object's
name and files; the folder's, of the settings and the code.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.intake.naming import safe_name
from asset_factory.factory.runtime.code import code_digest
from asset_factory.factory.runtime.store import stage_key, write_json
from asset_factory.sim_checks.processes.isolation import WarmChild, preload, processors

from ..children import ask_children
from .catalog import source
from .item import SourceItem
from .making import make_sampled
from .report import ItemRefusal, SourceReport, read_refusal
from .settings import SourceSettings
from .split import read_split

#: A child is replaced when it holds more than this [bytes].
LARGE_CHILD = 1536 * 1024 * 1024
COMMON_MODULES = ("scipy.spatial", "scipy.sparse.csgraph", "asset_factory.learn.datasets.making")


def prepare(
    kind: str,
    path: Path,
    cache: Path,
    *,
    split: Path | None = None,
    settings: SourceSettings,
    workers: int | None = None,
    on_progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> SourceReport:
    """Bring a dataset into the cache; samples in it are not made again.

    Every object is read in a process that may crash, hang or run out of memory; that costs the
    object, which is passed over with its reason, and nothing else. Such accidents are tried again
    by the next pass; refusals are kept. ``split`` is a text file with the names of the objects
    wanted, all of them if ``None``; there are as many ``workers`` as processors if ``None``;
    ``on_progress`` is told how many objects are done, and how many there are.

    Raises:
        ConfigError: no such kind, folder or split, a library is missing, or nothing found there.
    """
    found = find_all(kind, path)
    items = found if split is None else _named(found, split)
    can = [importlib.util.find_spec(module) is not None for module in source(kind).modules]
    digest = stage_key("sampled", code_digest(__name__), kind, settings.decisive, can)[-16:]
    folder = cache / f"{kind}-{digest}"
    folder.mkdir(parents=True, exist_ok=True)
    there_before = set(folder.glob("*.npz"))
    outcomes: dict[SourceItem, Path | ItemRefusal] = {}

    def ask(child: WarmChild, item: SourceItem) -> tuple[SourceItem, Path | ItemRefusal]:
        return item, _found_or_made(child, kind, item, settings, folder)

    preload(COMMON_MODULES)
    for item, outcome in ask_children(ask, items, workers or processors(), LARGE_CHILD):
        outcomes[item] = outcome
        on_progress(len(outcomes), len(items))
    read: dict[str, Path] = {}
    skipped: dict[str, dict[str, str]] = {}
    for item in items:
        outcome = outcomes[item]
        if isinstance(outcome, Path):
            read[item.name] = outcome
        else:
            skipped.setdefault(outcome.reason, {})[item.name] = outcome.message
    said = folder / f"{safe_name(Path(path.resolve().name + '.json'))}.json"
    report = SourceReport(kind, read, skipped, made=len(set(read.values()) - there_before))
    report.write(said)
    return report


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
        called = f"which are called e.g. {items[0].name}"
        raise ConfigError(f"split {split}: names none of the dataset's objects, {called}")
    return chosen


def _found_or_made(
    child: WarmChild, kind: str, item: SourceItem, settings: SourceSettings, folder: Path
) -> Path | ItemRefusal:
    """Return the file of an object's sampled object, or why there is none."""
    try:
        key = stage_key("sampled", item.name, item.digest())
    except OSError as error:
        said = f"{item.name}: {error.strerror or type(error).__name__}"
        return ItemRefusal("unreadable", said)
    path = folder / f"{key}.npz"
    refused = folder / f"{key}.json"
    if path.exists():
        return path
    kept = read_refusal(refused)
    if kept is not None:
        return kept
    made = child.call(make_sampled, kind, item, settings, key, path, limits=settings.limits)
    if made.failure is not None:
        return ItemRefusal(made.failure, f"{item.name}: {made.detail}")
    if made.value is not None:
        write_json(refused, asdict(made.value))
    return made.value or path
