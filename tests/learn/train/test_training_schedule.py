"""Rates, running means, the start: closed forms."""

import copy
import math

import pytest
import torch  # noqa: TID253

from asset_factory.factory.models.network.shape import NetworkShape
from asset_factory.factory.models.network.transformer import PartArticulationTransformer
from asset_factory.learn.train.averaging import follow
from asset_factory.learn.train.curves import Curve, read_curve
from asset_factory.learn.train.settings import OptimiserSettings, ScheduleSettings
from asset_factory.learn.train.trainer import quieten
from asset_factory.learn.train.validation import part_ious


def test_the_rate_climbs_a_line_and_falls_half_a_cosine():
    schedule = ScheduleSettings(steps=110, rate=2.0, warm_up=10, last_rate=0.1)
    assert schedule.rate_at(0) == pytest.approx(0.2)
    assert schedule.rate_at(9) == schedule.rate_at(10) == 2.0
    assert schedule.rate_at(60) == pytest.approx(2.0 * 0.55)
    assert schedule.rate_at(110) == pytest.approx(0.2)
    rates = [schedule.rate_at(step) for step in range(10, 111)]
    assert rates == sorted(rates, reverse=True)


def test_the_running_mean_forgets_the_start_and_then_is_slow():
    layer = torch.nn.Linear(1, 1, bias=False)
    mean = copy.deepcopy(layer)
    expected = layer.weight.item()
    for step in range(2000):
        with torch.no_grad():
            layer.weight.fill_(math.sin(step))
        follow(mean, layer, OptimiserSettings(ema=0.99).decay_at(step))
        decay = min(0.99, (1 + step) / (10 + step))
        expected = decay * expected + (1 - decay) * math.sin(step)
    assert mean.weight.item() == pytest.approx(expected, abs=1e-5)


def test_a_quiet_start_leaves_slow_sinusoids_and_coordinates_alone():
    network = PartArticulationTransformer(NetworkShape(hidden=8, blocks=1, heads=1, features=0))
    before = network.pos_embed.mlp[0].weight.clone()
    quieten(network, 30.0)
    ratio = (network.pos_embed.mlp[0].weight / before)[0]
    turning = [1000.0 * 10000.0 ** (-k / 32) for k in range(32)]
    expected = [min(1.0, 30.0 / angle) for angle in turning] * 6 + [1.0] * 3
    torch.testing.assert_close(ratio, torch.tensor(expected), rtol=1e-4, atol=1e-6)


def test_rows_after_the_last_checkpoint_and_half_rows_are_dropped(tmp_path):
    path = tmp_path / "curve.csv"
    Curve(path, ["loss"], 0).add([(1, [0.5]), (2, [0.25]), (3, [0.125])])
    with path.open("a") as stream:
        stream.write("4,0.0")
    whole = path.read_bytes()
    curve = Curve(path, ["loss"], 2)
    assert read_curve(path) == {"step": [1.0, 2.0], "loss": [0.5, 0.25]}
    curve.add([(3, [0.125])])
    assert path.read_bytes() == whole.removesuffix(b"4,0.0")


def test_overlaps_are_of_the_best_assignment():
    assert part_ious([5, 5, 7, 7], [0, 0, 1, 1]) == [1.0, 1.0]
    assert part_ious([1, 1, 1, 1], [0, 0, 0, 1]) == [0.75, 0.0]
    assert part_ious([0, 1, 1, 1], [1, 1, 0, 0]) == pytest.approx([2 / 3, 1 / 2])
