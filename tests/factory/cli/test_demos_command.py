"""``factory demos``: what is written, nothing is done twice, no reader ever sees half of it."""

import json
import os
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from job_samples import Inline
from openable_samples import cabinet, oven, valve, write_registry

from asset_factory.envs.assets import read_registry
from asset_factory.envs.demos import Settings, files, making
from asset_factory.envs.demos.episodes import Taken, make_shards
from asset_factory.envs.demos.files import keep_episode
from asset_factory.envs.demos.folder import hold
from asset_factory.factory.cli import demos as command
from asset_factory.factory.errors import ConfigError, Exit

h5py = pytest.importorskip("h5py", reason="h5py is not installed")
pytest.importorskip("mani_skill", reason="mani_skill is not installed")


def write_trajectory(path, seed, steps=5):
    with h5py.File(path, "w") as file:
        group = file.create_group("traj_0", track_order=True)
        group.create_dataset("actions", data=np.full((steps, 8), seed, dtype=np.float32))
        group.create_dataset("success", data=np.arange(steps) == steps - 1)


def fake_record(settings, folder, episode):
    """Hinges open; slides do not."""
    taken = Taken(episode, episode.joint != "slide", steps=5)
    if not taken.success:
        taken = replace(taken, reason="stuck", message="not moved by 50 N")
        keep_episode(Path(folder), settings, taken, None)
        return taken
    reset = {"seed": episode.seed, "options": {"asset": episode.asset, "joint": episode.joint}}
    info = {"episode_id": 0, "elapsed_steps": 5, "reset_kwargs": reset, "success": True}
    taken = replace(taken, info=info)
    path = Path(folder) / f"{episode.key(settings)}-recording.h5"
    write_trajectory(path, episode.seed)
    keep_episode(Path(folder), settings, taken, path)
    return taken


@pytest.fixture(scope="module")
def registry(tmp_path_factory):
    return write_registry(tmp_path_factory.mktemp("registry"), cabinet(), oven(), valve())


@pytest.fixture
def robot(monkeypatch):
    """What it was asked, after how much it dies, and of which seeds it does not answer in time."""
    told = SimpleNamespace(asked=[], dies_after=-1, slow=frozenset())

    def record(registry, settings, folder, episode):
        if len(told.asked) == told.dies_after:
            raise KeyboardInterrupt
        told.asked.append(episode)
        if episode.seed in told.slow:
            raise TimeoutError("no answer within 600 s")
        return fake_record(settings, folder, episode)

    monkeypatch.setattr(making, "LocalExecutor", Inline)
    monkeypatch.setattr(making, "record", record)
    # Nobody pulls the plug here, and a busy disk takes its time.
    monkeypatch.setattr(os, "fsync", lambda descriptor: None)
    return told


@pytest.fixture
def make(registry, tmp_path, robot):
    def make(**flags):
        return command.run(
            command.Demos(**{"output": registry, "to": tmp_path / "demos", "per_joint": 2, **flags})
        )

    return make


def shards_of(folder):
    seen = [path for path in sorted(folder.iterdir()) if not path.name.startswith(".")]
    return {path.name: path.read_bytes() for path in seen}


def test_a_file_holds_one_asset_and_says_what_failed(make, tmp_path, capsys):
    assert make() == Exit.OK
    names = ["cabinet-000.h5", "cabinet-000.json", "oven-000.h5", "oven-000.json", "summary.json"]
    names += ["valve-000.h5", "valve-000.json"]
    assert sorted(os.listdir(tmp_path / "demos")) == names
    data = json.loads((tmp_path / "demos/cabinet-000.json").read_text())
    assert [entry["episode_id"] for entry in data["episodes"]] == [0, 1]
    asked = ("joint", "seed", "reason", "episode_id")
    found = [tuple(row[key] for key in asked) for row in data["asset_factory"]["attempts"]]
    assert found[:2] == [("hinge", 0, "", 0), ("slide", 0, "stuck", None)]
    assert found[2:] == [("hinge", 1, "", 1), ("slide", 1, "stuck", None)]
    with h5py.File(tmp_path / "demos/cabinet-000.h5") as file:
        assert sorted(file) == ["traj_0", "traj_1"]
        assert np.all(file["traj_1/actions"][:] == 1.0)
    summary = json.loads((tmp_path / "demos/summary.json").read_text())
    assert (summary["episodes"], summary["successes"]) == (8, 6)
    assert summary["joints"][1]["reasons"] == {"stuck": 2}
    assert "6 of 8 episodes succeeded, 6 trajectories in" in capsys.readouterr().out


@pytest.mark.parametrize("episodes", [1, 4, 6])
def test_the_same_command_gives_the_same_bytes_and_asks_for_nothing_twice_even_if_it_was_stopped(
    make, tmp_path, robot, episodes
):
    for _ in range(2):
        make(to=tmp_path / "whole", workers=3)
        assert len(robot.asked) == 8
    robot.asked.clear()
    robot.dies_after = episodes
    with pytest.raises(KeyboardInterrupt):
        make()
    for path in (tmp_path / "demos").glob("*.h5"):
        for each in (path, path.with_suffix(".json")):
            assert each.read_bytes() == (tmp_path / "whole" / each.name).read_bytes()
    robot.dies_after = -1
    make()
    assert len(robot.asked) == len(set(robot.asked)) == 8
    assert shards_of(tmp_path / "demos") == shards_of(tmp_path / "whole")
    assert not (tmp_path / "demos" / files.WAITING).exists()


@pytest.mark.parametrize("step", ["_put_together", "write_json", "_sync"])
def test_a_shard_that_cannot_be_written_is_not_seen(make, tmp_path, robot, monkeypatch, step):
    class Full(OSError):
        pass

    def refuse(path, *arguments, **options):
        if ".episodes" in str(path) or "recording" in str(path):
            return original(path, *arguments, **options)
        raise Full

    original = getattr(files, step)
    with monkeypatch.context() as patch:
        patch.setattr(files, step, refuse)
        with pytest.raises(Full):
            make()
    assert not list((tmp_path / "demos").glob("*.h5"))
    assert make() == Exit.OK
    assert len(robot.asked) == 8
    assert not list((tmp_path / "demos").glob(f"{files.WRITING_PREFIX}*"))


def test_what_lost_its_trajectories_or_was_altered_is_demonstrated_anew(
    make, registry, tmp_path, robot
):
    make()
    robot.asked.clear()
    (tmp_path / "demos/oven-000.h5").unlink()
    manifest = registry / "assets/valve/asset.json"
    text = manifest.read_text()
    manifest.write_text(text + "\n")
    make()
    manifest.write_text(text)
    assert {episode.asset for episode in robot.asked} == {"oven", "valve"}


def test_what_ran_out_of_time_is_tried_again_and_the_rest_is_not(make, tmp_path, robot):
    robot.slow = frozenset({1})
    assert make(ids=("oven",)) == Exit.UNJUDGED
    row = json.loads((tmp_path / "demos/oven-000.json").read_text())["asset_factory"]["attempts"][1]
    assert (row["reason"], row["message"]) == ("timeout", "no answer within 600 s")
    robot.slow = frozenset()
    robot.asked.clear()
    assert make(ids=("oven",)) == Exit.OK
    assert [episode.seed for episode in robot.asked] == [1]


def test_further_seeds_and_assets_leave_full_files_alone(make, tmp_path, robot):
    make(ids=("cabinet",), shard_size=4)
    before = shards_of(tmp_path / "demos")
    robot.asked.clear()
    make(per_joint=3, shard_size=4)
    assert {episode.seed for episode in robot.asked if episode.asset == "cabinet"} == {2}
    after = shards_of(tmp_path / "demos")
    assert all(after[name] == data for name, data in before.items() if name != "summary.json")
    assert "cabinet-001.h5" in after


def test_joints_without_a_success_have_no_trajectories(make, robot, tmp_path):
    assert make(joint="slide") == Exit.OK
    assert {episode.joint for episode in robot.asked} == {"slide"}
    assert not list((tmp_path / "demos").glob("*.h5"))
    assert make(joint="slide", strict=True) == Exit.REJECTED


@pytest.mark.parametrize(
    ("task", "joints"), [("OpenDrawer-v1", {"slide"}), ("OpenDoor-v1", {"hinge", "door"})]
)
def test_a_task_is_demonstrated_on_its_joints(make, robot, task, joints):
    make(task=task)
    assert {episode.joint for episode in robot.asked} == joints


def test_one_folder_holds_one_kind_and_one_run(make, tmp_path):
    make()
    told = "holds demonstrations of OpenJoint-v1, panda, state, pd_joint_pos"
    with pytest.raises(ConfigError, match=told):
        make(robot="fetch")
    other = tmp_path / "other"
    with hold(other, Settings(), ()), pytest.raises(ConfigError, match="another run writes"):
        make(to=other)


@pytest.mark.parametrize(
    ("flags", "number", "seed", "words"),
    [
        ({"joint": "slide"}, "000", 0, "leave out"),
        ({"per_joint": 1}, "000", 1, "leave out"),
        ({"shard_size": 7}, "001", 1, "put into cabinet-000"),
    ],
)
def test_no_demonstration_is_lost_or_written_twice(make, tmp_path, flags, number, seed, words):
    make(ids=("cabinet",), shard_size=2 if "shard_size" in flags else 50)
    before = shards_of(tmp_path / "demos")
    told = f"cabinet-{number}.json: holds cabinet hinge seed {seed}, which these flags {words}"
    with pytest.raises(ConfigError, match=told):
        make(ids=("cabinet",), **flags)
    assert shards_of(tmp_path / "demos") == before


@given(seeds=st.integers(1, 9), size=st.integers(1, 7), more=st.integers(0, 5))
def test_every_episode_is_in_one_shard_and_stays_there(registry, seeds, size, more):
    assets = list(read_registry(registry).values())
    few = make_shards(assets[:2], range(seeds), size)
    many = make_shards(assets, range(seeds + more), size)
    episodes = [episode for shard in few for episode in shard.episodes]
    joints = sum(len(asset.openable) for asset in assets[:2])
    assert len(episodes) == len(set(episodes)) == seeds * joints
    named = {shard.name: shard for shard in many}
    assert len(named) == len(many)
    for shard in few:
        assert len(shard.episodes) <= size
        assert shard.episodes == named[shard.name].episodes[: len(shard.episodes)]
