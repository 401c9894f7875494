"""OpenJoint-v1: resets closed, reports what was opened, and keeps still what nobody touches."""

import numpy as np
import pytest
from making import HEADLESS, make, put
from openable_samples import cabinet, oven, train, valve, write_registry

from asset_factory.factory.errors import ConfigError, RegistryError
from asset_factory.factory.export import export_bundle
from asset_factory.factory.intake.intake import Provenance


@pytest.fixture(scope="module")
def registry(tmp_path_factory):
    return write_registry(tmp_path_factory.mktemp("registry"), cabinet(), oven(), valve())


@pytest.fixture(scope="module")
def one(registry):
    """One environment of the cabinet alone, shared by the tests that only reset it."""
    env = make(registry, asset="cabinet")
    yield env
    env.close()


@pytest.fixture
def making(registry):
    """Make environments, of that registry and without a robot unless others are asked for."""
    made = []

    def make_one(task="OpenJoint-v1", registry=registry, robot_uids="none", **options):
        made.append(make(registry, task, robot_uids=robot_uids, **options))
        return made[-1]

    yield make_one
    for env in made:
        env.close()


def test_it_is_made_by_name_after_importing_the_package(registry):
    import gymnasium

    import asset_factory.envs  # noqa: F401

    env = gymnasium.make("OpenJoint-v1", registry=registry, asset="cabinet", **HEADLESS)
    assert env.spec.max_episode_steps == 200 or env.get_wrapper_attr("_max_episode_steps") == 200
    env.close()


@pytest.mark.parametrize(
    ("joint", "closed", "opened"), [("hinge", 1.43, 1.45), ("slide", 0.268, 0.272)]
)
def test_success_is_nine_tenths_of_the_range(one, joint, closed, opened):
    one.reset(seed=0, options={"joint": joint})
    assert not bool(put(one, joint, closed)["success"])
    assert bool(put(one, joint, opened)["success"])


def test_a_door_that_is_still_swinging_or_another_that_is_open_is_no_success(one):
    one.reset(seed=0, options={"joint": "hinge"})
    assert not bool(put(one, "slide", 0.3)["success"])
    put(one, "hinge", 1.5)
    one.unwrapped.asset.set_qvel(np.array([[3.0, 0.0]], dtype=np.float32))
    judged = one.unwrapped.evaluate()
    assert bool(judged["at_goal"])
    assert not bool(judged["success"])


def test_reward_grows_with_opening_and_is_highest_at_success(one):
    one.reset(seed=0, options={"joint": "slide"})
    found = (put(one, "slide", value) for value in (0.0, 0.1, 0.2, 0.3))
    rewards = [float(one.unwrapped.compute_dense_reward(None, None, each)) for each in found]
    assert rewards == sorted(rewards)
    assert rewards[-1] == 5.0


def test_options_decide_asset_and_joint_for_one_episode(making):
    env = making(joint="slide")
    env.reset(seed=0, options={"joint": "hinge"})
    assert env.unwrapped.target.name == "hinge"
    env.reset(seed=0, options={"asset": "oven", "joint": "door"})
    assert (env.unwrapped.asset_record.id, env.unwrapped.target.name) == ("oven", "door")
    for seed in range(3):
        env.reset(seed=seed)
        assert (env.unwrapped.asset_record.id, env.unwrapped.target.name) == ("cabinet", "slide")


def test_unknown_names_are_refused_with_those_there_are(one, registry):
    told = "no asset 'fridge' in the registry; there are 'cabinet', 'oven', 'valve'"
    with pytest.raises(RegistryError, match=told):
        one.reset(options={"asset": "fridge"})
    with pytest.raises(RegistryError, match="no joint 'lid' to move; there are 'hinge', 'slide'"):
        one.reset(options={"joint": "lid"})
    with pytest.raises(RegistryError, match="no joint 'lid'"):
        make(registry, joint="lid")


def test_an_oven_door_stays_closed_by_itself_and_opens_below_the_floor_line(making):
    env = making(asset="oven")
    env.reset(seed=0)
    for _ in range(40):
        _, _, _, _, info = env.step(None)
    assert abs(float(info["open_fraction"])) < 0.01
    put(env, "door", 1.5)
    for _ in range(20):
        _, _, _, _, info = env.step(None)
    assert float(info["open_fraction"]) > 0.99


@pytest.mark.parametrize(("share", "moves"), [(0.9, False), (1.5, True)])
def test_a_drawer_moves_only_beyond_the_friction_its_manifest_states(making, share, moves):
    env = making(asset="cabinet", joint="slide")
    env.reset(seed=0)
    task = env.unwrapped
    friction = task.asset_record.manifest.movable["slide"].friction
    for _ in range(10):
        task.asset.set_qf(np.array([[0.0, share * friction]], dtype=np.float32))
        env.step(None)
    assert (float(task.open_fraction()) > 0.05) is moves


def test_a_pushed_drawer_slows_down_as_its_damping_says(making):
    env = making(asset="cabinet", joint="slide")
    env.reset(seed=0)
    task = env.unwrapped
    data = task.asset_record.manifest.movable["slide"]
    for joint in task.asset.active_joints:
        joint.set_drive_properties(0.0, 0.0)
    task.asset.set_qvel(np.array([[0.0, 0.2]], dtype=np.float32))
    env.step(None)
    expected = 0.2 * np.exp(-data.damping / data.inertia / task.control_freq)
    assert float(task.asset.get_qvel()[0, 1]) == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize(("exempt", "follows"), [((), True), ((("part_1", "part_2"),), False)])
def test_parts_of_one_asset_push_each_other_unless_they_overlap_on_purpose(
    tmp_path, making, exempt, follows
):
    export_bundle(train(), Provenance("train.glb", "0" * 64), tmp_path / "assets/train", exempt)
    env = making(registry=tmp_path, joint="rear")
    env.reset(seed=0)
    for _ in range(20):
        env.unwrapped.asset.set_qf(np.array([[8.0, 0.0]], dtype=np.float32))
        env.step(None)
    rear, front = env.unwrapped.asset.get_qpos()[0].tolist()
    assert rear > 0.1
    assert front > 0.05 if follows else front == pytest.approx(0.0, abs=1e-3)


def test_a_wheel_without_end_opens_after_a_quarter_turn(making):
    env = making(asset="valve")
    observation, info = env.reset(seed=0)
    assert bool(np.isfinite(observation.numpy()).all())
    assert float(info["open_fraction"]) == 0.0
    assert bool(put(env, "wheel", 1.5)["success"])


def test_an_asset_whose_input_pose_is_half_open_starts_closed(tmp_path, making):
    env = making(registry=write_registry(tmp_path, cabinet(lower=-0.1)), joint="slide")
    _, info = env.reset(seed=0)
    assert float(info["open_fraction"]) == pytest.approx(0.0, abs=1e-6)
    assert float(info["handle_position"][0, 1]) == pytest.approx(-0.122, abs=1e-5)


def test_a_mobile_robot_stands_on_the_floor_before_the_object(making):
    env = making(asset="cabinet", robot_uids="fetch")
    env.reset(seed=0, options={"joint": "slide"})
    task = env.unwrapped
    tool = task.agent.tcp.pose.p[0].numpy()
    handle = task.handle_position()[0].numpy()
    assert abs(tool[0] - handle[0]) < 0.25
    assert tool[1] < handle[1] - 0.1


def test_friction_is_drawn_within_its_range_and_again_for_every_seed(making):
    env = making(asset="cabinet", joint="slide", friction_range=(0.5, 2))
    task = env.unwrapped
    stated = task.asset_record.manifest.movable["slide"].friction
    drawn = []
    for seed in (0, 1, 0):
        env.reset(seed=seed)
        (joint,) = [joint for joint in task.asset.active_joints if joint.name == "slide"]
        drawn.append(float(joint._objs[0].force_limit) / stated)
    assert drawn[0] == drawn[2] != drawn[1]
    assert all(0.5 <= factor <= 2.0 for factor in drawn)


def test_an_asset_altered_after_the_task_was_made_is_refused(tmp_path, making):
    env = making(registry=write_registry(tmp_path, cabinet(), oven()))
    for name in ("cabinet", "oven"):
        (tmp_path / "assets" / name / "asset.urdf").unlink()
    told = r"asset\.urdf is gone since the registry was read; there are 'cabinet', 'oven'"
    with pytest.raises(RegistryError, match=told):
        env.reset(seed=0)


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"robot_uids": "googlebot"}, ConfigError, "'panda', 'fetch', 'none', not 'googlebot'"),
        ({"num_envs": 2}, ConfigError, "num_envs must be 1"),
        ({"obs_mode": "rgbd", "render_backend": "none"}, ConfigError, "needs a renderer"),
        ({"category": "car"}, RegistryError, "none with category 'car'"),
        ({"friction_range": (2, 1)}, ConfigError, "friction_range"),
    ],
)
def test_a_wrong_argument_is_one_clear_error(registry, options, error, message):
    with pytest.raises(error, match=message):
        make(registry, **options)


def test_a_drawer_task_refuses_an_asset_with_doors_alone(registry):
    told = "asset 'oven': no prismatic joint to move; there are 'revolute' joints"
    with pytest.raises(RegistryError, match=told):
        make(registry, "OpenDrawer-v1", asset="oven")
    with pytest.raises(ConfigError, match="joint_type must be 'prismatic', not 'revolute'"):
        make(registry, "OpenDrawer-v1", joint_type="revolute")


def test_closing_starts_open_and_ends_closed(making):
    env = making("CloseJoint-v1", asset="cabinet", joint="slide")
    for seed in range(3):
        _, info = env.reset(seed=seed)
        assert 0.5 <= float(info["open_fraction"]) <= 1.0
        assert not bool(info["success"])
    assert not bool(put(env, "slide", 0.02)["success"])
    assert bool(put(env, "slide", 0.01)["success"])


def test_a_goal_is_given_or_drawn_away_from_the_start(making):
    env = making("SetJoint-v1", asset="cabinet", joint="slide", obs_mode="state_dict")
    for seed in range(8):
        observation, info = env.reset(seed=seed)
        goal = float(observation["extra"]["goal_fraction"])
        assert 0.0 <= goal <= 1.0
        assert abs(goal - float(info["open_fraction"])) >= 0.2 - 1e-4
    observation, _ = env.reset(seed=0, options={"goal": 0.5})
    assert float(observation["extra"]["goal_fraction"]) == 0.5
    there = [bool(put(env, "slide", value)["success"]) for value in (0.13, 0.14, 0.16, 0.17)]
    assert there == [False, True, True, False]
