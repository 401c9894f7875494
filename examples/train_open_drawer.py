"""Teach a Panda to pull open one drawer, on a CPU in minutes.

pip install '.[build,sapien,particulate,learn]'
factory build --input examples/meshes --sim sapien --output out/
python examples/train_open_drawer.py --registry out/ --output policy/

PPO by ``stable_baselines3``, nothing tuned away. The success is the task's own: open by nine
tenths, and at rest when the episode ends. Read from top to bottom.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

import gymnasium  # noqa: TID253 - a script of its own
import numpy as np
import torch  # noqa: TID253
from mani_skill.utils.wrappers.gymnasium import CPUGymWrapper  # noqa: TID253
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.vec_env import SubprocVecEnv, VecNormalize

# What is asked for: arguments of the script.

parser = argparse.ArgumentParser(
    description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
)
parser.add_argument(
    "--registry", type=Path, default=Path("out"), help="what `factory build --output` wrote"
)
parser.add_argument("--category", default="cabinet", help="of the object")
parser.add_argument("--joint", default="drawer_1_slide", help="name of the drawer's joint")
parser.add_argument(
    "--steps", type=int, default=100_000, help="control steps of training, all processes together"
)
parser.add_argument(
    "--minutes", type=float, default=60.0, help="stop after so many, whatever the steps"
)
parser.add_argument("--processes", type=int, default=2, help="environments side by side")
parser.add_argument(
    "--seed", type=int, default=0, help="of the policy and of the training episodes"
)
parser.add_argument("--episodes", type=int, default=40, help="of each evaluation")
parser.add_argument(
    "--output",
    type=Path,
    default=Path("policy"),
    help="folder for the policy, the curve and figures",
)

# The task. Five decisions a second and an episode of six seconds are enough for a drawer, and
# explore four times further than ManiSkill's twenty. The hand keeps its direction; the policy moves
# it and its fingers: four numbers.

HERTZ = 5
SECONDS = 6
#: Episodes of evaluation have seeds that training does not reach.
EVALUATION_SEED = 1_000_000


class OneDrawer:
    """Makes the environment; an object, so that it can be sent to a process."""

    def __init__(self, arguments: argparse.Namespace) -> None:
        self.arguments = arguments

    def __call__(self) -> gymnasium.Env[Any, Any]:
        """Episodes run to their end: if success ended them, hovering before it would pay."""
        torch.set_num_threads(1)
        environment = gymnasium.make(
            "asset_factory.envs:OpenDrawer-v1",
            registry=self.arguments.registry,
            category=self.arguments.category,
            joint=self.arguments.joint,
            robot_uids="panda",
            control_mode="pd_ee_delta_pos",
            sim_config={"control_freq": HERTZ},
            max_episode_steps=HERTZ * SECONDS,
        )
        return CPUGymWrapper(environment, ignore_terminations=True)


# The judge: the same episodes before and after, the policy's mean action, no randomness but the
# episodes' own.


def evaluate(model: PPO, environments: VecNormalize, episodes: int) -> dict[str, float]:
    """Share of episodes that end in success, and how far the drawer is open then."""
    environments.training = False
    count = environments.num_envs
    ends: list[tuple[bool, float]] = []
    for first in range(0, episodes, count):
        environments.seed(EVALUATION_SEED + first)
        observations = environments.reset()
        for _ in range(HERTZ * SECONDS):
            actions, _ = model.predict(observations, deterministic=True)
            observations, _, _, infos = environments.step(actions)
        ends += [(bool(info["success"]), float(info["open_fraction"])) for info in infos]
    success, opened = np.mean(ends[:episodes], axis=0)
    environments.training = True
    return {"success": round(float(success), 3), "open": round(float(opened), 3)}


# The curve: what the training episodes themselves came to, exploration and all.


class Curve(BaseCallback):
    """Rows of: steps so far, share of successes, mean opening, over the episodes of one rollout."""

    def __init__(self, minutes: float) -> None:
        super().__init__()
        self.end = time.monotonic() + 60.0 * minutes
        self.rows: list[tuple[int, float, float]] = []
        self._ends: list[tuple[bool, float]] = []

    def _on_step(self) -> bool:
        for done, info in zip(self.locals["dones"], self.locals["infos"], strict=True):
            if done:
                self._ends.append((bool(info["success"]), float(info["open_fraction"])))
        return time.monotonic() < self.end

    def _on_rollout_end(self) -> None:
        success, opened = np.mean(self._ends, axis=0)
        self.rows.append((self.num_timesteps, float(success), float(opened)))
        self._ends = []
        print(
            f"{self.num_timesteps:7d} steps: success {success:.2f}, open {opened:.2f}", flush=True
        )


def draw(rows: list[tuple[int, float, float]], path: Path) -> None:
    """The learning curve as a picture."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot

    steps, success, opened = np.transpose(rows)
    figure, axes = pyplot.subplots(figsize=(5.0, 3.0), dpi=100)
    axes.plot(steps, opened, label="mean opening")
    axes.plot(steps, success, label="success")
    axes.set(xlabel="control steps", ylabel="share", ylim=(0.0, 1.0), xlim=(0, steps[-1]))
    axes.legend(frameon=False, loc="upper left")
    figure.tight_layout()
    figure.savefig(path, metadata={"Software": None})


# The learning.


def main() -> None:
    """Evaluate, train, evaluate, and say what it brought."""
    arguments = parser.parse_args()
    torch.set_num_threads(1)
    environments = VecNormalize(
        SubprocVecEnv([OneDrawer(arguments)] * arguments.processes), norm_reward=False
    )
    environments.seed(arguments.seed)
    model = PPO(
        "MlpPolicy",
        environments,
        n_steps=1500 // arguments.processes,
        batch_size=150,
        n_epochs=10,
        learning_rate=5e-4,
        gamma=0.95,
        gae_lambda=0.9,
        target_kl=0.05,
        policy_kwargs={"net_arch": [128, 128], "log_std_init": -0.5},
        seed=arguments.seed,
        device="cpu",
    )
    before = evaluate(model, environments, arguments.episodes)
    print("before:", before, flush=True)
    environments.seed(arguments.seed)
    curve = Curve(arguments.minutes)
    started = time.perf_counter()
    model.learn(arguments.steps, callback=curve)
    minutes = round((time.perf_counter() - started) / 60.0, 1)
    after = evaluate(model, environments, arguments.episodes)

    arguments.output.mkdir(parents=True, exist_ok=True)
    model.save(arguments.output / "policy.zip")
    environments.save(str(arguments.output / "normalisation.pkl"))
    draw(curve.rows, arguments.output / "curve.png")
    said = {
        "before": before,
        "after": after,
        "episodes": arguments.episodes,
        "steps": model.num_timesteps,
    }
    (arguments.output / "result.json").write_text(
        json.dumps(said | {"curve": curve.rows}), encoding="utf-8"
    )
    print(json.dumps(said | {"minutes": minutes}))
    environments.close()


if __name__ == "__main__":
    main()
