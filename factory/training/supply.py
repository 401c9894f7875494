"""Which example is the n-th of a step: a function of the seed, the step and the number, and of nothing else.

So nothing about the sources has to be stored to go on with a run, and the number of workers changes no sample.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Iterable
from dataclasses import dataclass, fields
from hashlib import sha256
from pathlib import Path

import numpy as np

from ..errors import AssetFactoryError, ConfigError
from ..presets import overlay
from .objects.mixture import MixtureSettings, sample_object
from .sample import DrawSettings, Sample, draw
from .settings import DataSource, TrainConfig
from .specimen import Specimen, read_specimen, specimen_of

_TRAINING, _HELD_OUT, _OBJECT, _ORDER = range(4)
_TRIES = 20


@dataclass(frozen=True)
class Files:
    """Specimens in files.

    Attributes:
        paths: sorted.
        weight: how often they are drawn, relative to the other pools.
    """

    paths: tuple[Path, ...]
    weight: float


@dataclass(frozen=True)
class Generator:
    """Specimens that are made when they are wanted.

    Attributes:
        source: how they are used.
        style: what they are like.
        weight: how often they are drawn, relative to the other pools.
    """

    source: DataSource
    style: MixtureSettings
    weight: float


Pool = Files | Generator


def find_pools(sources: Iterable[DataSource], cache: Path) -> tuple[Pool, ...]:
    """The specimens behind sources; those that are in other formats are converted into ``cache`` first.

    Raises:
        ConfigError: a source has nothing to give.
    """
    pools: list[Pool] = []
    for source in sources:
        if source.kind == "procedural":
            style = overlay(MixtureSettings(), source.style, "procedural: style")
            pools.append(Generator(source, style, source.weight))
            continue
        paths = _specimen_files(source) if source.kind == "specimens" else _converted(source, cache)
        if not paths:
            raise ConfigError(f"{source.path}: no {source.kind} in it to train on")
        pools.append(Files(tuple(sorted(paths)), source.weight))
    return tuple(pools)


def _converted(source: DataSource, cache: Path) -> list[Path]:
    from .sources import SourceSettings, prepare

    settings = overlay(SourceSettings(), source.options, f"{source.kind}: options")
    split = Path(source.split) if source.split else None
    return list(prepare(source.kind, Path(source.path), cache, split=split, settings=settings).specimens)


def _specimen_files(source: DataSource) -> list[Path]:
    folder = Path(source.path)
    if not folder.is_dir():
        raise ConfigError(f"{folder}: no such folder; want one with .npz specimens")
    paths = sorted(folder.rglob("*.npz"))
    if not source.split:
        return paths
    try:
        names = set(Path(source.split).read_text(encoding="utf-8").split())
    except OSError as error:
        raise ConfigError(f"{source.split}: {error.strerror}") from error
    return [path for path in paths if path.stem in names or path.name in names]


def digest(pools: Iterable[Pool]) -> str:
    """Of which data there is: names of files and settings of generators, as a hexadecimal number."""
    hashed = sha256()
    for pool in pools:
        named = [path.name for path in pool.paths] if isinstance(pool, Files) else [repr((pool.source, pool.style))]
        hashed.update("\n".join([f"{pool.weight:g}", *named, ""]).encode())
    return hashed.hexdigest()


class Supply:
    """Draws the samples of a run.

    Args:
        config: of the run.
        pools: of its data.
    """

    def __init__(self, config: TrainConfig, pools: tuple[Pool, ...]) -> None:
        self._config, self._pools = config, pools
        weights = np.array([pool.weight for pool in pools])
        self._shares = np.cumsum(weights / weights.sum())
        self._kept = _Kept(config.run.cache_mb * 1_000_000)

    def sample(self, step: int, number: int) -> Sample:
        """The sample at a place of a step.

        Raises:
            ConfigError: several specimens in a row cannot be read or have too many parts.
        """
        config = self._config
        rng = np.random.default_rng([config.seed, _TRAINING, step, number])
        refused = ""
        for attempt in range(_TRIES):
            which = min(int(np.searchsorted(self._shares, rng.random(), side="right")), len(self._pools) - 1)
            pool = self._pools[which]
            try:
                if isinstance(pool, Files):
                    specimen = self._kept.read(pool.paths[int(rng.integers(len(pool.paths)))])
                else:
                    specimen = self._kept.make(pool, self._object_seed(which, step, number, attempt))
            except AssetFactoryError as error:
                refused = str(error)
                continue
            if len(specimen.parents) <= config.network.max_parts:
                return draw(specimen, rng, config.draw_at(step))
            refused = f"{specimen.name}: has {len(specimen.parents)} parts, want at most {config.network.max_parts}"
        raise ConfigError(f"step {step}: {_TRIES} specimens in a row cannot be used; the last: {refused}")

    def _object_seed(self, which: int, step: int, number: int, attempt: int) -> tuple[int, ...]:
        """Seed of the procedural object behind a sample.

        Each lane has its own stream of objects, of which ``reuse`` samples are drawn from each, in an order in which
        objects from a window of steps are mixed; a worker that takes a whole lane makes each object once.
        """
        config, pool = self._config, self._pools[which]
        source = pool.source if isinstance(pool, Generator) else DataSource()
        lane, row = number % config.lanes, number // config.lanes
        in_lane = len(range(lane, config.batch, config.lanes))
        share = pool.weight / sum(each.weight for each in self._pools)
        reuse = max(1, round(source.reuse / share))
        block, place = divmod(step * in_lane + row, reuse * _WINDOW)
        order = np.random.default_rng([config.seed, _ORDER, which, lane, block]).permutation(reuse * _WINDOW)
        thing = block * _WINDOW + int(order[place]) // reuse
        if source.objects:
            return (config.seed, _OBJECT, which, (thing * config.lanes + lane) % source.objects, attempt)
        return (config.seed, _OBJECT, which, lane, thing, attempt)


_WINDOW = 8
"""Objects of a lane that are drawn from at a time."""


def held_out_samples(config: TrainConfig, pools: tuple[Pool, ...]) -> list[Sample]:
    """The validation examples of a run: always the same ones."""
    samples = []
    kept = _Kept(0)
    settings: DrawSettings = config.validation_draw
    per_pool = max(1, config.validation.objects // max(1, len(pools)))
    for which, pool in enumerate(pools):
        for number, specimen in enumerate(_some(pool, per_pool, which, config.seed, kept)):
            if len(specimen.parents) <= config.network.max_parts:
                rng = np.random.default_rng([config.seed, _HELD_OUT, which, number])
                samples.append(draw(specimen, rng, settings))
    return samples


def _some(pool: Pool, wanted: int, which: int, seed: int, kept: _Kept) -> Iterable[Specimen]:
    if isinstance(pool, Files):
        rows = np.unique(np.linspace(0, len(pool.paths) - 1, wanted).round().astype(int))
        for row in rows:
            yield kept.read(pool.paths[row])
        return
    given, number = 0, 0
    while given < wanted and number < _TRIES * wanted:
        number += 1
        try:
            yield kept.make(pool, (seed, _HELD_OUT, which, number))
        except AssetFactoryError:
            continue
        given += 1


class _Kept:
    """Specimens used last.

    Args:
        most: bytes of them.
    """

    def __init__(self, most: int) -> None:
        self._most, self._bytes = most, 0
        self._specimens: OrderedDict[object, Specimen | AssetFactoryError] = OrderedDict()

    def read(self, path: Path) -> Specimen:
        return self._get(path, lambda: read_specimen(path))

    def make(self, pool: Generator, seed: tuple[int, ...]) -> Specimen:
        return self._get(seed, lambda: _made(pool, seed))

    def _get(self, key: object, get: Callable[[], Specimen]) -> Specimen:
        found = self._specimens.pop(key, None)
        if found is None:
            try:
                found = get()
            except AssetFactoryError as error:
                found = error
            self._bytes += _size(found)
        self._specimens[key] = found
        while self._bytes > self._most and len(self._specimens) > 1:
            self._bytes -= _size(self._specimens.popitem(last=False)[1])
        if isinstance(found, AssetFactoryError):
            raise found
        return found


def _size(specimen: Specimen | AssetFactoryError) -> int:
    if isinstance(specimen, AssetFactoryError):
        return 1000
    return sum(getattr(getattr(specimen, each.name), "nbytes", 100) for each in fields(specimen))


def _made(pool: Generator, seed: tuple[int, ...]) -> Specimen:
    rng = np.random.default_rng(seed)
    name, articulation = sample_object(rng, pool.style)
    return specimen_of(
        articulation,
        name=name,
        category=name.partition("-")[0],
        source="procedural",
        points=pool.source.points,
        rng=rng,
    )
