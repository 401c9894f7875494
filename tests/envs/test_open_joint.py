"""OpenJoint-v1: resets closed, reports what was opened, and keeps still what nobody touches."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from openable_samples import cabinet, oven, train, valve, write_registry

from asset_factory.factory.errors import RegistryError
from asset_factory.factory.export import export_bundle
from asset_factory.factory.mesh.intake import Provenance
from asset_factory.sim_checks.isolation import Limits, run_isolated

pytest.importorskip("mani_skill", reason="mani_skill is not installed")
pytestmark = [
    pytest.mark.filterwarnings("ignore:Failed to find system libvulkan:UserWarning"),
    pytest.mark.filterwarnings("ignore:__array_wrap__ must accept context:DeprecationWarning"),
]
HEADLESS = {"obs_mode": "state", "sim_backend": "physx_cpu", "render_backend": "none"}
NO_RENDERER = ("rendering device", "IncompatibleDriver", "physical device")


def make(registry: Path, **options: Any) -> Any:
    import gymnasium

    return gymnasium.make("asset_factory.envs:OpenJoint-v1", registry=registry, **{**HEADLESS, **options})


@pytest.fixture(scope="module")
def registry(tmp_path_factory) -> Path:
    return write_registry(tmp_path_factory.mktemp("registry"), cabinet(), oven(), valve())


@pytest.fixture(scope="module")
def one(registry):
    """One environment of the cabinet alone, shared by the tests that only reset it."""
    env = make(registry, asset="cabinet")
    yield env
    env.close()


def put(env: Any, joint: str, value: float) -> dict[str, Any]:
    """Set one joint, at rest, and judge."""
    task = env.unwrapped
    values = task.asset.get_qpos().clone()
    values[:, [j.name for j in task.asset.active_joints].index(joint)] = value
    task.asset.set_qpos(values)
    task.asset.set_qvel(values * 0)
    return task.evaluate()


def test_it_is_made_by_name_after_importing_the_package(registry) -> None:
    import gymnasium

    import asset_factory.envs  # noqa: F401

    env = gymnasium.make("OpenJoint-v1", registry=registry, asset="cabinet", **HEADLESS)
    assert env.spec.max_episode_steps == 200 or env.get_wrapper_attr("_max_episode_steps") == 200
    env.close()


def test_an_episode_starts_closed_and_its_observation_fits_the_space(one) -> None:
    observation, info = one.reset(seed=0)
    assert one.observation_space.contains(observation.numpy())
    assert float(info["open_fraction"]) == 0.0
    assert not bool(info["success"])


def test_two_hundred_random_steps_bring_no_nan(one) -> None:
    one.reset(seed=0)
    one.action_space.seed(0)
    for _ in range(200):
        observation, reward, *_ = one.step(one.action_space.sample())
        assert bool(np.isfinite(observation.numpy()).all())
        assert bool(np.isfinite(reward.numpy()).all())


@pytest.mark.parametrize(("joint", "closed", "opened"), [("hinge", 1.43, 1.45), ("slide", 0.268, 0.272)])
def test_success_is_nine_tenths_of_the_range(one, joint: str, closed: float, opened: float) -> None:
    one.reset(seed=0, options={"joint": joint})
    assert not bool(put(one, joint, closed)["success"])
    assert bool(put(one, joint, opened)["success"])


def test_a_door_that_is_still_swinging_is_no_success(one) -> None:
    one.reset(seed=0, options={"joint": "hinge"})
    put(one, "hinge", 1.5)
    one.unwrapped.asset.set_qvel(np.array([[3.0, 0.0]], dtype=np.float32))
    judged = one.unwrapped.evaluate()
    assert bool(judged["open_enough"])
    assert not bool(judged["success"])


def test_opening_another_joint_is_no_success(one) -> None:
    one.reset(seed=0, options={"joint": "hinge"})
    assert not bool(put(one, "slide", 0.3)["success"])


def test_reward_grows_with_opening_and_is_highest_at_success(one) -> None:
    one.reset(seed=0, options={"joint": "slide"})
    task = one.unwrapped
    rewards = [float(task.compute_dense_reward(None, None, put(one, "slide", v))) for v in (0.0, 0.1, 0.2, 0.3)]
    assert rewards == sorted(rewards)
    assert rewards[-1] == 5.0


def test_the_same_seed_gives_the_same_episode_and_another_seed_another(registry) -> None:
    env = make(registry)
    episodes = []
    for seed in (1, 1, 0, 2, 4):
        first, _ = env.reset(seed=seed)
        later = [env.step(np.full(env.action_space.shape, 0.1, dtype=np.float32))[0] for _ in range(3)]
        episodes.append((env.unwrapped.asset_record.id, np.concatenate([o.numpy() for o in (first, *later)], axis=1)))
    env.close()
    assert episodes[0][0] == episodes[1][0]
    assert np.array_equal(episodes[0][1], episodes[1][1])
    assert any(not np.array_equal(episodes[0][1], other) for _, other in episodes[2:])
    assert len({asset for asset, _ in episodes}) > 1


def test_options_decide_asset_and_joint_for_one_episode(one) -> None:
    task = one.unwrapped
    for name in ("slide", "hinge"):
        one.reset(options={"joint": name})
        assert task.target.name == name
    one.reset(options={"asset": "oven"})
    assert (task.asset_record.id, task.target.name) == ("oven", "door")
    one.reset()
    assert task.asset_record.id == "cabinet"


def test_unknown_names_are_refused_with_those_there_are(one, registry, tmp_path) -> None:
    with pytest.raises(RegistryError, match="no asset 'fridge' to open; there are 'cabinet', 'oven', 'valve'"):
        one.reset(options={"asset": "fridge"})
    with pytest.raises(RegistryError, match="no joint 'lid' to open; there are 'hinge', 'slide'"):
        one.reset(options={"joint": "lid"})
    with pytest.raises(RegistryError, match="no registry here"):
        make(tmp_path)
    with pytest.raises(RegistryError, match="no joint 'lid'"):
        make(registry, joint="lid")


def test_an_oven_door_stays_closed_by_itself_and_opens_below_the_floor_line(registry) -> None:
    env = make(registry, asset="oven", robot_uids="none")
    env.reset(seed=0)
    for _ in range(40):
        _, _, _, _, info = env.step(None)
    assert abs(float(info["open_fraction"])) < 0.01
    put(env, "door", 1.5)
    for _ in range(20):
        _, _, _, _, info = env.step(None)
    assert float(info["open_fraction"]) > 0.99
    env.close()


@pytest.mark.parametrize(("share", "moves"), [(0.9, False), (1.5, True)])
def test_a_drawer_moves_only_beyond_the_friction_its_manifest_states(registry, share: float, moves: bool) -> None:
    env = make(registry, asset="cabinet", joint="slide", robot_uids="none")
    env.reset(seed=0)
    task = env.unwrapped
    friction = task.asset_record.movable["slide"]["friction"]
    for _ in range(10):
        task.asset.set_qf(np.array([[0.0, share * friction]], dtype=np.float32))
        env.step(None)
    assert (float(task.open_fraction()) > 0.05) is moves
    env.close()


def test_a_pushed_drawer_slows_down_as_its_damping_says(registry) -> None:
    env = make(registry, asset="cabinet", joint="slide", robot_uids="none")
    env.reset(seed=0)
    task = env.unwrapped
    data = task.asset_record.movable["slide"]
    for joint in task.asset.active_joints:
        joint.set_drive_properties(0.0, 0.0)
    task.asset.set_qvel(np.array([[0.0, 0.2]], dtype=np.float32))
    env.step(None)
    expected = 0.2 * np.exp(-data["damping"] / data["inertia"] / task.control_freq)
    assert float(task.asset.get_qvel()[0, 1]) == pytest.approx(expected, rel=0.02)
    env.close()


def test_parts_of_one_asset_push_each_other(tmp_path) -> None:
    env = make(write_registry(tmp_path, train()), joint="rear", robot_uids="none")
    env.reset(seed=0)
    for _ in range(20):
        env.unwrapped.asset.set_qf(np.array([[8.0, 0.0]], dtype=np.float32))
        env.step(None)
    rear, front = env.unwrapped.asset.get_qpos()[0].tolist()
    assert rear > 0.1
    assert front > 0.05
    env.close()


def test_pairs_that_overlap_on_purpose_do_not_push_each_other(tmp_path) -> None:
    registry = write_registry(tmp_path)
    export_bundle(train(), Provenance("train.glb", "0" * 64), registry / "assets/train", (("part_1", "part_2"),))
    env = make(registry, joint="rear", robot_uids="none")
    env.reset(seed=0)
    for _ in range(20):
        env.unwrapped.asset.set_qf(np.array([[8.0, 0.0]], dtype=np.float32))
        env.step(None)
    assert float(env.unwrapped.asset.get_qpos()[0, 1]) == pytest.approx(0.0, abs=1e-3)
    env.close()


def test_a_wheel_without_end_opens_after_a_quarter_turn(registry) -> None:
    env = make(registry, asset="valve", robot_uids="none")
    observation, info = env.reset(seed=0)
    assert bool(np.isfinite(observation.numpy()).all())
    assert float(info["open_fraction"]) == 0.0
    assert bool(put(env, "wheel", 1.5)["success"])
    env.close()


def test_an_asset_whose_input_pose_is_half_open_starts_closed(tmp_path) -> None:
    env = make(write_registry(tmp_path, cabinet(lower=-0.1)), joint="slide", robot_uids="none")
    _, info = env.reset(seed=0)
    assert float(info["open_fraction"]) == pytest.approx(0.0, abs=1e-6)
    assert float(info["handle_position"][0, 1]) == pytest.approx(-0.122, abs=1e-5)
    env.close()


def test_a_mobile_robot_stands_on_the_floor_before_the_object(registry) -> None:
    env = make(registry, asset="cabinet", robot_uids="fetch")
    env.reset(seed=0, options={"joint": "slide"})
    task = env.unwrapped
    tool, handle = task.agent.tcp.pose.p[0].numpy(), task.handle_position()[0].numpy()
    assert abs(tool[0] - handle[0]) < 0.25
    assert tool[1] < handle[1] - 0.1
    env.close()


def test_several_environments_in_one_process_are_refused(registry) -> None:
    with pytest.raises(ValueError, match="num_envs is 2, want 1"):
        make(registry, num_envs=2)


def picture(registry: Path) -> Any:
    """Runs in a child: what the task's camera sees, or why it sees nothing."""
    try:
        env = make(registry, asset="cabinet", obs_mode="rgb", render_mode="rgb_array", render_backend="cpu")
        observation, _ = env.reset(seed=0)
        return observation["sensor_data"]["base_camera"]["rgb"][0].numpy(), env.render()[0].numpy()
    except RuntimeError as error:
        if any(sign in str(error) for sign in NO_RENDERER):
            return str(error)
        raise


def test_the_cameras_see_the_red_cabinet(registry) -> None:
    seen = run_isolated(picture, registry, limits=Limits(wall_s=180.0)).unwrap()
    if isinstance(seen, str):
        pytest.skip(f"no Vulkan device to render with ({seen}); Mesa's software Vulkan, 25 or newer, is enough")
    for image in seen:
        red = (image[..., 0] > 80) & (image[..., 1] < 60) & (image[..., 2] < 60)
        assert red.mean() > 0.03
