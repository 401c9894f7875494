"""Several processes that train one network: started by ``torchrun``, which numbers them."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import torch  # noqa: TID253 - this module is only imported to train

Tensor = Any


@dataclass(frozen=True)
class ProcessGroup:
    """The processes of a run: which this one is, of how many, and its device as torch names it."""

    rank: int
    world: int
    device: str

    @property
    def first(self) -> bool:
        """Return whether this process writes the files."""
        return self.rank == 0

    def sums(self, numbers: Sequence[float]) -> list[float]:
        """Return sums over the processes."""
        if self.world == 1:
            return list(numbers)
        summed = self.add(torch.tensor(numbers, dtype=torch.float64, device=self.device))
        return [float(number) for number in summed.tolist()]

    def add_gradients(self, parameters: Sequence[Tensor]) -> None:
        """Replace every gradient by its sum over the processes; losses share the step's mean."""
        if self.world == 1:
            return
        for each in parameters:
            if each.grad is None:
                each.grad = torch.zeros_like(each)
        gradients = [each.grad for each in parameters]
        flat = self.add(torch.cat([gradient.flatten() for gradient in gradients]))
        sums = flat.split([gradient.numel() for gradient in gradients])
        for gradient, summed in zip(gradients, sums, strict=True):
            gradient.copy_(summed.view_as(gradient))

    def add(self, tensor: Tensor) -> Tensor:
        """Return a tensor's sum over the processes."""
        if self.world > 1:
            torch.distributed.all_reduce(tensor)
        return tensor

    @contextmanager
    def first_alone(self) -> Iterator[None]:
        """Let the first process go through a block before the others do."""
        if not self.first:
            self.wait()
        yield
        if self.first:
            self.wait()

    def wait(self) -> None:
        """Wait until every process is here."""
        if self.world > 1:
            torch.distributed.barrier()


@contextmanager
def joined(device: str) -> Iterator[ProcessGroup]:
    """Yield the group that this process belongs to; alone where ``torchrun`` did not start it."""
    world = int(os.environ.get("WORLD_SIZE", "1"))
    rank = int(os.environ.get("RANK", "0"))
    local = int(os.environ.get("LOCAL_RANK", "0"))
    if device == "auto":
        device = "cuda" if torch.cuda.is_available() else "cpu"
    if device == "cuda":
        device = f"cuda:{local}"
    if device.startswith("cuda"):
        torch.cuda.set_device(device)
    if world == 1:
        yield ProcessGroup(0, 1, device)
        return
    torch.distributed.init_process_group("nccl" if device.startswith("cuda") else "gloo")
    try:
        yield ProcessGroup(rank, world, device)
    finally:
        torch.distributed.destroy_process_group()
