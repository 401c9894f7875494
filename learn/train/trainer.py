"""A network in training: one step of it, and its state between steps."""

from __future__ import annotations

import copy
import math
from pathlib import Path
from typing import Any

import numpy as np
import torch  # noqa: TID253 - this module is only imported to train

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.network.shape import FREQUENCIES
from asset_factory.factory.models.network.transformer import PartArticulationTransformer

from ..samples.batches import Batch
from .averaging import follow
from .checkpoints import State, fill
from .distributed import ProcessGroup
from .losses import NAMES, Counts, count, forward, losses, targets_of, taught, total
from .settings import TrainConfig

Tensor = Any
COLUMNS = ("total", *NAMES, "rate", "gradient")
_DROPOUT = 4
_MOST_MISSED = 20
"""Steps in a row whose gradients are not finite, after which a run ends."""
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
        self.mean_network = copy.deepcopy(self.network).requires_grad_(False).eval()
        self.optimiser = _optimiser(self.network, config)
        self._missed = 0
        if group.device.startswith("cuda"):
            torch.set_float32_matmul_precision("high")
            if config.run.compile:
                for block in self.network.blocks:
                    block.compile()

    def restore(self, state: State, path: Path) -> None:
        """Go back to a stored state.

        Raises:
            ConfigError: it is another network's; says that of the file at ``path``.
        """
        fill(self.mean_network, state.mean, path)
        fill(self.network, state.weights, path)
        try:
            self.optimiser.load_state_dict(state.optimiser)
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise ConfigError(f"{path}: its optimiser's state does not fit: {error}") from error

    def require_finite(self, step: int) -> None:
        """See to it that no weights are kept that are not numbers.

        Raises:
            ConfigError: some are not.
        """
        for network in (self.network, self.mean_network):
            weights = network.state_dict().items()
            bad = [name for name, each in weights if not bool(torch.isfinite(each).all())]
            if bad:
                wanted = "nothing of it is kept; want a lower schedule.rate"
                raise ConfigError(f"step {step}: {bad[0]} is not finite any more, {wanted}")

    def step(self, step: int, batch: Batch, stop: bool = False) -> tuple[Tensor, bool]:
        """Learn from this process's share of a step's samples.

        Steps count from 0, the batch is of arrays; ``stop``: this process was asked to.

        Returns:
            ``COLUMNS`` of this process's share, the sum of which over the processes is the step's,
            but for the last two, which only the first fills; and whether any was asked to stop.

        Raises:
            ConfigError: the gradients have not been finite for many steps.
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
        self.optimiser.zero_grad(set_to_none=True)
        values = torch.zeros(len(NAMES) + 1, device=group.device)
        lowered = config.run.precision == "bfloat16" and group.device.startswith("cuda")
        for each in micro:
            with torch.autocast("cuda", torch.bfloat16, enabled=lowered):
                answers = forward(self.network, each, config.loss)
            targets = targets_of(each, config.loss)
            found = losses(answers, each, targets, counts, config.loss)
            weighted = total(found, config.loss)
            weighted.backward()
            values += torch.stack([weighted.detach(), *(found[name].detach() for name in NAMES)])
        group.add_gradients(list(self.network.parameters()))
        rate = config.schedule.rate_at(step)
        norm = self._descend(step, rate)
        last = [torch.full_like(norm, rate), norm] if group.first else [torch.zeros_like(norm)] * 2
        return torch.cat([values, torch.stack(last)]), stops > 0

    def _descend(self, step: int, rate: float) -> Tensor:
        """Move the weights along the gradients, unless those are not finite; returns their norm."""
        settings = self._config.optimiser
        for each in self.optimiser.param_groups:
            each["lr"] = rate
        clip = settings.clip or math.inf
        norm = torch.nn.utils.clip_grad_norm_(self.network.parameters(), clip)
        # One bad step must not end the run: a sample may be so odd that it overflows.
        if bool(torch.isfinite(norm)):
            self.optimiser.step()
            follow(self.mean_network, self.network, settings.decay_at(step))
            self._missed = 0
        else:
            self._missed += 1
        if self._missed >= _MOST_MISSED:
            said = f"the gradients of {_MOST_MISSED} steps in a row are not finite"
            wanted = "want a lower schedule.rate, or look at the data"
            kept = "so nothing is learnt; the checkpoint is from before"
            raise ConfigError(f"step {step}: {said}, {kept}; {wanted}")
        return norm.detach()

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
