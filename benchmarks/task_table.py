"""Every asset of a registry in every task: whether it begins, steps, renders and was solved.

python benchmarks/task_table.py REGISTRY [--robot panda]

A cell is one episode of the task on the asset: a reset, a hundred random steps whose observations
and rewards are all finite numbers, and a picture by the task's camera, where something here can
render. How many of the asset's joints that the task is about a robot has opened is read from what
`factory solve` wrote; it opens, so that tasks that close or set a joint have no such figure. Each
episode is run in a process that may die. One line of Markdown an asset, then one of JSON.
"""

from __future__ import annotations

import argparse
import importlib
import json
import sys
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from asset_factory.envs import TASKS
from asset_factory.envs.assets import RegisteredAsset, read_registry
from asset_factory.envs.selection import Wanted, select
from asset_factory.envs.solving.record import read_record
from asset_factory.envs.tasks.catalog import Task
from asset_factory.factory.errors import ConfigError, RegistryError
from asset_factory.factory.jobs import LocalExecutor
from asset_factory.factory.jobs.executor import Call
from asset_factory.sim_checks.processes.isolation import Limits

STEPS = 100
EPISODE_S = 300.0
#: A picture whose brightness varies by less shows nothing, of 255.
FLAT = 4.0
#: What a cell is asked, in this order.
QUESTIONS = ("reset", "step", "render")

Cell = dict[str, Any]

CLAIM = "every asset in every task"


def episode(registry: str, asset: str, task: str, robot: str) -> Cell:
    """One episode; what was not tried is ``None``. Runs in a child."""
    warnings.simplefilter("ignore")
    cell: Cell = dict.fromkeys(QUESTIONS)
    try:
        environment = made(registry, asset, task, robot, "rgb_array")
    except ConfigError:
        environment = made(registry, asset, task, robot, None)
    try:
        observation, _ = environment.reset(seed=0)
        cell["reset"] = bool(np.isfinite(observation.numpy()).all())
        environment.action_space.seed(0)
        cell["step"] = True
        for _ in range(STEPS):
            observation, reward, *_ = environment.step(environment.action_space.sample())
            cell["step"] &= bool(
                np.isfinite(observation.numpy()).all() and np.isfinite(float(reward))
            )
        if environment.render_mode is not None:
            cell["render"] = bool(environment.render()[0].cpu().numpy().std() > FLAT)
    finally:
        environment.close()
    return cell


def made(registry: str, asset: str, task: str, robot: str, render_mode: str | None) -> Any:
    """The task on one asset."""
    import gymnasium

    return gymnasium.make(
        f"asset_factory.envs:{task}",
        registry=registry,
        asset=asset,
        robot_uids=robot,
        sim_backend="physx_cpu",
        render_mode=render_mode,
    )


def about(task: Task, assets: Mapping[str, RegisteredAsset]) -> dict[str, RegisteredAsset]:
    """The assets that a task is about, each with the joints that it is about."""
    environment = getattr(
        importlib.import_module(f"asset_factory.envs.tasks.{task.module}"), task.class_name
    )
    try:
        return select(
            dict(assets),
            Wanted(joint_types=environment.joint_types, min_lever=environment.min_lever),
        )
    except RegistryError:
        return {}


def solved(registry: Path, asset: RegisteredAsset) -> dict[str, Any]:
    """Of an asset's joints: how many there are, were tried and were opened, and by which robots."""
    names = {joint.name for joint in asset.openable}
    rows = [
        row for row in read_record(registry, asset.id, asset.digest).rows if row["joint"] in names
    ]
    opened = {row["joint"]: row["robot"] for row in rows if row["solved"]}
    tried = {row["joint"] for row in rows}
    return {
        "joints": len(names),
        "tried": len(tried),
        "solved": len(opened),
        "robots": sorted(set(opened.values())),
    }


def said(cell: Cell | None) -> str:
    """A cell of the Markdown table."""
    if cell is None:
        return ""
    failed = [question for question in QUESTIONS if cell[question] is False]
    word = f"no {failed[0]}" if failed else "✓" if cell["render"] else "✓ unseen"
    word = cell.get("error") or word
    count = cell.get("solved")
    return f"{word} {count['solved']}/{count['joints']}" if count and count["tried"] else word


def table(registry: Path, robot: str) -> dict[str, dict[str, Cell]]:
    """Cells by asset and task."""
    assets = read_registry(registry)
    cells: dict[str, dict[str, Cell]] = {id: {} for id in assets}
    wanted = {task.id: about(task, assets) for task in TASKS}
    calls = [
        Call(
            f"{task.id} {id}",
            {"registry": str(registry), "asset": id, "task": task.id, "robot": robot},
        )
        for id in assets
        for task in TASKS
        if id in wanted[task.id]
    ]
    for call, outcome in LocalExecutor(1, retries=0).run(episode, calls, Limits(wall_s=EPISODE_S)):
        id = call.arguments["asset"]
        task = call.arguments["task"]
        lost: Cell = {**dict.fromkeys(QUESTIONS), "reset": False, "error": f"{outcome.failure}"}
        cell = lost if outcome.failure else outcome.unwrap()
        if task.startswith("Open"):
            cell["solved"] = solved(registry, wanted[task][id])
        cells[id][task] = cell
        print(call.name, said(cell), file=sys.stderr, flush=True)
    return cells


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "registry", type=Path, nargs="?", default=Path("out"), help="out/ by default"
    )
    parser.add_argument("--robot", default="panda", help="who resets, steps and is rendered")
    options = parser.parse_args()
    if not options.registry.is_dir():
        print(
            json.dumps(
                {
                    "claim": CLAIM,
                    "skipped": f"no registry at {options.registry}; `make demo` makes one",
                }
            )
        )
        return
    cells = table(options.registry, options.robot)
    names = [task.id for task in TASKS]
    print("| asset | " + " | ".join(f"`{name}`" for name in names) + " |")
    print("|---" * (len(names) + 1) + "|")
    for id, row in cells.items():
        print(f"| {id} | " + " | ".join(said(row.get(name)) for name in names) + " |")
    print(json.dumps({"claim": CLAIM, "robot": options.robot, "cells": cells}))


if __name__ == "__main__":
    main()
