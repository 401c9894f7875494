"""Many builds: every asset in a killable process of its own, a few at a time."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from pathlib import Path

from asset_factory.sim_checks.isolation import Limits, Outcome, preload, run_isolated

from .build import build_asset, record_failure
from .config import BuildConfig
from .result import Result

#: Imported once per job instead of once per child.
COMMON_MODULES = ("scipy.spatial", "trimesh", "manifold3d", "fcl", "asset_factory.factory.build")
SAPIEN_MODULE = "asset_factory.sim_checks.simulators.warm"


def run_builds(inputs: tuple[Path, ...], output: Path, config: BuildConfig, workers: int) -> Iterator[Result]:
    """Build every input; yield results as they come.

    One input is one child process: a native crash, a hang or running out of memory costs that input its
    verdict (it is listed as unjudged) and nothing else.

    Args:
        inputs: files, as :func:`~asset_factory.factory.mesh.find_inputs` lists them.
        output: the registry's folder.
        config: of every stage.
        workers: how many at once.
    """
    preload((*COMMON_MODULES, *((SAPIEN_MODULE,) if "sapien" in config.simulators else ())))
    limits = Limits(wall_s=config.asset_wall_s, memory_bytes=config.asset_memory_bytes)
    with ThreadPoolExecutor(max_workers=workers, thread_name_prefix="build") as pool:
        pending: dict[Future[Outcome[Result]], Path] = {
            pool.submit(run_isolated, build_asset, path, output, config, limits=limits): path for path in inputs
        }
        try:
            for future in as_completed(pending):
                outcome = future.result()
                if outcome.value is not None:
                    yield outcome.value
                else:
                    yield record_failure(pending[future], output, outcome)
        finally:
            for future in pending:
                future.cancel()
