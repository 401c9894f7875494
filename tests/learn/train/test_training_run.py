"""Whole runs: what they leave, and that one cut off at any moment goes on as if it had not been."""

import errno
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from unittest.mock import Mock

import numpy as np
import pytest
import torch  # noqa: TID253
from box_sampled_objects import write_boxes
from command_line import COMMAND
from filelock import FileLock
from tiny_recipe import recipe

from asset_factory.factory.cli.commands import run
from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.particulate.model import load_model
from asset_factory.factory.models.weights.checkpoint import open_checkpoint
from asset_factory.learn.commands.train import Train, train
from asset_factory.learn.train import loop
from asset_factory.learn.train import trainer as training
from asset_factory.learn.train.checkpoints import State, fill, read_state, read_weights, write_state
from asset_factory.learn.train.curves import read_curve
from asset_factory.learn.train.matching import match
from asset_factory.learn.train.recipes import load_train_config, parse_train_config
from asset_factory.learn.train.trainer import Trainer


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    """A recipe."""
    folder = tmp_path_factory.mktemp("training")
    (folder / "tiny.toml").write_text(recipe(write_boxes(folder / "data", 6)))
    return folder / "tiny.toml"


@pytest.fixture(scope="module")
def output(path):
    """The folder of an undisturbed run of it."""
    folder = path.with_name("run")
    assert train(Train(str(path), folder))
    return folder


def assert_same_files(folder, output):
    for name in ("curves.csv", "validation.csv", "model.safetensors"):
        assert (folder / name).read_bytes() == (output / name).read_bytes(), name


def act_at(monkeypatch, wanted, act):
    """Do something to a trainer just before it takes a step."""
    step = Trainer.step

    def acting(self, number, batch, stop=False):
        if number == wanted:
            act(self)
        return step(self, number, batch, stop)

    monkeypatch.setattr(Trainer, "step", acting)


def edited(path, target, *edits):
    """A recipe with other texts, written elsewhere; the path as a text."""
    text = path.read_text()
    for old, new in edits:
        text = text.replace(old, new)
    target.write_text(text)
    return str(target)


def test_a_run_leaves_weights_that_load_and_figures(output):
    model = load_model(str(output / "model.safetensors"))
    assert (model.shape.hidden, model.shape.features, model.shape.max_parts) == (16, 27, 6)
    about = open_checkpoint(output / "model.safetensors").metadata
    wanted = ("components", "6", "for tests", "12")
    assert (about["features"], about["max_parts"], about["terms"], about["steps"]) == wanted
    card = json.loads((output / "card.json").read_text())
    assert card["samples"] == 72
    assert card["sources"] == [{"kind": "sampled", "sampled": 6, "skipped": {}}]
    assert 0.0 <= card["held_out"]["part_iou"] <= 1.0
    curve = read_curve(output / "curves.csv")
    assert curve["step"] == list(range(1, 13))
    assert np.mean(curve["total"][-3:]) < curve["total"][0]
    assert read_curve(output / "validation.csv")["step"] == [5, 10, 12]
    assert (output / "curves.png").read_bytes().startswith(b"\x89PNG")
    assert read_state(output / "last.pt").step == 12
    assert read_state(output / "best.pt").step in (5, 10, 12)


def test_the_same_recipe_gives_the_same_bytes_and_workers_change_nothing(path, output, tmp_path):
    assert train(Train(str(path), tmp_path / "again", workers=2))
    assert_same_files(tmp_path / "again", output)


def test_a_killed_run_goes_on_as_if_it_had_not_been(path, output, tmp_path):
    other = tmp_path / "run"
    command = [*COMMAND, "train", str(path), "--output", str(other)]
    one_thread = {**os.environ, "OMP_NUM_THREADS": "1"}
    process = subprocess.Popen(command, stderr=subprocess.DEVNULL, env=one_thread)
    deadline = time.monotonic() + 120.0
    while not (other / "last.pt").is_file() and process.poll() is None:
        assert time.monotonic() < deadline
        time.sleep(0.005)
    process.kill()
    process.wait()
    assert read_state(other / "last.pt").step >= 3
    assert train(Train(str(path), other, resume=True))
    assert_same_files(other, output)


def test_asked_to_end_it_writes_a_checkpoint_and_goes_on_later(path, output, tmp_path, monkeypatch):
    act_at(monkeypatch, 4, lambda _: signal.raise_signal(signal.SIGTERM))
    assert run(["train", str(path), "--output", str(tmp_path / "run")]) == 130
    monkeypatch.undo()
    assert read_state(tmp_path / "run" / "last.pt").step == 6
    assert run(["train", str(path), "--output", str(tmp_path / "run"), "--resume"]) == 0
    assert_same_files(tmp_path / "run", output)


def test_a_run_goes_on_by_its_own_recipe_alone(path, output, tmp_path):
    with pytest.raises(ConfigError, match="--resume"):
        train(Train(str(path), output))
    with pytest.raises(ConfigError, match="holds no run"):
        train(Train(str(path), tmp_path / "none", resume=True))
    edits = (("3e-3", "4e-3"), ("log_every = 4", "log_every = 5"))
    changed = edited(path, tmp_path / "changed.toml", *edits)
    with pytest.raises(ConfigError, match=r"another schedule\.rate"):
        train(Train(changed, output, resume=True))


def test_other_data_start_from_the_weights_of_a_run(path, output, tmp_path):
    edits = (("steps = 12", "steps = 1"), ("rate = 3e-3", "rate = 1e-12"))
    more = edited(path, tmp_path / "more.toml", *edits)
    assert train(Train(more, tmp_path / "run", start=output / "last.pt"))
    before = read_weights(output / "model.safetensors")
    after = read_weights(tmp_path / "run" / "model.safetensors")
    for name, tensor in before.items():
        torch.testing.assert_close(after[name], tensor, rtol=0.0, atol=1e-6)


def test_weights_of_another_network_are_refused_with_what_differs(output):
    network = torch.nn.Sequential(torch.nn.Linear(2, 2))
    with pytest.raises(ConfigError, match=r"Missing key.*0\.weight.*Unexpected key.*\[\.\.\.\]"):
        fill(network, read_weights(output / "last.pt"), output / "last.pt")
    with pytest.raises(ConfigError, match=r"0\.weight: .* shape torch.Size\(\[3, 2\]\)"):
        fill(network, {"0.weight": torch.zeros(3, 2), "0.bias": torch.zeros(2)}, output)


def test_without_an_output_the_recipe_is_printed_to_edit(capsys):
    assert run(["train", "paper"]) == 0
    assert parse_train_config(capsys.readouterr().out, "printed") == load_train_config("paper")
    assert run(["train", "paper", "--resume"]) == 2
    assert "--output: missing" in capsys.readouterr().err


def test_damaged_checkpoints_are_refused(tmp_path):
    (tmp_path / "last.pt").write_bytes(b"PK nothing")
    with pytest.raises(ConfigError, match="not a checkpoint"):
        read_state(tmp_path / "last.pt")


@pytest.mark.parametrize("odd", [{"step": "none"}, {"seconds": None}, {"best": (0.5, "none")}])
def test_checkpoints_whose_numbers_are_none_are_refused(tmp_path, odd):
    state = State(3, {}, {}, {}, None, "data", 1.0)
    write_state(tmp_path / "last.pt", replace(state, **odd))
    with pytest.raises(ConfigError, match="not a checkpoint"):
        read_state(tmp_path / "last.pt")


def test_weights_that_are_no_numbers_are_never_written(path, tmp_path, monkeypatch):
    def poison(trainer):
        with torch.no_grad():
            next(trainer.network.parameters()).fill_(float("nan"))

    act_at(monkeypatch, 4, poison)
    with pytest.raises(ConfigError, match=r"step 5: .* is not finite any more"):
        train(Train(str(path), tmp_path / "run"))
    assert read_state(tmp_path / "run" / "last.pt").step == 3
    kept = read_weights(tmp_path / "run" / "model.safetensors")
    for weights in (read_state(tmp_path / "run" / "last.pt").weights, kept):
        assert all(bool(torch.isfinite(each).all()) for each in weights.values())


def test_a_run_whose_gradients_stay_infinite_ends(path, tmp_path, monkeypatch):
    long = edited(path, tmp_path / "nan.toml", ("steps = 12", "steps = 40"))
    monkeypatch.setattr(training, "total", lambda found, settings: found["mask"] * float("nan"))
    said = "step 19: the gradients of 20 steps in a row are not finite"
    with pytest.raises(ConfigError, match=said):
        train(Train(long, tmp_path / "run"))


def test_an_answer_that_overflowed_is_matched_anyhow():
    logits = torch.full((1, 4, 3), float("nan"))
    queries = match(logits, torch.tensor([[0, 1, 2, 0]]), torch.tensor([3]))
    assert sorted(queries[0].tolist()) == [0, 1, 2]


def test_a_folder_belongs_to_one_run_at_a_time(path, output, tmp_path):
    lock = FileLock(output / ".lock", blocking=False)
    with lock, pytest.raises(ConfigError, match="another process is training there"):
        train(Train(str(path), output, resume=True))
    with lock:
        pass


def test_a_run_that_could_not_begin_leaves_none_to_go_on_with(path, tmp_path):
    bad = edited(path, tmp_path / "bad.toml", ('path = "', 'path = "/none'))
    with pytest.raises(ConfigError, match="no such folder"):
        train(Train(bad, tmp_path / "run"))
    with pytest.raises(ConfigError, match="No such file"):
        train(Train(str(path), tmp_path / "run", start=tmp_path / "none.safetensors"))
    with pytest.raises(ConfigError, match="holds no run to go on with"):
        train(Train(str(path), tmp_path / "run", resume=True))


def test_killed_before_its_first_checkpoint_a_tuned_run_goes_on_from_its_weights(
    path, output, tmp_path, monkeypatch
):
    act_at(monkeypatch, 0, Mock(side_effect=KeyboardInterrupt))
    with pytest.raises(KeyboardInterrupt):
        train(Train(str(path), tmp_path / "run", start=output / "model.safetensors"))
    found = read_state(tmp_path / "run" / "last.pt")
    wanted = read_weights(output / "model.safetensors")
    assert found.step == 0
    for name, tensor in found.weights.items():
        torch.testing.assert_close(tensor, wanted[name])


def test_a_checkpoint_of_another_network_is_refused(path, output, tmp_path):
    shutil.copytree(output, tmp_path / "run")
    state = torch.load(output / "last.pt", weights_only=True)
    state["weights"].popitem()
    torch.save(state, tmp_path / "run" / "last.pt")
    with pytest.raises(ConfigError, match=r"last\.pt: weights of another network: .*Missing key"):
        train(Train(str(path), tmp_path / "run", resume=True))


def test_a_full_disk_ends_the_run_with_a_sentence_and_leaves_what_was_there(
    path, tmp_path, monkeypatch
):
    write = loop.write_state
    written_so_far = []

    def full(target, state):
        written_so_far.append(state.step)
        if state.step > 3:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        write(target, state)

    monkeypatch.setattr(loop, "write_state", full)
    said = "No space left on device; what was stored before is whole, and --resume"
    with pytest.raises(ConfigError, match=said):
        train(Train(str(path), tmp_path / "run"))
    assert read_state(tmp_path / "run" / "last.pt").step == 3
    assert not list((tmp_path / "run").glob(".writing-*"))


@pytest.mark.full
def test_two_processes_learn_the_same_as_one(tmp_path):
    path = tmp_path / "tiny.toml"
    path.write_text(recipe(write_boxes(tmp_path / "data", 6), dropout=0.0, steps=8))
    assert train(Train(str(path), tmp_path / "one"))
    launch = [sys.executable, "-m", "torch.distributed.run", "--standalone", "--nproc-per-node=2"]
    command = [*launch, *COMMAND[1:], "train", str(path), "--output", str(tmp_path / "two")]
    subprocess.run(command, check=True, timeout=300, env={**os.environ, "OMP_NUM_THREADS": "1"})
    one, two = (read_curve(tmp_path / name / "curves.csv") for name in ("one", "two"))
    for name, values in one.items():
        np.testing.assert_allclose(two[name], values, rtol=1e-3, atol=1e-5, err_msg=name)
