"""A demonstration in ManiSkill's layout: its loader reads it, its replay ends the same."""

import json
import shutil

import numpy as np
import pytest
from openable_samples import fin, write_registry

from asset_factory.envs.demos import Episode, Settings, Shard, Taken
from asset_factory.envs.demos.files import write_shard
from asset_factory.envs.demos.recording import act_again
from asset_factory.envs.solving import Attempt
from asset_factory.factory.cli import demos as command
from asset_factory.factory.errors import Exit

h5py = pytest.importorskip("h5py", reason="h5py is not installed")
pytest.importorskip("mani_skill", reason="mani_skill is not installed")
WARN = "ignore:The 'warn' method is deprecated:DeprecationWarning:mani_skill"
pytestmark = pytest.mark.filterwarnings(WARN)


@pytest.fixture(scope="module")
def shard(tmp_path_factory):
    """One episode that a robot solved, of a registry that has moved since."""
    root = tmp_path_factory.mktemp("demonstrated")
    write_registry(root / "out", fin("drawer"))
    assert command.run(command.Demos(root / "demos", output=root / "out", per_joint=1)) == Exit.OK
    shutil.move(root / "out", root / "moved")
    return root / "demos/drawer-000.h5"


@pytest.fixture(scope="module")
def registry(shard):
    return shard.parent.parent / "moved"


def test_the_same_actions_lead_to_the_same_end(shard, registry):
    import gymnasium

    data = json.loads(shard.with_suffix(".json").read_text())
    info = data["env_info"]
    entry = data["episodes"][0]
    environment = gymnasium.make(info["env_id"], **{**info["env_kwargs"], "registry": registry})
    environment.reset(**entry["reset_kwargs"])
    with h5py.File(shard) as file:
        trajectory = file["traj_0"]
        assert len(trajectory["actions"]) == entry["elapsed_steps"] == len(trajectory["rewards"])
        for action in trajectory["actions"]:
            observation, _, terminated, truncated, result = environment.step(action)
        state = environment.unwrapped.get_state_dict()
        assert (bool(result["success"]), bool(terminated), bool(truncated)) == (True, True, False)
        steps = entry["elapsed_steps"]
        assert np.array_equal(trajectory["success"], np.arange(steps) == steps - 1)
        assert np.array_equal(trajectory["obs"][-1], observation[0])
        for name, value in state["articulations"].items():
            assert np.array_equal(trajectory[f"env_states/articulations/{name}"][-1], value[0])
        assert np.array_equal(trajectory["env_states/task"][-1], state["task"][0])
    environment.close()


def test_maniskills_loader_reads_it(shard):
    from mani_skill.trajectory.dataset import ManiSkillTrajectoryDataset

    data = ManiSkillTrajectoryDataset(str(shard), success_only=True)
    assert data.env_id == "asset_factory.envs:OpenJoint-v1"
    assert len(data) == data.episodes[0]["elapsed_steps"]
    assert set(data[0]) == {"obs", "action", "terminated", "truncated", "reward", "success"}
    data.data.close()


def test_only_what_the_task_calls_success_is_one(shard, registry, tmp_path):
    """Actions that stop too early, by a solver that claims to have opened it."""
    with h5py.File(shard) as file:
        actions = file["traj_0/actions"][:-20]
    claimed = Attempt("drawer", "", "slide", "panda", 0, True, actions=actions)
    episode = Episode("drawer", "", "slide", 0)
    settings = Settings(keep_failures=True)
    before = Taken(episode, True, steps=len(actions))
    taken = act_again(str(registry), before, claimed, settings, tmp_path)
    assert (taken.success, taken.reason, taken.steps) == (False, "irreproducible", len(actions))
    assert taken.message == (
        f"solved in {len(actions)} steps, "
        "and as pd_joint_pos the same actions did not open it again"
    )
    write_shard(tmp_path, tmp_path, Shard("kept", (episode,)), [taken], settings, "out")
    assert json.loads((tmp_path / "kept.json").read_text())["episodes"][0]["success"] is False
    with h5py.File(tmp_path / "kept.h5") as file:
        assert not file["traj_0/success"][:].any()


@pytest.mark.parametrize("flags", [[], ["--use-env-states"], ["-c", "pd_ee_delta_pose"]])
def test_maniskills_tool_replays_it(shard, registry, tmp_path, capsys, flags):
    from asset_factory.envs.demos.replay import replay

    for path in (shard, shard.with_suffix(".json")):
        shutil.copy(path, tmp_path)
    replay(["--traj-path", str(tmp_path / shard.name), "--registry", str(registry), *flags])
    assert "1/1=100.00% demos saved" in capsys.readouterr().out


def test_replay_wants_a_registry_after_its_flag(capsys):
    from asset_factory.envs.demos.replay import replay

    with pytest.raises(SystemExit) as left:
        replay(["--traj-path", "a.h5", "--registry"])
    assert left.value.code == Exit.USAGE
    assert "--registry: expected one argument" in capsys.readouterr().err
