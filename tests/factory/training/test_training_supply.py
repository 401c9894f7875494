"""A sample is a function of the seed, the step and its number."""

from dataclasses import fields, replace

import numpy as np
import pytest
from box_specimens import write_boxes
from tiny_recipe import recipe

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.training import supply as supplying
from asset_factory.factory.training.batches import Batch
from asset_factory.factory.training.feed import Feed
from asset_factory.factory.training.settings import DataSource, parse_train_config
from asset_factory.factory.training.supply import Generator, Supply, digest, find_pools, held_out_samples


@pytest.fixture
def config(tmp_path):
    return parse_train_config(recipe(write_boxes(tmp_path / "data", 5)), "here")


@pytest.fixture
def pools(config, tmp_path):
    return find_pools(config.data, tmp_path)


def assert_equal(one, other):
    for each in fields(one):
        np.testing.assert_array_equal(getattr(one, each.name), getattr(other, each.name), err_msg=each.name)


def test_the_order_of_asking_changes_no_sample(config, pools):
    one, other = Supply(config, pools), Supply(config, pools)
    for step in range(3):
        one.sample(step, 1)
    assert_equal(one.sample(3, 2), other.sample(3, 2))


def test_other_steps_numbers_and_seeds_give_other_samples(config, pools):
    supply = Supply(config, pools)
    others = [supply.sample(1, 0), supply.sample(0, 1), Supply(replace(config, seed=1), pools).sample(0, 0)]
    for other in others:
        assert not np.array_equal(supply.sample(0, 0).points, other.points)


def test_workers_and_processes_get_the_same_samples(config, pools):
    with Feed(config, pools, 4) as feed:
        wanted = [feed.batch(step) for step in (4, 5)]
    busy = replace(config, run=replace(config.run, workers=2))
    with Feed(busy, pools, 4) as feed:
        for step, batch in zip((4, 5), wanted, strict=True):
            assert_equal(feed.batch(step), batch)
    with Feed(config, pools, 4, rank=0, world=2) as even, Feed(config, pools, 4, rank=1, world=2) as odd:
        shares = [feed.batch(4) for feed in (even, odd)]
    assert [len(share) for share in shares] == [3, 3]
    for name in [each.name for each in fields(Batch)]:
        for rank, share in enumerate(shares):
            np.testing.assert_array_equal(getattr(share, name), getattr(wanted[0], name)[rank::2])


def test_a_worker_that_fails_says_why(config, pools):
    gone = tuple(replace(pool, paths=(pool.paths[0].with_name("gone.npz"),)) for pool in pools)
    busy = replace(config, run=replace(config.run, workers=1))
    with Feed(busy, gone, 0) as feed, pytest.raises(ConfigError, match=r"20 specimens in a row.*gone\.npz"):
        feed.batch(0)


def test_a_generator_makes_each_object_once_and_uses_it_as_often_as_asked(config, monkeypatch):
    made = []

    def note(kept, pool, seed):
        made.append(seed)
        raise ConfigError("seen")

    monkeypatch.setattr(supplying._Kept, "make", note)
    monkeypatch.setattr(supplying, "_TRIES", 1)
    pool = Generator(DataSource("procedural", reuse=3), supplying.MixtureSettings(), 1.0)
    supply = Supply(config, (pool,))
    # Batches of 6 in 4 lanes: two lanes with two samples per step, two with one; whole windows of 8 objects each.
    for step in range(24):
        for number in range(6):
            with pytest.raises(ConfigError):
                supply.sample(step, number)
    uses = {seed: made.count(seed) for seed in made}
    assert set(uses.values()) == {3}
    lanes = {seed[3] for seed in uses}
    assert lanes == {0, 1, 2, 3}


def test_held_out_examples_are_always_the_same(config, pools):
    for one, other in zip(held_out_samples(config, pools), held_out_samples(config, pools), strict=True):
        assert_equal(one, other)


def test_a_split_names_the_files_and_the_digest_tells_them(config, tmp_path):
    (tmp_path / "split.txt").write_text("box-1\nbox-3.npz\n")
    source = replace(config.data[0], split=str(tmp_path / "split.txt"))
    some = find_pools([source], tmp_path)
    assert [path.name for path in some[0].paths] == ["box-1.npz", "box-3.npz"]
    assert digest(some) != digest(find_pools(config.data, tmp_path))


def test_a_folder_with_nothing_in_it_is_refused(tmp_path):
    with pytest.raises(ConfigError, match="no specimens in it"):
        find_pools([DataSource(path=str(tmp_path))], tmp_path)
    with pytest.raises(ConfigError, match="no such folder"):
        find_pools([DataSource(path=str(tmp_path / "none"))], tmp_path)
