"""A sample is a function of the seed, the step and its number."""

import os
import signal
from dataclasses import fields, replace

import numpy as np
import pytest
from box_sampled_objects import write_boxes
from boxy_urdf import URDF
from tiny_recipe import recipe

from asset_factory.factory.errors import ConfigError
from asset_factory.learn.samples.batches import Batch
from asset_factory.learn.train import data_loader as feeding
from asset_factory.learn.train import dataset as supplying
from asset_factory.learn.train.data_loader import DataLoader
from asset_factory.learn.train.dataset import Dataset, Generator, find_pools, held_out_samples
from asset_factory.learn.train.recipes import parse_train_config
from asset_factory.learn.train.settings import DataSource


@pytest.fixture
def config(tmp_path):
    return parse_train_config(recipe(write_boxes(tmp_path / "data", 5)), "here")


@pytest.fixture
def pools(config, tmp_path):
    return find_pools(config.data, tmp_path)


def assert_equal(one, other):
    for name in (each.name for each in fields(one)):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)


def test_other_steps_numbers_and_seeds_give_other_samples(config, pools):
    dataset = Dataset(config, pools)
    reseeded = Dataset(replace(config, seed=1), pools)
    for other in (dataset.sample(1, 0), dataset.sample(0, 1), reseeded.sample(0, 0)):
        assert not np.array_equal(dataset.sample(0, 0).points, other.points)


def test_workers_and_processes_get_the_same_samples(config, pools):
    with DataLoader(config, pools, 4) as loader:
        wanted = [loader.batch(step) for step in (4, 5)]
    busy = replace(config, run=replace(config.run, workers=2))
    with DataLoader(busy, pools, 4) as loader:
        for step, batch in zip((4, 5), wanted, strict=True):
            assert_equal(loader.batch(step), batch)
    with (
        DataLoader(config, pools, 4, rank=0, world=2) as even,
        DataLoader(config, pools, 4, rank=1, world=2) as odd,
    ):
        shares = [loader.batch(4) for loader in (even, odd)]
    assert [len(share) for share in shares] == [3, 3]
    for name in [each.name for each in fields(Batch)]:
        for rank, share in enumerate(shares):
            np.testing.assert_array_equal(getattr(share, name), getattr(wanted[0], name)[rank::2])


def test_a_worker_that_fails_says_why(config, pools):
    gone = tuple(replace(pool, paths=(pool.paths[0].with_name("gone.npz"),)) for pool in pools)
    busy = replace(config, run=replace(config.run, workers=1))
    with (
        DataLoader(busy, gone, 0) as loader,
        pytest.raises(ConfigError, match=r"20 sampled objects in a row.*gone\.npz"),
    ):
        loader.batch(0)


def test_a_worker_that_is_killed_is_replaced_and_draws_the_same(config, pools):
    with DataLoader(config, pools, 4) as loader:
        wanted = [loader.batch(step) for step in (4, 5, 6)]
    busy = replace(config, run=replace(config.run, workers=1, ahead=1))
    said = []
    with DataLoader(busy, pools, 4, say=said.append) as loader:
        assert_equal(loader.batch(4), wanted[0])
        os.kill(loader._workers[0]._child.pid, signal.SIGKILL)
        for step, batch in zip((5, 6), wanted[1:], strict=True):
            assert_equal(loader.batch(step), batch)
    assert len(said) <= 1
    assert all("died; another one takes its place" in line for line in said)


def end_itself(*_):
    os.kill(os.getpid(), signal.SIGKILL)


def test_workers_that_only_die_end_the_run(config, pools, monkeypatch):
    monkeypatch.setattr(feeding, "draw_share", end_itself)
    busy = replace(config, run=replace(config.run, workers=1))
    with (
        DataLoader(busy, pools, 0) as loader,
        pytest.raises(ConfigError, match="failed: killed by SIGKILL; it may want"),
    ):
        loader.batch(0)
    assert loader._workers[0]._child.pid is None


def test_a_made_object_that_goes_wrong_costs_only_itself(config, monkeypatch):
    mixture = supplying.MixtureSettings(categories=("laptop",))
    pool = Generator(DataSource("procedural", points=256), mixture)
    make = supplying.sample_object
    calls = []

    def odd(rng, style):
        calls.append(1)
        if len(calls) % 2:
            raise ValueError("no face for ['knob']")
        return make(rng, style)

    monkeypatch.setattr(supplying, "sample_object", odd)
    assert Dataset(config, (pool,)).sample(0, 0).points.shape == (32, 3)
    assert len(calls) == 2

    def hopeless(rng, style):
        raise ZeroDivisionError("flat")

    monkeypatch.setattr(supplying, "sample_object", hopeless)
    with pytest.raises(ConfigError, match=r"20 sampled objects in a row.*ZeroDivisionError: flat"):
        Dataset(config, (pool,)).sample(0, 0)


def test_a_broken_held_out_file_is_passed_over(config, pools, tmp_path):
    assert len(held_out_samples(config, pools)) == 4
    pools[0].paths[0].write_bytes(b"PK")
    assert len(held_out_samples(config, pools)) == 3
    for path in pools[0].paths:
        path.write_bytes(b"PK")
    with pytest.raises(ConfigError, match="held_out: none of its objects"):
        held_out_samples(config, pools)


def test_what_was_passed_over_is_told_and_counted(tmp_path):
    source = DataSource("description", path=str(tmp_path / "data"))
    (tmp_path / "data" / "one").mkdir(parents=True)
    (tmp_path / "data" / "one" / "a.urdf").write_text("<robot")
    said = r"no object in it can be used(?s:.*)1 skipped: \w+; first one"
    with pytest.raises(ConfigError, match=said):
        find_pools([source], tmp_path / "cache")
    (tmp_path / "data" / "two").mkdir()
    (tmp_path / "data" / "two" / "a.urdf").write_text(URDF.format(name="two", height=0.6))
    pools = find_pools([source], tmp_path / "cache")
    read = len(pools[0].paths)
    assert read > 0
    told = f"description: {read} of {read + 1} objects read, {read} of them new"
    assert supplying.source_lines(pools)[0] == told
    assert supplying.source_counts(pools)[0]["sampled"] == read
    assert sum(supplying.source_counts(pools)[0]["skipped"].values()) == 1


def test_a_generator_makes_each_object_once_and_uses_it_as_often_as_asked(config, monkeypatch):
    made = []

    def note(kept, seed, make):
        made.append(seed)
        raise ConfigError("seen")

    monkeypatch.setattr(supplying._Kept, "get", note)
    monkeypatch.setattr(supplying, "_TRIES", 1)
    pool = Generator(DataSource("procedural", reuse=3), supplying.MixtureSettings())
    dataset = Dataset(config, (pool,))
    # Each of 6 places draws from a whole window of 8 objects.
    for step in range(24):
        for number in range(6):
            with pytest.raises(ConfigError):
                dataset.sample(step, number)
    uses = {seed: made.count(seed) for seed in made}
    assert set(uses.values()) == {3}
    assert {seed[3] for seed in uses} == set(range(6))


def test_a_split_names_the_files_and_the_digest_tells_them(config, tmp_path):
    (tmp_path / "split.txt").write_text("box-1\nbox-3.npz\n")
    some = find_pools([replace(config.data[0], split=str(tmp_path / "split.txt"))], tmp_path)
    assert [path.name for path in some[0].paths] == ["box-1.npz", "box-3.npz"]
    assert supplying.digest(some) != supplying.digest(find_pools(config.data, tmp_path))


def test_a_folder_with_nothing_in_it_is_refused(tmp_path):
    with pytest.raises(ConfigError, match="no sampled objects in it"):
        find_pools([DataSource(path=str(tmp_path))], tmp_path)
    with pytest.raises(ConfigError, match="no such folder"):
        find_pools([DataSource(path=str(tmp_path / "none"))], tmp_path)


def test_a_split_that_names_none_of_them_is_refused(config, tmp_path):
    (tmp_path / "split.txt").write_text("chair\n")
    with pytest.raises(ConfigError, match="names none of the objects, which are called e"):
        find_pools([replace(config.data[0], split=str(tmp_path / "split.txt"))], tmp_path)
