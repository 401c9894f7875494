"""The transformer at its released size: core seconds against its matrix products alone.

Random weights, one thread.

One JSON line: per precision the core seconds per point, and how many times as long everything takes
as the same matrix products with nothing around them, and the largest memory.
``--points 102400`` is what the release asks for; the default is smaller: the cost is linear.
"""

from __future__ import annotations

import argparse
import json
import resource
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any

import numpy as np
import torch  # noqa: TID253

from asset_factory.factory.models.network.shape import NetworkShape, product_dtype
from asset_factory.factory.models.network.streaming import CHUNK
from asset_factory.factory.models.network.transformer import PartArticulationTransformer
from asset_factory.factory.models.particulate.model import Model, PointCloud

PRECISIONS = ("float32", "bfloat16")
PRODUCT_CHUNKS = 4
TRIES = 3
LARGE = 10_000
KIB_PER_GB = 1e6


def random_model(precision: str) -> Model:
    """The released size; what the weights are does not change what they cost."""
    with torch.device("meta"):
        network = PartArticulationTransformer(NetworkShape())
    network = network.to_empty(device="cpu").eval().requires_grad_(False)
    source = torch.Generator().manual_seed(0)
    for weight in network.parameters():
        weight.normal_(0.0, 0.03, generator=source)
    return Model(network.shape, product_dtype(precision), network)


def random_cloud(count: int) -> PointCloud:
    """Points with normals and features."""
    rng = np.random.default_rng(0)
    place, normal, feature = (rng.random((count, wide), dtype=np.float32) for wide in (3, 3, 448))
    return PointCloud(place - 0.5, normal, feature)


def products(shape: NetworkShape, dtype: Any) -> list[tuple[Any, Any, int]]:
    """Both sides of every product that one chunk takes part in, and how often."""
    wide = shape.hidden
    deep = shape.mlp
    parts = shape.max_parts
    mixed = shape.heads * parts
    head = wide // shape.heads

    def pair(inputs: int, outputs: int, times: int, kind: Any = dtype) -> tuple[Any, Any, int]:
        return torch.randn(CHUNK, inputs).to(kind), torch.randn(outputs, inputs).to(kind).T, times

    per_block = [
        pair(wide, wide, 2),  # keys of points, queries of points
        pair(mixed, wide, 1),  # what points get from queries
        (
            torch.randn(mixed, CHUNK).to(dtype),
            torch.randn(CHUNK, wide).to(dtype),
            1,
        ),  # what queries see in points
        (
            torch.randn(shape.heads, CHUNK, head),
            torch.randn(shape.heads, head, parts),
            2,
        ),  # logits of both
        pair(wide, deep, 2),  # value and gate
        pair(deep, wide, 1),
    ]
    once = [
        pair(shape.features, wide, 1, torch.float32),
        pair(shape.embedding, wide, 2, torch.float32),
        pair(wide, wide, 2, torch.float32),
        pair(wide, deep, 2),  # mask head and closest-point head
        pair(deep, 1, parts, torch.float32),
        pair(deep, 3, 1, torch.float32),
    ]
    return [(left, right, times * shape.blocks) for left, right, times in per_block] + once


def core_seconds(work: Any) -> float:
    """Of one call [s]."""
    started = time.process_time()
    work()
    return time.process_time() - started


@torch.inference_mode()
def products_per_point(dtype: Any) -> float:
    """Core seconds per point of the products alone."""
    pairs = products(NetworkShape(), dtype)

    def work() -> None:
        for _ in range(PRODUCT_CHUNKS):
            for left, right, times in pairs:
                for _ in range(times):
                    torch.matmul(left, right)

    work()
    return min(core_seconds(work) for _ in range(TRIES)) / (PRODUCT_CHUNKS * CHUNK)


def measure(precision: str, points: int) -> dict[str, float]:
    """Everything a build asks of the network, against its products."""
    torch.set_num_threads(1)
    model = random_model(precision)
    cloud = random_cloud(points)

    tries = range(1 if points > LARGE else 2)
    took = min(core_seconds(lambda: model.predict(cloud)) for _ in tries) / points
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / KIB_PER_GB
    alone = products_per_point(model.dtype)
    return {
        "core_ms_per_point": round(1000 * took, 3),
        "times_its_products": round(took / alone, 2),
        "peak_rss_gb": round(peak, 2),
    }


def main() -> None:
    """Measure every precision on one cloud."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=int, default=4096)
    parser.add_argument("--precision", choices=PRECISIONS, nargs="+", default=PRECISIONS)
    options = parser.parse_args()
    line: dict[str, Any] = {"benchmark": "particulate_network", "points": options.points}
    for precision in options.precision:
        # A process of its own for each, or the second one's peak would hold what the first one left
        # behind.
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as child:
            line[precision] = child.submit(measure, precision, options.points).result()
    print(json.dumps(line))


if __name__ == "__main__":
    main()
