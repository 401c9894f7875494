"""Which sample is the n-th of a step: a function of seed, step and number, nothing else.

So nothing about sources is stored to go on with a run, and the number of workers changes nothing.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, fields
from functools import partial
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from asset_factory.factory.errors import AssetFactoryError, ConfigError, InputRejected
from asset_factory.factory.presets import overlay

from ..datasets import SourceReport, SourceSettings, prepare
from ..datasets.split import read_split
from ..objects.mixture import MixtureSettings, sample_object
from ..samples.batches import Batch, collate
from ..samples.sample import DrawSettings, Sample, draw
from ..samples.sampled_object import SampledObject, read_sampled, sampled_from
from .settings import DataSource, TrainConfig

_TRAINING, _HELD_OUT, _OBJECT, _ORDER = range(4)
_TRIES = 20


@dataclass(frozen=True)
class Files:
    """The sampled objects of a source in files, sorted.

    ``report`` says what became of the dataset that they were made of; ``None``: of none.
    """

    source: DataSource
    paths: tuple[Path, ...]
    report: SourceReport | None = None


@dataclass(frozen=True)
class Generator:
    """The sampled objects of a source that are made when they are wanted."""

    source: DataSource
    style: MixtureSettings


Pool = Files | Generator


def find_pools(sources: Iterable[DataSource], cache: Path) -> tuple[Pool, ...]:
    """Return the samples behind sources; other formats are converted into ``cache`` first.

    Raises:
        ConfigError: a source has nothing to give.
    """
    return tuple(_pool(source, cache) for source in sources)


def _pool(source: DataSource, cache: Path) -> Pool:
    if source.kind == "procedural":
        style = overlay(MixtureSettings(), source.style, "procedural: style")
        return Generator(source, style)
    return _sampled_files(source) if source.kind == "sampled" else _converted(source, cache)


def source_lines(pools: Iterable[Pool]) -> list[str]:
    """Return lines for people: what became of the objects of converted sources."""
    reports = (pool.report for pool in pools if isinstance(pool, Files))
    return [line for report in reports if report is not None for line in report.lines()]


def source_counts(pools: Iterable[Pool]) -> list[dict[str, Any]]:
    """Return what each source gives: its kind, sample count, and skipped objects by reason."""
    return [
        {
            "kind": pool.source.kind,
            "sampled": len(pool.paths) if isinstance(pool, Files) else None,
            "skipped": pool.report.counts if isinstance(pool, Files) and pool.report else {},
        }
        for pool in pools
    ]


def _converted(source: DataSource, cache: Path) -> Files:
    settings = overlay(SourceSettings(), source.options, f"{source.kind}: options")
    split = Path(source.split) if source.split else None
    report = prepare(source.kind, Path(source.path), cache, split=split, settings=settings)
    if not report.read:
        said = "\n".join(report.lines())
        raise ConfigError(f"{source.path}: no object in it can be used; want at least one\n{said}")
    return Files(source, tuple(sorted(report.read.values())), report)


def _sampled_files(source: DataSource) -> Files:
    folder = Path(source.path)
    if not folder.is_dir():
        raise ConfigError(f"{folder}: no such folder; want one with .npz sampled objects")
    named = (path for path in folder.rglob("*.npz") if not path.name.startswith("."))
    paths = sorted(path for path in named if path.is_file())
    if not paths:
        raise ConfigError(f"{folder}: no sampled objects in it; want .npz files")
    if source.split:
        names = read_split(Path(source.split))
        called = f"which are called e.g. {paths[0].stem}"
        paths = [path for path in paths if path.stem in names or path.name in names]
        if not paths:
            raise ConfigError(f"split {source.split}: names none of the objects, {called}")
    return Files(source, tuple(paths))


def digest(pools: Iterable[Pool]) -> str:
    """Return a digest of the data: file names and generator settings, hexadecimal."""
    hashed = sha256()
    for pool in pools:
        named = [path.name for path in pool.paths] if isinstance(pool, Files) else []
        if isinstance(pool, Generator):
            named = [repr((pool.source, pool.style))]
        hashed.update("\n".join([f"{pool.source.weight:g}", *named, ""]).encode())
    return hashed.hexdigest()


class Dataset:
    """Draws the samples of a run."""

    def __init__(self, config: TrainConfig, pools: tuple[Pool, ...]) -> None:
        self._config = config
        self._pools = pools
        weights = np.array([pool.source.weight for pool in pools])
        self._shares = np.cumsum(weights / weights.sum())
        self._kept = _Kept(config.run.cache_mb * 1_000_000)

    def batch(self, step: int, numbers: Iterable[int]) -> Batch:
        """Return the samples at places of a step. Raises ConfigError as :meth:`sample`."""
        samples = [self.sample(step, number) for number in numbers]
        return collate(samples, self._config.network.max_parts)

    def sample(self, step: int, number: int) -> Sample:
        """Return the sample at a place of a step.

        Raises:
            ConfigError: several sampled objects in a row cannot be read or have too many parts.
        """
        config = self._config
        most = config.network.max_parts
        rng = np.random.default_rng([config.seed, _TRAINING, step, number])
        refused = ""
        for attempt in range(_TRIES):
            place = int(np.searchsorted(self._shares, rng.random(), side="right"))
            which = min(place, len(self._pools) - 1)
            pool = self._pools[which]
            try:
                if isinstance(pool, Files):
                    path = pool.paths[int(rng.integers(len(pool.paths)))]
                    sampled = self._kept.get(path, partial(read_sampled, path))
                else:
                    seed = (*self._object_seed(pool.source, which, step, number), attempt)
                    sampled = self._kept.get(seed, partial(_made, pool, seed))
            except AssetFactoryError as error:
                refused = str(error)
                continue
            parts = len(sampled.parents)
            if parts <= most:
                return draw(sampled, rng, config.training_draw)
            refused = f"{sampled.name}: has {parts} parts, want at most {most}"
        failed = f"{_TRIES} sampled objects in a row cannot be used"
        raise ConfigError(f"step {step}: {failed}; the last: {refused}")

    def _object_seed(
        self, source: DataSource, which: int, step: int, number: int
    ) -> tuple[int, ...]:
        """Return the seed of the procedural object behind a sample, but for the attempt.

        Each place of a step has its own stream of objects, of which ``reuse`` samples are drawn
        from each, in an order in which objects of a window of steps are mixed.
        """
        config = self._config
        share = source.weight / sum(each.source.weight for each in self._pools)
        reuse = max(1, round(source.reuse / share))
        block, place = divmod(step, reuse * _WINDOW)
        rng = np.random.default_rng([config.seed, _ORDER, which, number, block])
        order = rng.permutation(reuse * _WINDOW)
        thing = block * _WINDOW + int(order[place]) // reuse
        return (config.seed, _OBJECT, which, number, thing)


_WINDOW = 8
"""Objects of a place that are drawn from at a time."""


def held_out_samples(config: TrainConfig, pools: tuple[Pool, ...]) -> list[Sample]:
    """Return the validation examples of a run: always the same ones.

    Raises:
        ConfigError: there are sources of them, and none gives one that can be used.
    """
    samples = []
    settings: DrawSettings = config.validation_draw
    per_pool = max(1, config.validation.objects // max(1, len(pools)))
    for which, pool in enumerate(pools):
        for number, sampled in _some(pool, per_pool, which, config.seed):
            if len(sampled.parents) <= config.network.max_parts:
                rng = np.random.default_rng([config.seed, _HELD_OUT, which, number])
                samples.append(draw(sampled, rng, settings))
    if pools and not samples:
        wanted = f"can be read and has at most {config.network.max_parts} parts"
        raise ConfigError(f"held_out: none of its objects {wanted}; want some that do")
    return samples


def _some(pool: Pool, wanted: int, which: int, seed: int) -> Iterable[tuple[int, SampledObject]]:
    """Yield sampled objects with their numbers; those that cannot be used leave out theirs."""
    if isinstance(pool, Files):
        rows = np.unique(np.linspace(0, len(pool.paths) - 1, wanted).round().astype(int))
        for number, row in enumerate(rows):
            with suppress(AssetFactoryError):
                yield number, read_sampled(pool.paths[row])
        return
    given = 0
    tried = 0
    while given < wanted and tried < _TRIES * wanted:
        tried += 1
        with suppress(AssetFactoryError):
            yield given, _made(pool, (seed, _HELD_OUT, which, tried))
            given += 1


class _Kept:
    """Sampled objects used last, of at most so many bytes."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._bytes = 0
        self._found: OrderedDict[object, SampledObject] = OrderedDict()

    def get(self, key: object, make: Callable[[], SampledObject]) -> SampledObject:
        found = self._found.pop(key, None)
        if found is None:
            found = make()
            self._bytes += _size(found)
        self._found[key] = found
        while self._bytes > self._most and len(self._found) > 1:
            self._bytes -= _size(self._found.popitem(last=False)[1])
        return found


def _size(sampled: SampledObject) -> int:
    return sum(getattr(getattr(sampled, each.name), "nbytes", 100) for each in fields(sampled))


def _made(pool: Generator, seed: tuple[int, ...]) -> SampledObject:
    rng = np.random.default_rng(seed)
    try:
        name, articulation = sample_object(rng, pool.style)
        return sampled_from(articulation, name, pool.source.points, rng)
    except AssetFactoryError:
        raise
    except (ValueError, ArithmeticError, LookupError, RuntimeError) as error:
        # One odd object in a million must not end a run; when all are odd, the run says so.
        said = f"procedural object {seed}: {type(error).__name__}: {error}"
        raise InputRejected("not_made", said) from None
