"""A run from its first step, or from where it was cut off, to its last."""

from __future__ import annotations

import ctypes
import json
import signal
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

import torch  # noqa: TID253 - this module is only imported to train

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.network.shape import expected_tensors, parameter_count
from asset_factory.factory.models.weights.safetensors import write_safetensors
from asset_factory.factory.registry.claims import claim
from asset_factory.factory.runtime.store import write_whole

from .checkpoints import BEST, LAST, State, fill, read_state, read_weights, write_state
from .curves import Curve, draw_curves, require_plotting
from .data_loader import DataLoader
from .dataset import digest, find_pools, held_out_samples, source_counts, source_lines
from .distributed import ProcessGroup, joined
from .progress import Watch, watching
from .recipes import parse_train_config
from .settings import TrainConfig
from .trainer import COLUMNS, Trainer
from .validation import Scores, validate

RECIPE = "config.toml"
CURVE = "curves.csv"
VALIDATION = "validation.csv"
MODEL = "model.safetensors"
PICTURE = "curves.png"
CARD = "card.json"
_FREE = ("run", "held_out", "validation")
"""Settings that may change when a run goes on: they do not change what it learns."""


def run_training(
    config: TrainConfig, recipe: str, output: Path, *, resume: bool, start: Path | None
) -> bool:
    """Train a network, and leave everything about it in a folder; returns whether it is done.

    That is weights, checkpoints, curves, a card with figures, and the ``recipe``: the TOML that
    ``config`` was read from. ``resume`` goes on with the run that is there; ``start`` are weights
    to begin with, for a run on other data.

    Raises:
        ConfigError: the folder holds a run and ``resume`` is not asked for, or the other way round;
            the run there has another recipe; another process trains there; the data cannot be read;
            or the network learns nothing any more, as its gradients are not finite.
        OSError: the folder cannot be written to.
    """
    if config.run.threads:
        torch.set_num_threads(config.run.threads)
    _keep_freed_memory()
    with joined(config.run.device) as group, ExitStack() as stack:
        state = _prepare(config, output, resume, group, stack)
        return _Run(config, recipe, output, group).go(state, start)


class _Run:
    """What a run needs beside its trainer."""

    def __init__(self, config: TrainConfig, recipe: str, output: Path, group: ProcessGroup) -> None:
        self._config = config
        self._recipe = recipe
        self._output = output
        self._group = group
        cache = Path(config.run.cache) if config.run.cache else output / "sampled"
        # The first process converts what needs it; the others then find it converted.
        with group.first_alone():
            self._pools = find_pools(config.data, cache)
            self._held_out_pools = find_pools(config.held_out, cache)
        self._data = digest(self._pools)
        self._held_out = held_out_samples(config, self._held_out_pools) if group.first else []
        self._trainer = Trainer(config, group)
        self._best: tuple[float, int] | None = None
        self._scores: Scores | None = None
        self._seconds = 0.0
        self._since = time.monotonic()

    def go(self, state: State | None, start: Path | None) -> bool:
        config = self._config
        group = self._group
        if state is not None:
            self._trainer.restore(state, self._output / LAST)
            self._best = state.best
            self._seconds = state.seconds
        elif start is not None:
            weights = read_weights(start)
            for network in (self._trainer.network, self._trainer.mean_network):
                fill(network, weights, start)
            if group.first:
                # Resumed before its first checkpoint, a run would begin with random weights.
                write_state(self._output / LAST, self._state(0))
        if group.first and not (self._output / RECIPE).is_file():
            # After data and weights are found: what cannot begin leaves no run to go on with.
            write_whole(self._output / RECIPE, self._recipe.encode())
        first = 0 if state is None else state.step
        steps = config.schedule.steps
        if group.first:
            self._curve = Curve(self._output / CURVE, COLUMNS, first)
            scores = [each.name for each in fields(Scores)]
            self._table = Curve(self._output / VALIDATION, scores, first)
        with watching(steps, first, config.batch, quiet=not group.first) as watch:
            for line in source_lines((*self._pools, *self._held_out_pools)):
                watch.say(line)
            if state is not None and state.data != self._data:
                said = "the data are not those that this run began with"
                watch.say(f"{said}: its curve will not repeat exactly")
            finished = first >= steps or self._steps(first, watch)
            if finished and group.first:
                self._finish(watch)
        group.wait()
        return finished

    def _steps(self, first: int, watch: Watch) -> bool:
        """Run steps until the last or until stopped; returns whether the last is done."""
        config = self._config
        group = self._group
        pending: list[tuple[int, Any]] = []
        loading = DataLoader(config, self._pools, first, group.rank, group.world, watch.say)
        with _asked_to_stop() as asked, loading as loader:
            for step in range(first, config.schedule.steps):
                began = time.monotonic()
                batch = loader.batch(step)
                watch.waited(time.monotonic() - began)
                values, stop = self._trainer.step(step, batch, bool(asked))
                done = step + 1
                pending.append((done, values))
                last = done == config.schedule.steps
                saving = last or stop or done % config.run.checkpoint_every == 0
                every = config.run.validate_every
                scoring = last or (every > 0 and done % every == 0)
                if saving or scoring or done % config.run.log_every == 0:
                    self._log(pending, watch)
                    pending = []
                if saving or scoring:
                    self._trainer.require_finite(done)
                if scoring and group.first:
                    self._score(done, watch)
                if (saving or scoring) and group.first:
                    self._save(done)
                if stop and not last:
                    watch.say(f"stopped after step {done}; --resume goes on")
                    return False
        return True

    def _log(self, pending: list[tuple[int, Any]], watch: Watch) -> None:
        values = self._group.add(torch.stack([each for _, each in pending])).tolist()
        if self._group.first:
            self._curve.add([(step, row) for (step, _), row in zip(pending, values, strict=True)])
        loss = sum(row[0] for row in values) / len(values)
        watch.stepped(pending[-1][0], loss, values[-1][COLUMNS.index("rate")])

    def _score(self, step: int, watch: Watch) -> None:
        scores = self._validated()
        if scores is None:
            return
        self._scores = scores
        figures = asdict(scores)
        self._table.add([(step, list(figures.values()))])
        said = ", ".join(f"{name} {value:.3f}" for name, value in figures.items())
        watch.say(f"step {step}  held out: {said}")
        if self._best is None or scores.part_iou > self._best[0]:
            self._best = (scores.part_iou, step)
            write_state(self._output / BEST, self._state(step))

    def _validated(self) -> Scores | None:
        """Return the scores of the mean weights; ``None`` where nothing is held out."""
        if not self._held_out:
            return None
        network = self._trainer.mean_network
        return validate(network, self._held_out, self._config, self._group.device)

    def _save(self, step: int) -> None:
        half = self._config.half
        weights = self._trainer.mean_network.state_dict()
        kept = {name: each.half() if half else each.float() for name, each in weights.items()}
        # The checkpoint last: cut off in between, the run goes on from the one before.
        write_safetensors(self._output / MODEL, kept, self._about(step))
        write_state(self._output / LAST, self._state(step))

    def _state(self, step: int) -> State:
        seconds = self._seconds + time.monotonic() - self._since
        trainer = self._trainer
        learned = (trainer.network, trainer.mean_network, trainer.optimiser)
        weights, mean, optimiser = (each.state_dict() for each in learned)
        return State(step, weights, mean, optimiser, self._best, self._data, seconds)

    def _about(self, step: int) -> dict[str, str]:
        config = self._config
        return {
            "network": "Part Articulation Transformer",
            "recipe": config.recipe,
            "features": config.network.features,
            "max_parts": str(config.network.max_parts),
            "axes": "upright" if config.loss.upright_axes else "opening",
            "terms": config.terms,
            "data": self._data,
            "seed": str(config.seed),
            "steps": str(step),
        }

    def _finish(self, watch: Watch) -> None:
        """Write the picture and the card, of a run that is at its end."""
        config = self._config
        output = self._output
        scores = self._scores or self._validated()
        draw_curves(output / CURVE, output / VALIDATION, output / PICTURE)
        card = {
            **self._about(config.schedule.steps),
            "parameters": parameter_count(expected_tensors(config.network.shape)),
            "samples": config.schedule.steps * config.batch,
            "sources": source_counts(self._pools),
            "seconds": round(self._state(config.schedule.steps).seconds),
            "processes": self._group.world,
            "device": self._group.device,
            "held_out_examples": len(self._held_out),
            "held_out": scores and asdict(scores),
            "best": self._best and dict(zip(("part_iou", "step"), self._best, strict=True)),
        }
        write_whole(output / CARD, (json.dumps(card, indent=2) + "\n").encode())
        watch.say(f"the weights are in {output / MODEL}")


def _prepare(
    config: TrainConfig, output: Path, resume: bool, group: ProcessGroup, stack: ExitStack
) -> State | None:
    """Make the folder, or find the run in it, and lock it; returns the state to go on from."""
    require_plotting()
    # Every process looks before the first one writes.
    there = (output / LAST).is_file()
    begun = (output / RECIPE).is_file()
    group.wait()
    if begun and not resume:
        wanted = "go on with --resume, or name another folder"
        raise ConfigError(f"{output}: holds a run already; {wanted}")
    if not begun and resume:
        raise ConfigError(f"{output}: holds no run to go on with; leave --resume out to begin one")
    if group.first:
        # Held against every other training until this process ends.
        held = claim(output, ".lock")
        if held is None:
            wanted = "wait for it, or name another folder"
            raise ConfigError(f"{output}: another process is training there; {wanted}")
        stack.callback(held.close)
        for left in output.glob(".writing-*"):
            left.unlink()
    group.wait()
    if not begun:
        return None
    _require_same(config, (output / RECIPE).read_text(encoding="utf-8"), output)
    return read_state(output / LAST) if there else None


def _require_same(config: TrainConfig, stored: str, output: Path) -> None:
    before = asdict(parse_train_config(stored, str(output / RECIPE)))
    for section, new in asdict(config).items():
        old = before[section]
        if section in _FREE or old == new:
            continue
        changed = section
        if isinstance(old, dict):
            changed = ", ".join(f"{section}.{name}" for name in old if old[name] != new[name])
        other = "or begin another run from its weights with --from"
        said = f"the run there has another {changed}; go on with its own {RECIPE}"
        raise ConfigError(f"{output}: {said}, {other}")


@contextmanager
def _asked_to_stop() -> Iterator[list[int]]:
    """Yield a list that fills when the process is interrupted; a second time ends it."""
    asked: list[int] = []

    def note(number: int, _frame: Any) -> None:
        asked.append(number)
        signal.signal(signal.SIGINT, signal.default_int_handler)

    before = {number: signal.signal(number, note) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield asked
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _keep_freed_memory() -> None:
    """Have the C library keep the arrays of a step for the next one.

    By default glibc gives large ones back, and the system clears every page: a tenth of a step.
    """
    try:
        adjust = ctypes.CDLL(None).mallopt
    except (AttributeError, OSError, TypeError):
        return
    trim_threshold = -1
    mmap_threshold = -3
    adjust(mmap_threshold, 1 << 30)
    adjust(trim_threshold, (1 << 31) - 1)
