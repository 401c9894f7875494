"""ManiSkill's own cabinet tasks run on a registry's assets."""

import sys
from functools import partial
from xml.etree import ElementTree

import numpy as np
import pytest
from openable_samples import HOUSEHOLD, cabinet, write_registry

from asset_factory.factory.errors import RegistryError

pytest.importorskip("mani_skill", reason="mani_skill is not installed")

BLIND = {"render_backend": "none", "sim_backend": "physx_cpu", "obs_mode": "state"}


def stock(task, household, **options):
    """A cabinet task of ManiSkill's own over a registry."""
    from mani_skill.envs.tasks.mobile_manipulation import open_cabinet_drawer

    from asset_factory.envs.stock import RegistryCabinets

    own = type(f"My{task}", (RegistryCabinets, getattr(open_cabinet_drawer, task)), {})
    return own(registry=household, **BLIND, **options)


drawers = partial(stock, "OpenCabinetDrawerEnv")
doors = partial(stock, "OpenCabinetDoorEnv")


@pytest.mark.parametrize(("make", "kinds"), [(drawers, {"cabinet"}), (doors, set(HOUSEHOLD))])
def test_the_stock_tasks_run_on_every_asset_that_has_such_a_joint(household, make, kinds):
    env = make(household)
    env.action_space.seed(0)
    assert set(env.all_model_ids) == kinds
    for name in sorted(kinds):
        env.all_model_ids = np.array([name])
        env.reset(seed=0)
        assert env._cabinets[0].name == f"{name}-0"
        for _ in range(20):
            observation, reward, *_ = env.step(env.action_space.sample())
            assert bool(np.isfinite(observation.numpy()).all())
            assert bool(np.isfinite(reward.numpy()).all())
    env.close()


def test_the_front_faces_the_stock_robot_and_an_opened_drawer_is_the_stock_success(household):
    env = drawers(household)
    env.reset(seed=0)
    low, high = env._cabinets[0].get_first_collision_mesh().bounds
    assert float(env.handle_link_positions()[0, 0]) < low[0] + 0.1 * (high[0] - low[0])
    assert float(env.agent.robot.get_qpos()[0, 0]) < -1.4
    assert not bool(env.evaluate()["success"])
    values = env.cabinet.get_qlimits()[:, :, 1]
    env.cabinet.set_qpos(values)
    env.cabinet.set_qvel(values * 0)
    assert bool(env.evaluate()["success"])
    env.close()


def test_a_joint_follows_another_at_the_ratio_of_its_file(household, monkeypatch):
    from asset_factory.envs import stock as module

    described = module.described

    def coupled(asset):
        robot = described(asset)
        movable = [each for each in robot.iter("joint") if each.get("type") != "fixed"]
        leader = movable[0].get("name")
        ElementTree.SubElement(movable[1], "mimic", joint=leader, multiplier="0.5", offset="0")
        names.extend(each.get("name") for each in movable[:2])
        return robot

    names = []
    monkeypatch.setattr(module, "described", coupled)
    import torch

    env = drawers(household, asset="cabinet")
    env.reset(seed=0)
    order = [joint.name for joint in env._cabinets[0].active_joints]
    together = [order.index(name) for name in names]
    values = env._cabinets[0].get_qpos()
    values[0, together] = torch.tensor([0.2, 0.1])
    env.cabinet.set_qpos(values)
    for _ in range(5):
        env.step(0.0 * env.action_space.sample())
    assert env._cabinets[0].get_qpos()[0, together].tolist() == pytest.approx([0.2, 0.1], abs=2e-3)
    env.close()


def test_what_has_no_such_joint_or_no_visual_called_handle_is_refused(household, tmp_path):
    with pytest.raises(RegistryError, match="prismatic"):
        drawers(household, asset="laptop")
    told = "no prismatic joint whose part carries a visual named 'handle'"
    with pytest.raises(RegistryError, match=told):
        drawers(write_registry(tmp_path, cabinet()))


@pytest.mark.full
def test_a_script_for_the_stock_task_runs_unchanged(household, tmp_path, monkeypatch):
    from asset_factory.sim_checks.processes.isolation import Limits, run_isolated

    script = tmp_path / "train.py"
    script.write_text(
        "import sys, gymnasium, mani_skill.envs\n"
        "env = gymnasium.make('OpenCabinetDoor-v1', render_backend='none', obs_mode='state')\n"
        "env.reset(seed=0)\n"
        "assert env.unwrapped._cabinets[0].name.startswith(('cabinet', 'oven'))\n"
        "open(sys.argv[2], 'w').write(sys.argv[1])\n"
    )
    said = tmp_path / "said"
    run_isolated(run_script, household, script, said, limits=Limits(wall_s=120.0)).unwrap()
    assert said.read_text() == "--seed=0"


def run_script(household, script, said):
    """Runs in a child: what ``python -m asset_factory.envs.stock`` does."""
    from asset_factory.envs.stock import main

    main([str(household), str(script), "--seed=0", str(said)])
    assert sys.argv[0] == str(script)
