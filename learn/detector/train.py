"""Train the detector: ``python -m asset_factory.learn.detector.train PACK OUT``.

Meant for some minutes on one GPU: worker processes make objects all the while, the pool of them is
on the GPU, and everything that varies their looks happens there.
"""

from __future__ import annotations

import argparse
import copy
import json
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import torch  # noqa: TID253 - this module is only imported to train
from safetensors.torch import load_file  # noqa: TID253
from torch.nn import functional  # noqa: TID253

from asset_factory.factory.models.detector.canvas import CANVAS, KINDS
from asset_factory.factory.models.detector.network import Detector
from asset_factory.factory.models.weights.safetensors import write_safetensors
from asset_factory.factory.runtime.terminal import say

from ..train.averaging import follow
from .evaluate import evaluate
from .kinds import kind_number
from .looks import show
from .pack import Packed, read_pack, read_textures
from .sides import IGNORED, VIEW, LabelledSides
from .stream import Makers, Pool, joined
from .targets import loss_of, targets_of

#: Rates of learning: of what was trained before, and of the rest.
RATES = (5e-4, 1e-3)
#: Share of the time in which rates rise.
WARMING = 0.05
#: Of a batch: real objects, real ones made one piece, objects of descriptions, generated ones made
#: one piece; the rest is generated.
SHARES = (0.25, 0.25, 0.05, 0.12)
#: Of the workers, those that make generated objects one piece; each takes five times as long.
ONE_PIECE_WORKERS = 0.25
#: Weights that are kept follow those that learn by this share a step.
FOLLOW = 0.998
SAID_EVERY_S = 20.0
#: Finished objects that are taken over between two steps.
MOST_COLLECTED = 40


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pack", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--backbone", type=Path, help="EfficientNet-Lite0, safetensors")
    parser.add_argument("--start", type=Path, help="a checkpoint to go on from")
    parser.add_argument("--share", type=float, default=1.0, help="of the way from --start, to keep")
    parser.add_argument("--minutes", type=float, default=7.0)
    parser.add_argument("--batch", type=int, default=64)
    parser.add_argument("--workers", type=int, default=15)
    parser.add_argument("--pool", type=int, default=10_000)
    parser.add_argument("--first", type=int, default=800, help="objects to begin with")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--device", default="cuda")
    train(parser.parse_args())


def train(options: Any) -> None:
    """Train for some minutes and keep checkpoints."""
    start = time.monotonic()
    device = torch.device(options.device)
    torch.backends.cuda.matmul.allow_tf32 = True
    torch.backends.cudnn.allow_tf32 = True
    torch.manual_seed(options.seed)
    some = max(1, round(ONE_PIECE_WORKERS * options.workers))
    made = Pool(options.pool, device)
    one_piece = Pool(options.pool // 4, device)
    forming = Makers(one_piece, some, options.seed, one_piece=True)
    makers = (Makers(made, max(1, options.workers - some), options.seed), forming)
    learned, held_out = _packed(options.pack, device)
    say(f"{[each.made for each in learned]} to learn from, {[each.made for each in held_out]} not")
    network = _begun(options).to(device, memory_format=torch.channels_last)
    while made.made < options.first or one_piece.made < options.first / 16:
        for each in makers:
            each.collect(MOST_COLLECTED)
        time.sleep(0.05)
    say(f"{made.made} objects made after {time.monotonic() - start:.0f} s")
    source = Pools(
        (*learned, one_piece, made),
        torch.from_numpy(read_textures(options.pack)).to(device),
        torch.Generator(device).manual_seed(options.seed),
    )
    kept, steps = _fitted(network, source, makers, start + 60.0 * options.minutes, options)
    for each in makers:
        each.stop()
    if options.start:
        # Weights part of the way are as accurate, and more so on meshes unlike the training data
        # (Wortsman et al., Robust fine-tuning of zero-shot models, CVPR 2022).
        follow(kept, _begun(options).to(device), options.share)
    _keep(kept, options.out)
    figures: dict[str, Any] = {"steps": steps, "batch": options.batch, "made": made.made}
    figures |= {"made one piece": one_piece.made}
    named = zip(("held out", "held out, one piece"), held_out, strict=True)
    for name, pool in ((name, pool) for name, pool in named if pool.made):
        figures[name] = evaluate(kept, pool)
        say("\n".join(f"{name}: {key}: {value}" for key, value in figures[name].items()))
    (options.out / "figures.json").write_text(json.dumps(figures, indent=1))


@dataclass(frozen=True, eq=False)
class Pools:
    """Where batches come from: ``textures`` are uint8, [m, 3, size, size].

    Pools are of real, real made one piece, described, generated made one piece, generated objects.
    """

    pools: tuple[Pool, ...]
    textures: Any
    generator: Any


def _begun(options: Any) -> Any:
    """Return the network before its first step."""
    network = Detector(len(KINDS))
    if options.backbone:
        _begin(network, load_file(str(options.backbone)))
    if options.start:
        network.load_state_dict({k: v.float() for k, v in load_file(str(options.start)).items()})
    return network


def _fitted(
    network: Any, source: Pools, makers: Sequence[Makers], end: float, options: Any
) -> tuple[Any, int]:
    """Return the weights that followed those that learned until ``end``, and the steps taken."""
    kept = copy.deepcopy(network).eval()
    fresh = [p for name, p in network.named_parameters() if not name.startswith("backbone")]
    groups = [{"params": network.backbone.parameters()}, {"params": fresh}]
    optimizer = torch.optim.AdamW(groups, weight_decay=0.02)
    begun = said = time.monotonic()
    step = said_step = 0
    sums: dict[str, Any] = {}
    while (now := time.monotonic()) < end:
        done = (now - begun) / (end - begun)
        for group, rate in zip(optimizer.param_groups, RATES, strict=True):
            group["lr"] = rate * _rate(done)
        loss, terms = _loss(network, source, options.batch)
        optimizer.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(network.parameters(), 2.0)
        optimizer.step()
        follow(kept, network, min(FOLLOW, step / (step + 50.0)))
        for name, value in terms.items():
            sums[name] = sums.get(name, 0.0) + value.detach()
        for each in makers:
            each.collect(MOST_COLLECTED)
        step += 1
        if now - said > SAID_EVERY_S:
            _say(step, step - said_step, sums, now - said, source.pools[-1].made)
            said = now
            sums = {}
            said_step = step
            _keep(kept, options.out)
    return kept, step


def _keep(kept: Any, folder: Path) -> None:
    """Write the weights so far in half precision."""
    folder.mkdir(parents=True, exist_ok=True)
    state = {name: each.half() for name, each in kept.state_dict().items()}
    write_safetensors(folder / "detector.safetensors", state, {})


def _rate(done: float) -> float:
    if done < WARMING:
        return done / WARMING
    return 0.5 * (1.0 + float(torch.cos(torch.tensor(torch.pi * (done - WARMING) / (1 - WARMING)))))


def _packed(path: Path, device: Any) -> tuple[tuple[Pool, ...], tuple[Pool, ...]]:
    """Return real, real one-piece and described objects; held-out real and one-piece ones."""
    packed = list(read_pack(path))
    pools = []
    kinds = ((False, True, False), (False, True, True), (False, False, False))
    for wanted in (*kinds, (True, True, False), (True, True, True)):
        chosen = [e for e in packed if (e.held_out, e.truth.real, e.one_piece) == wanted]
        pool = Pool(len(chosen), device)
        for each in chosen:
            pool.add(_seen_through(each), each.truth)
        pools.append(pool)
    return tuple(pools[:3]), tuple(pools[3:])


def _seen_through(packed: Packed) -> LabelledSides:
    """Return an object's sides; a door is seen from behind, too, where nothing is asked."""
    table = packed.sides.table
    if packed.truth.kind != kind_number("door"):
        return packed.sides
    behind = table[table[:, VIEW] < 4].copy()
    behind[:, VIEW] = (behind[:, VIEW] + 2) % 4
    behind[:, [1, 3]] = CANVAS - behind[:, [3, 1]]
    behind[:, IGNORED] = 1.0
    return replace(packed.sides, table=np.concatenate([table, behind]))


def _begin(network: Any, weights: dict[str, Any]) -> None:
    """Take what the backbone learned from pictures; channels beside colours begin at nothing."""
    own = network.backbone.state_dict()
    stem = "stem.conv.weight"
    seen = torch.cat([weights[stem], 0.2 * own[stem][:, 3:]], 1)
    network.backbone.load_state_dict(own | weights | {stem: seen})


def _loss(network: Any, source: Pools, count: int) -> tuple[Any, dict[str, Any]]:
    """Return how far the network is from the truth on one batch, and the terms of that."""
    generator = source.generator
    counts = [round(share * count) for share in SHARES]
    counts.append(count - sum(counts))
    drawn = zip(source.pools, counts, strict=True)
    batch = joined([pool.draw(each, generator) for pool, each in drawn])
    with torch.no_grad():
        shown = show(batch, source.textures, generator)
        targets = targets_of(shown)
    on_gpu = batch.color.device.type == "cuda"
    with torch.autocast(batch.color.device.type, torch.bfloat16, enabled=on_gpu):
        answers = network(shown.cues)
    loss, terms = loss_of(answers, targets)
    terms["kind"] = 0.3 * functional.cross_entropy(answers.kind.float(), batch.whole[:, 0])
    opens = batch.whole[:, 1].float()
    terms["opens"] = 0.5 * functional.binary_cross_entropy_with_logits(answers.opens.float(), opens)
    front = functional.cross_entropy(answers.front.float(), shown.front, reduction="none")
    terms["front"] = 0.3 * (front * opens).sum() / opens.sum().clamp(min=1.0)
    return loss + terms["kind"] + terms["opens"] + terms["front"], terms


def _say(step: int, steps: int, sums: dict[str, Any], passed: float, made: int) -> None:
    terms = " ".join(f"{name} {float(value) / steps:.3f}" for name, value in sums.items())
    used = torch.cuda.max_memory_allocated() / 2**30 if torch.cuda.is_available() else 0.0
    say(f"step {step} {steps / passed:.1f}/s made {made} {used:.0f} GiB {terms}")


if __name__ == "__main__":
    main()
