"""Objects made by worker processes while training runs, and the pool that it draws from."""

from __future__ import annotations

from dataclasses import astuple, fields
from queue import Empty
from typing import Any

import numpy as np
import torch  # noqa: TID253 - this module is only imported to train

from asset_factory.factory.models.detector.canvas import CANVAS, OPENING, SIDES

from .looks import ObjectBatch
from .sides import COLUMNS, IGNORED, SORT, LabelledSides, WholeTruth

#: Rows of a table; objects with more are left out.
MOST = 48
_SHAPE = (len(SIDES), CANVAS, CANVAS)
#: Shape and type of all that is kept of an object: colours, depths, parts, table, whole truth.
_KEPT = (
    ((*_SHAPE, 3), torch.uint8), (_SHAPE, torch.int16), (_SHAPE, torch.uint8),
    ((MOST, COLUMNS), torch.float32), ((4,), torch.long),
)  # fmt: skip
#: Objects that wait between the workers and the pool.
SLOTS = 96


class Pool:
    """So many objects on the training device; the oldest make way for new ones."""

    def __init__(self, size: int, device: Any) -> None:
        self.size = size
        self.device = device
        self.kept = [torch.zeros((size, *s), dtype=kind, device=device) for s, kind in _KEPT]
        self.made = 0

    def add(self, sides: LabelledSides, truth: WholeTruth) -> None:
        """Put an object in the place of the oldest; one with too many rows is left out."""
        if len(sides.table) > MOST:
            return
        rows = np.full((MOST, COLUMNS), -1.0, np.float32)
        rows[: len(sides.table)] = sides.table
        shown = (sides.color, sides.depth, sides.part, rows, astuple(truth))
        for kept, given in zip(self.kept, shown, strict=True):
            kept[self.made % self.size].copy_(torch.from_numpy(np.array(given)))
        self.made += 1

    def draw(self, count: int, generator: Any) -> ObjectBatch:
        """Return so many objects."""
        filled = min(self.made, self.size)
        chosen = torch.randint(filled, (count,), generator=generator, device=self.device)
        return self.take(chosen)

    def take(self, chosen: Any) -> ObjectBatch:
        """Return the objects at these places."""
        return ObjectBatch(*(kept[chosen] for kept in self.kept))


def joined(batches: list[ObjectBatch]) -> ObjectBatch:
    """Return several batches as one."""
    columns = ([getattr(batch, each.name) for batch in batches] for each in fields(ObjectBatch))
    return ObjectBatch(*map(torch.cat, columns))


class Makers:
    """Worker processes that make objects into a pool until they are stopped.

    With ``one_piece`` objects are made one piece, as image-to-3D tools give them.
    """

    def __init__(self, pool: Pool, workers: int, seed: int, one_piece: bool = False) -> None:
        context = torch.multiprocessing.get_context("spawn")
        pictures = (torch.zeros((SLOTS, *shape), dtype=kind) for shape, kind in _KEPT[:3])
        self.slots = [each.share_memory_() for each in pictures]
        self.free = context.Queue()
        self.ready = context.Queue()
        self.pool = pool
        for slot in range(SLOTS):
            self.free.put(slot)
        self.workers = []
        for number in range(workers):
            given = (self.slots, self.free, self.ready, seed, number, one_piece)
            self.workers.append(context.Process(target=make_into, args=given, daemon=True))
            self.workers[-1].start()

    def collect(self, most: int) -> None:
        """Put at most so many finished objects into the pool; no thread does, it would hinder."""
        for _ in range(most):
            try:
                slot, table, truth = self.ready.get_nowait()
            except Empty:
                return
            color, depth, part = (each[slot].numpy() for each in self.slots)
            self.pool.add(LabelledSides(color, depth, part, table), truth)
            self.free.put(slot)

    def stop(self) -> None:
        """End the workers; nothing can be collected any more, it may be half an object."""
        for worker in self.workers:
            worker.kill()


def make_into(slots: Any, free: Any, ready: Any, seed: int, number: int, one_piece: bool) -> None:
    """Make objects for ever; runs in a worker process."""
    from .drawn import drawn_one_piece, drawn_sides
    from .kinds import kind_number

    torch.set_num_threads(1)
    rng = np.random.default_rng([seed, number, int(one_piece)])
    drawn = drawn_one_piece if one_piece else drawn_sides
    while True:
        kind, sides = drawn(rng)
        slot = free.get()
        shown = (sides.color, sides.depth, sides.part)
        for pictures, given in zip(slots, shown, strict=True):
            pictures.numpy()[slot] = given
        table = sides.table
        moving = table[(table[:, IGNORED] == 0.0) & (table[:, SORT] < OPENING)]
        ready.put((slot, table, WholeTruth(kind_number(kind), bool(len(moving)), 0, False)))
