"""A network in training: one step of it, and its state between steps."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import torch  # noqa: TID253 - this module is only imported to train

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.network.shape import FREQUENCIES
from asset_factory.factory.models.network.transformer import PartArticulationTransformer

from ..samples.batches import Batch
from .descent import Descent
from .distributed import ProcessGroup
from .losses import NAMES, Counts, count, forward, losses, targets_of, taught, total
from .settings import TrainConfig

Tensor = Any
COLUMNS = ("total", *NAMES, "rate", "gradient")
_DROPOUT = 4
_SPREAD = 1000.0
_BASE = 10000.0


class Trainer:
    """A network, its optimiser and the running mean of its weights, the same in every process."""

    def __init__(self, config: TrainConfig, group: ProcessGroup) -> None:
        self._config = config
        self._group = group
        torch.manual_seed(config.seed)
        network = PartArticulationTransformer(config.network.shape, config.network.dropout)
        if config.network.quiet_start:
            quieten(network, config.network.quiet_below)
        self.network = network.to(group.device).train()
        settings = config.optimiser
        optimiser = _optimiser(self.network, config)
        self.descent = Descent(self.network, optimiser, settings.clip, settings.ema)
        with torch.device("meta"):
            self.mean_network = PartArticulationTransformer(config.network.shape)
        # It shares the running mean's tensors, so it always has the weights of the last step.
        self.mean_network.load_state_dict(self.descent.mean.weights, assign=True)
        self.mean_network.requires_grad_(False).eval()
        if group.device.startswith("cuda"):
            torch.set_float32_matmul_precision("high")
            if config.run.compile:
                for block in self.network.blocks:
                    block.compile()

    def require_finite(self, step: int) -> None:
        """See to it that no weights are kept that are not numbers.

        Raises:
            ConfigError: some are not.
        """
        for weights in (self.network.state_dict(), self.descent.mean.weights):
            bad = [name for name, each in weights.items() if not bool(torch.isfinite(each).all())]
            if bad:
                wanted = "nothing of it is kept; want a lower schedule.rate"
                raise ConfigError(f"step {step}: {bad[0]} is not finite any more, {wanted}")

    def step(self, step: int, batch: Batch, stop: bool = False) -> tuple[Tensor, bool]:
        """Learn from this process's share of a step's samples.

        Steps count from 0, the batch is of arrays; ``stop``: this process was asked to.

        Returns:
            ``COLUMNS`` of this process's share, the sum of which over the processes is the step's,
            but for the last two, which only the first fills; and whether any was asked to stop.
        """
        config = self._config
        group = self._group
        if config.network.dropout:
            self._seed_dropout(step)
        host = [
            taught(each.to("cpu"), config.loss)
            for each in batch.split(config.run.micro_batch or len(batch))
        ]
        # Counted before anything is sent to a GPU: to ask one for a number is to wait for it.
        counted = [count(each, targets_of(each, config.loss), config.loss) for each in host]
        micro = [each.to(group.device) for each in host]
        mine = [sum(column) for column in zip(*counted, strict=True)]
        *sums, stops = group.sums([*mine, float(stop)])
        counts = Counts(*sums)
        self.descent.optimiser.zero_grad(set_to_none=True)
        values = torch.zeros(len(NAMES) + 1, device=group.device)
        lowered = config.run.precision == "bfloat16" and group.device.startswith("cuda")
        for each in micro:
            with torch.autocast("cuda", torch.bfloat16, enabled=lowered):
                answers, early = forward(self.network, each, config.loss)
            targets = targets_of(each, config.loss)
            found = losses(answers, early, each, targets, counts, config.loss)
            weighted = total(found, config.loss)
            weighted.backward()
            values += torch.stack([weighted.detach(), *(found[name].detach() for name in NAMES)])
        group.add_gradients(list(self.network.parameters()))
        rate = config.schedule.rate_at(step)
        norm = self.descent.step(step, rate)
        last = [torch.full_like(norm, rate), norm] if group.first else [torch.zeros_like(norm)] * 2
        return torch.cat([values, torch.stack(last)]), stops > 0

    def _seed_dropout(self, step: int) -> None:
        seed = np.random.SeedSequence([self._config.seed, _DROPOUT, step, self._group.rank])
        torch.manual_seed(int(seed.generate_state(1, np.uint64)[0] >> np.uint64(1)))


def quieten(network: Any, below: float) -> None:
    """Make fast sinusoids' weights start small: ``below`` over their angular frequency, if less.

    Coordinates are expanded into sines and cosines of up to 1000 rad per unit of length. At first
    the fastest tell neighbouring points nothing in common; their weights would have to be unlearnt.
    ``below`` is in rad per unit of length.
    """
    frequencies = _SPREAD * torch.exp(-math.log(_BASE) * torch.arange(FREQUENCIES) / FREQUENCIES)
    factors = (below / frequencies).clamp(max=1.0)
    embeddings = [network.pos_embed, *([network.normal_embed] if network.shape.normals else [])]
    with torch.no_grad():
        for embedding in embeddings:
            # Per coordinate all sines, then all cosines; then perhaps the plain coordinates.
            embedding.mlp[0].weight[:, : 6 * FREQUENCIES] *= factors.repeat(6)


def _optimiser(network: Any, config: TrainConfig) -> Any:
    settings = config.optimiser
    matrices = [each for each in network.parameters() if each.dim() > 1]
    others = [each for each in network.parameters() if each.dim() <= 1]
    groups = [{"params": matrices}, {"params": others, "weight_decay": 0.0}]
    shared = {"betas": settings.betas, "weight_decay": settings.weight_decay}
    return torch.optim.AdamW(groups, lr=config.schedule.rate, fused=True, **shared)
