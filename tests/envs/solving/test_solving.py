"""A scripted robot opens what can be opened, says why it does not, and does the same again."""

import json
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from openable_samples import fin, write_registry

from asset_factory.envs.solving import driving, film, make_episodes, replay, solve_joint
from asset_factory.envs.solving.solve import SolveTask, attempted
from asset_factory.factory.errors import ConfigError, RegistryError
from asset_factory.sim_checks.processes.isolation import WarmChild

pytest.importorskip("mani_skill", reason="mani_skill is not installed")

#: More than an arm can pull [N].
LOCKED = 5000.0


@pytest.fixture(scope="module")
def registry(tmp_path_factory):
    objects = fin("drawer"), fin("locked"), fin("tower", height=3.0)
    root = write_registry(tmp_path_factory.mktemp("registry"), *objects)
    manifest = root / "assets" / "locked" / "asset.json"
    data = json.loads(manifest.read_text())
    data["joints"][0]["friction"] = LOCKED
    manifest.write_text(json.dumps(data))
    return root


@pytest.fixture(scope="module")
def child():
    with WarmChild() as child:
        yield child


@pytest.fixture(scope="module")
def solved(registry, child):
    return solve_joint(registry, "drawer", "slide", child=child)


def test_a_drawer_is_opened(solved):
    assert solved.solved, solved.message
    assert solved.reason == ""
    assert solved.open_fraction >= 0.9
    assert solved.kinds[0] == "grasp"
    assert solved.actions.shape == (solved.steps, 8)
    assert np.isfinite(solved.actions).all()
    # The joint's own friction is 20 N, and its damping a little more.
    assert 20.0 < solved.peak_force < 25.0
    assert 10.0 < solved.mean_force <= solved.peak_force


def test_the_same_actions_open_it_again(registry, solved):
    environment = make_episodes(registry, "panda")
    success, share = replay(environment, solved)
    assert success
    assert share == solved.open_fraction
    # One action fewer is not enough: the episode ends when it is solved.
    assert replay(environment, replace(solved, actions=solved.actions[:-1]))[0] is False
    environment.close()


# imageio's reader leaves the pipes of ffmpeg to the collector.
@pytest.mark.filterwarnings("ignore:unclosed file:ResourceWarning")
def test_a_film_shows_the_hand_and_what_it_opens(registry, solved, tmp_path, monkeypatch):
    imageio = pytest.importorskip("imageio.v2", reason="imageio comes with mani_skill")
    pytest.importorskip("embreex", reason="embreex is not installed")
    monkeypatch.setattr(film, "WIDTH", 160)
    monkeypatch.setattr(film, "HEIGHT", 120)
    monkeypatch.setattr(film, "EVERY", solved.steps // 3)
    made = film.read_film(str(registry), solved)
    assert len(made.values) == solved.steps + 1
    assert made.values[-1]["asset/slide"] > 0.13 > made.values[0]["asset/slide"]
    film.film(str(registry), solved, tmp_path / "film.mp4")
    pictures = [np.asarray(each, float) for each in imageio.mimread(tmp_path / "film.mp4")]
    assert len(pictures) == 4
    assert [path.name for path in tmp_path.iterdir()] == ["film.mp4"]
    # Nearly all of a picture stays; the arm and the drawer are elsewhere in the next.
    for before, after in pairwise(pictures):
        assert 0.005 < (np.abs(after - before).max(axis=2) > 40.0).mean() < 0.4


def test_the_same_question_has_the_same_answer(registry, solved, child):
    again = solve_joint(registry, "drawer", "slide", child=child)
    assert np.array_equal(again.actions, solved.actions)
    assert replace(again, seconds=0.0, actions=solved.actions) == replace(solved, seconds=0.0)


def test_a_force_counts_if_it_lasts_a_quarter_of_a_second():
    assert driving.sustained([1000.0, 1000.0]) == 0.0
    assert driving.sustained([0.0, 0.0, 1000.0, 0.0, 0.0, 0.0]) == pytest.approx(200.0)
    assert driving.sustained([30.0] * 20 + [0.0] * 5) == pytest.approx(30.0)


def test_what_is_levered_open_by_more_than_an_arm_bears_is_not_solved(registry, monkeypatch):
    monkeypatch.setattr(driving, "OVERLOAD", 10.0)
    attempt = attempted(SolveTask(str(registry), "drawer", "slide", "panda", 0, 1))
    assert not attempt.solved
    assert attempt.reason in ("forced", "stuck")
    assert "N" in attempt.message
    assert attempt.open_fraction < 0.9


def test_a_locked_drawer_is_not_reported_solved(registry, child):
    attempt = solve_joint(registry, "locked", "slide", tries=1, child=child)
    assert not attempt.solved
    assert attempt.reason == "stuck"
    assert attempt.open_fraction < 0.02
    assert "N" in attempt.message


def test_what_is_out_of_reach_is_said_to_be(registry, child):
    attempt = solve_joint(registry, "tower", "slide", robot="fetch", tries=1, child=child)
    assert not attempt.solved
    assert attempt.reason == "unreachable"
    assert attempt.steps == 0


def test_an_unknown_asset_joint_or_robot_is_the_askers_mistake(registry):
    told = "no asset 'sofa'; there are 'drawer', 'locked', 'tower'"
    with pytest.raises(RegistryError, match=told):
        solve_joint(registry, "sofa", "slide")
    with pytest.raises(ConfigError, match="no robot 'arm'; want one of panda, fetch"):
        solve_joint(registry, "drawer", "slide", robot="arm")
    with pytest.raises(RegistryError, match=r"no joint 'lid' to \w+; there are 'slide'"):
        solve_joint(registry, "drawer", "lid")


def test_a_child_that_runs_out_of_time_is_a_reason(registry):
    attempt = solve_joint(registry, "drawer", "slide", timeout_s=0.01)
    assert (attempt.solved, attempt.reason) == (False, "timeout")
