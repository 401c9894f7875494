"""Trains the picture network of ``articulate/seams/sight.py`` on views of objects' sides."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch  # noqa: TID253 - this module is only imported to train
from torch.nn import functional  # noqa: TID253

from asset_factory.factory.articulate.seams.sight import CUES
from asset_factory.factory.runtime.terminal import say

from ..elevations.network import PictureNetwork
from ..elevations.views import UNKNOWN, SideView, read_views
from ..train.checkpoints import read_state, write_state
from ..train.descent import Descent

Tensor = Any
Arrays = dict[str, Any]
BATCH = 8
#: Files are mixed in heaps of so many, and so many are gone through before each report.
HEAP = 64
ROUND = 800
#: One in so many files is only looked at.
HELD_OUT = 25
RATE = 4e-3
WARM_UP = 100
EMA = 0.995
#: Lids and ends are few, and count for more: panel, lid, level end, upright end; so does what
#: lies at an end.
WEIGHTS = (1.0, 3.0, 3.0, 3.0)
AT_END = 3.0
WAY_WEIGHT = 0.15
#: How often a view is mirrored, loses its colours, or all light and colour.
MIRRORED = 0.5
COLOURLESS = 0.3
GREY = 0.15
_LIGHT = slice(CUES.index("light"), CUES.index("yellow") + 1)
_COLOUR = slice(CUES.index("red"), CUES.index("yellow") + 1)


def fit_sides(folder: Path, state: Path, rounds: int, seed: int) -> tuple[Arrays, str]:
    """Train on kept views; a stored training goes on where it stopped.

    Args:
        folder: of files that :func:`~asset_factory.learn.elevations.views.write_views` made.
        state: a checkpoint, written after every round; gone on from if it is there.
        rounds: of at most ``ROUND`` files; the rate of learning falls to nothing by the last.
        seed: of the order, and of the first weights.

    Returns:
        The running mean of the weights, as the articulator reads it, at half precision; and how
        well views that it did not learn from are seen.
    """
    torch.manual_seed(seed)
    network = PictureNetwork()
    optimiser = torch.optim.AdamW(network.parameters(), RATE, weight_decay=1e-3)
    descent = Descent(network, optimiser, clip=1.0, ema=EMA)
    files = sorted(folder.glob("*.npz"))
    held_out = files[::HELD_OUT]
    learned = [file for place, file in enumerate(files) if place % HELD_OUT]
    done = step = 0
    if state.is_file():
        stored = read_state(state)
        descent.restore(stored, state)
        done = int(stored.recipe)
        step = stored.step
    for number in range(done, rounds):
        rng = np.random.default_rng([seed, number])
        fall = 0.5 * (1.0 + math.cos(math.pi * number / rounds))
        network.train()
        for batch in _batches(rng.permutation(np.array(learned))[:ROUND].tolist(), rng):
            optimiser.zero_grad()
            _loss(network, *batch).backward()
            descent.step(step, RATE * fall * min(1.0, (step + 1) / WARM_UP))
            step += 1
        say(f"round {number + 1}, of views held out: {report(network, held_out)}")
        write_state(state, descent.state(step, str(number + 1)))
    network.load_state_dict(descent.mean.weights)
    # Their own normalisations are not the mean of those on the way.
    some = [Path(file) for file in learned[:ROUND]]
    torch.optim.swa_utils.update_bn((cues for cues, _, _ in _batches(some, None)), network)
    figures = report(network, held_out)
    return {name: each.astype(np.float16) for name, each in network.folded().items()}, figures


def report(network: PictureNetwork, files: Sequence[Path]) -> str:
    """Return how well panels, lids and ways are seen."""
    network.eval()
    shared = np.zeros(2)
    either = np.zeros(2)
    right = ways = 0
    with torch.no_grad():
        for cues, wanted, way in _batches(files, None):
            answer = network(cues)
            said = (answer[:, :2] > 0.0) & _seen(cues)
            true = wanted[:, :2] > 0.5
            shared += (said & true).sum(dim=(0, 2, 3)).numpy()
            either += (said | true).sum(dim=(0, 2, 3)).numpy()
            known = way < UNKNOWN
            right += int(((answer[:, 4:].argmax(dim=1) == way) & known).sum())
            ways += int(known.sum())
    panel, lid = shared / np.maximum(either, 1.0)
    return f"panel IoU {panel:.3f}, lid IoU {lid:.3f}, ways {right / max(ways, 1):.3f} right"


def _loss(network: PictureNetwork, cues: Tensor, wanted: Tensor, way: Tensor) -> Tensor:
    answer = network(cues)
    weights = _seen(cues) * torch.tensor(WEIGHTS).view(1, -1, 1, 1)
    at_end = torch.where(wanted[:, 2:] > 0.0, AT_END, 1.0)
    weights = torch.cat([weights[:, :2], weights[:, 2:] * at_end], dim=1)
    seen = functional.binary_cross_entropy_with_logits(answer[:, :4], wanted, reduction="none")
    known = way < UNKNOWN
    by_way = functional.cross_entropy(answer[:, 4:], way.clamp(max=UNKNOWN - 1), reduction="none")
    of_ways = (by_way * known).sum() / (known.sum() + 50)
    return (seen * weights).sum() / (weights.sum() + 1.0) + WAY_WEIGHT * of_ways


def _seen(cues: Tensor) -> Tensor:
    """Return which squares show anything."""
    return functional.max_pool2d(cues[:, :1], 2) > 0.0


def _batches(
    files: Sequence[Path], rng: np.random.Generator | None
) -> Iterator[tuple[Tensor, Tensor, Tensor]]:
    """Yield cues, answers and ways of views of like size; changed and mixed by ``rng``."""
    for first in range(0, len(files), HEAP):
        views = [view for file in files[first : first + HEAP] for view in read_views(file)]
        if rng is not None:
            views = [_changed(view, rng) for view in views]
        views.sort(key=lambda view: view.cues.shape)
        groups = [views[each : each + BATCH] for each in range(0, len(views), BATCH)]
        if rng is not None:
            groups = [groups[each] for each in rng.permutation(len(groups))]
        yield from (_together(group) for group in groups)


def _changed(view: SideView, rng: np.random.Generator) -> SideView:
    if rng.random() < MIRRORED:
        view = view.mirrored()
    cues = view.cues.copy()
    cues[_LIGHT] *= rng.uniform(0.7, 1.3)
    if rng.random() < COLOURLESS:
        cues[_COLOUR] = 0.0
    if rng.random() < GREY:
        cues[_LIGHT] = 0.0
    return SideView(cues, view.wanted, view.way)


def _together(views: Sequence[SideView]) -> tuple[Tensor, Tensor, Tensor]:
    rows, columns = (max(view.way.shape[axis] for view in views) for axis in (0, 1))
    cues = np.zeros((len(views), len(CUES), 2 * rows, 2 * columns), np.float32)
    wanted = np.zeros((len(views), 4, rows, columns), np.float32)
    way = np.full((len(views), rows, columns), UNKNOWN)
    for number, view in enumerate(views):
        tall, wide = view.way.shape
        cues[number, :, : 2 * tall, : 2 * wide] = view.cues
        wanted[number, :, :tall, :wide] = view.wanted
        way[number, :tall, :wide] = view.way
    return torch.from_numpy(cues), torch.from_numpy(wanted), torch.from_numpy(way)
