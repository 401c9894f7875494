"""How fast the tasks step and begin anew, beside ManiSkill's own; one JSON line a claim.

python benchmarks/task_speed.py [REGISTRY [ASSET]]

Without a registry a generated cabinet and a microwave are made first.

1. OpenDrawer-v1 with a Fetch against ManiSkill's OpenCabinetDrawer-v1 on the same asset, its
   collision shapes the hulls of the visible pieces, as without convex decomposition.
2. OpenDrawer-v1 with a Panda against PickCube-v1.
3. A new episode: on the same asset, on another whose files were read before, and the first of all.

Times are of the processor, so that a busy machine changes little; random actions, state
observations. A contact pair is two bodies that touch, or nearly so, at the end of a control step.
"""

from __future__ import annotations

import json
import statistics
import sys
import tempfile
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import gymnasium  # noqa: TID253 - a script of its own
import numpy as np

from asset_factory.envs import stock
from asset_factory.envs.assets import RegisteredAsset
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.export import export_bundle
from asset_factory.factory.intake.intake import Intake, Provenance
from asset_factory.factory.manufacture.plan import Plan
from asset_factory.factory.manufacture.stage import manufacture, with_targets
from asset_factory.factory.runtime.stages import Stages
from asset_factory.factory.runtime.store import Store
from asset_factory.learn.objects import make_object

WARM_STEPS = 20
STEPS = 200
RESETS = 3
ROUNDS = 3
MODE = {"obs_mode": "state", "sim_backend": "physx_cpu", "control_mode": "pd_joint_delta_pos"}


def generated(root: Path) -> Path:
    """A registry of two generated objects, made as a build does, without the judging."""
    stages = Stages(BuildConfig(), Store(root / ".cache"))
    for category in ("cabinet", "microwave"):
        articulation = make_object(category, seed=0)
        mesh = articulation.mesh
        source = Provenance(f"{category}.glb", "0" * 64, category=category)
        intake = Intake(category, mesh, np.arange(len(mesh.faces)), np.eye(4), source)
        asset, _ = manufacture(articulation, Plan(), intake, stages)
        export_bundle(with_targets(asset, stages), source, root / "assets" / category)
    return root


def raw_hulls(asset: RegisteredAsset) -> ElementTree.Element:
    """An asset's stock description with the hulls of each link's visuals as collision shapes."""
    robot = stock.described(asset)
    for link in robot.iter("link"):
        for collision in link.findall("collision"):
            link.remove(collision)
        for visual in link.findall("visual"):
            copied = ElementTree.SubElement(link, "collision")
            copied.extend(child for child in visual if child.tag in ("origin", "geometry"))
    return robot


def stock_scene(
    registry: Path, asset: str, describe: Callable[[RegisteredAsset], ElementTree.Element]
) -> Any:
    """OpenCabinetDrawer-v1 on one asset, described in one way."""
    from mani_skill.envs.tasks.mobile_manipulation.open_cabinet_drawer import OpenCabinetDrawerEnv

    class Scene(stock.RegistryCabinets, OpenCabinetDrawerEnv):  # type: ignore[misc]
        """The stock task on one asset."""

        def __init__(self, **options: Any) -> None:
            super().__init__(registry=registry, asset=asset, **options)

        described = staticmethod(describe)

    return Scene(render_backend="none", reconfiguration_freq=0, **MODE)


def pairs(environment: Any) -> int:
    """How many pairs of bodies touch."""
    contacts = environment.unwrapped.scene.get_contacts()
    return len({frozenset(id(body) for body in contact.bodies) for contact in contacts})


def stepping(environments: dict[str, Any]) -> dict[str, dict[str, float]]:
    """Steps a second and contact pairs of several environments in turn; medians of the rounds."""
    seconds: dict[str, list[float]] = {name: [] for name in environments}
    touching: dict[str, list[int]] = {name: [] for name in environments}
    for turn in range(ROUNDS):
        for name, environment in environments.items():
            environment.reset(seed=turn)
            environment.action_space.seed(turn)
            for _ in range(WARM_STEPS):
                environment.step(environment.action_space.sample())
            spent = 0.0
            for _ in range(STEPS):
                action = environment.action_space.sample()
                started = time.process_time()
                environment.step(action)
                spent += time.process_time() - started
                touching[name].append(pairs(environment))
            seconds[name].append(spent / STEPS)
    said = {}
    for name in environments:
        step = statistics.median(seconds[name])
        count = statistics.fmean(touching[name])
        said[name] = {"steps_per_s": round(1.0 / step, 1), "contact_pairs": round(count, 2)}
        said[name]["us_per_pair"] = round(1e6 * step / max(count, 1.0), 1)
    return said


def ratios(said: dict[str, dict[str, float]], ours: str, theirs: str) -> dict[str, float]:
    """Our time a step over theirs, and the same per contact pair; below 1 is faster."""
    return {
        "time": round(said[theirs]["steps_per_s"] / said[ours]["steps_per_s"], 2),
        "time_per_pair": round(said[ours]["us_per_pair"] / said[theirs]["us_per_pair"], 2),
    }


def resetting(registry: Path, asset: str) -> dict[str, float]:
    """Processor time of a new episode [s]: medians, and the worst."""
    alone = gymnasium.make(
        "asset_factory.envs:OpenJoint-v1", registry=registry, asset=asset, **MODE
    )
    among = gymnasium.make("asset_factory.envs:OpenJoint-v1", registry=registry, **MODE)
    names = list(among.unwrapped._assets)
    first = [_seconds(among, {"asset": name}) for name in names]
    again = [_seconds(among, {"asset": name}) for name in names * RESETS]
    same = [_seconds(alone, {}) for _ in range(RESETS * len(names))]
    for environment in (alone, among):
        environment.close()
    return {
        "same_asset_s": round(statistics.median(same), 4),
        "another_asset_s": round(statistics.median(again), 3),
        "another_asset_worst_s": round(max(again), 3),
        "asset_seen_first_s": round(statistics.median(first), 3),
        "asset_seen_first_worst_s": round(max(first), 3),
    }


def _seconds(environment: Any, options: dict[str, Any]) -> float:
    started = time.process_time()
    environment.reset(options=options)
    return time.process_time() - started


def main(registry: Path, asset: str | None) -> None:
    """Print the three lines."""
    warnings.simplefilter("ignore")
    drawer = {"registry": registry, "asset": asset, **MODE}
    ours = gymnasium.make("asset_factory.envs:OpenDrawer-v1", robot_uids="fetch", **drawer)
    ours.reset(seed=0)
    asset = str(ours.unwrapped.asset_record.id)
    drawer["asset"] = asset
    scenes = {
        "ours": ours,
        "raw_hulls": stock_scene(registry, asset, raw_hulls),
        "stock": stock_scene(registry, asset, stock.described),
    }
    said = stepping(scenes)
    claim = {"claim": "step beside OpenCabinetDrawer", "asset": asset, "robot": "fetch"}
    print(json.dumps(claim | said | {"ratio": ratios(said, "ours", "raw_hulls")}), flush=True)

    ours = gymnasium.make("asset_factory.envs:OpenDrawer-v1", robot_uids="panda", **drawer)
    with stock.unpainted():
        cube = gymnasium.make("PickCube-v1", render_backend="none", **MODE)
    said = stepping({"ours": ours, "pick_cube": cube})
    claim = {"claim": "step beside PickCube-v1", "asset": asset, "robot": "panda"}
    print(json.dumps(claim | said | {"ratio": ratios(said, "ours", "pick_cube")}), flush=True)
    print(
        json.dumps(
            {"claim": "reset under a second", "robot": "panda", **resetting(registry, asset)}
        ),
        flush=True,
    )


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]), sys.argv[2] if len(sys.argv) > 2 else None)
    else:
        with tempfile.TemporaryDirectory() as scratch:
            main(generated(Path(scratch)), None)
