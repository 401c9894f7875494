"""Recipes: those that come with the package can be read, and mistakes are named."""

import pytest

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.network.shape import NetworkShape
from asset_factory.factory.presets import shipped_names
from asset_factory.learn.train.recipes import load_train_config, parse_train_config

DATA = '[[data]]\nkind = "procedural"\n'


def test_every_shipped_recipe_can_be_read():
    assert {"laptop", "small", "paper"} <= set(shipped_names("train"))
    for name in shipped_names("train"):
        assert load_train_config(name).recipe == name


def test_the_papers_recipe_is_the_papers():
    config = load_train_config("paper")
    assert (config.schedule.steps, config.batch, config.draw.points) == (100_000, 128, 2048)
    wanted = (0.5, (0.95, 1.05), 0.02)
    assert (config.draw.sharp_share, config.draw.scale, config.draw.shift) == wanted
    size = NetworkShape()
    shape = config.network.shape
    wanted = (size.hidden, size.blocks, size.heads, size.mlp, size.max_parts)
    assert (shape.hidden, shape.blocks, shape.heads, shape.mlp, shape.max_parts) == wanted
    loss = config.loss
    wanted = (0.1, 0.0, 0.0, True)
    assert (loss.revolute_range, loss.dice, loss.auxiliary, loss.unseen_parts) == wanted


def test_components_bring_their_channels():
    config = parse_train_config(f'[network]\nfeatures = "components"\n{DATA}', "here")
    assert config.network.shape.features == 27
    assert config.training_draw.components
    assert not parse_train_config(DATA, "here").training_draw.components


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "no \\[\\[data\\]\\]"),
        ('[[data]]\nkind = "pictures"\n', "there are procedural"),
        ('[[data]]\npath = "x"\n', "kind is None"),
        ('[[data]]\nkind = "sampled"\n', "wants a path"),
        (f'[network]\nfeatures = "partfield"\n{DATA}', "PartField is not computed while training"),
        (f"[network]\nheads = 5\n{DATA}", "do not divide the width 768"),
        (f"[network]\ndepth = 5\n{DATA}", "no setting 'depth'; there are axes, blocks"),
        (f"[loss]\nmask = -1.0\n{DATA}", "loss.mask must be float >= 0.0, not -1.0"),
        (f"[schedule]\nsteps = 0\n{DATA}", "schedule.steps must be int >= 1, not 0"),
        (f'[run]\nprecision = "float8"\n{DATA}', "'float32' or 'bfloat16'"),
        ("batch = \n", "here"),
        (f"seed = -1\n{DATA}", "seed must be int >= 0"),
        (f"[run]\nworkers = -1\n{DATA}", "run.workers must be int >= 0, not -1"),
        (f"[run]\nmicro_batch = -2\n{DATA}", "run.micro_batch must be"),
        (f"[draw]\nscale = [1.0]\n{DATA}", "draw.scale must be array of length 2"),
        (f"[draw]\nscale = [1.1, 0.9]\n{DATA}", "the lower number first"),
        (f"[draw]\nscale = 1.0\n{DATA}", "draw: scale must be tuple"),
        (f"[draw]\nclosed_share = 5\n{DATA}", "draw.closed_share must be float <= 1.0, not 5.0"),
        (f"[draw]\nshift = inf\n{DATA}", "draw.shift must be float <= .*, not inf"),
        (f'[optimiser]\nbetas = ["a", "b"]\n{DATA}', "betas\\[0\\] must be float, not 'a'"),
        (f"[optimiser]\nema = 1.5\n{DATA}", "optimiser.ema must be float <= 1.0"),
        (f"[schedule]\nrate = nan\n{DATA}", "schedule.rate must be"),
        (f"{DATA}weight = inf\n", "data\\[0\\].weight must be"),
        (f"{DATA}reuse = -3\n", "data\\[0\\].reuse must be int >= 1, not -3"),
        (f'{DATA}style = "plain"\n', "data 1: style must be dict"),
    ],
)
def test_mistakes_are_named(text, says):
    with pytest.raises(ConfigError, match=says):
        parse_train_config(text, "here")


def test_an_unknown_recipe_is_told_which_there_are():
    named = "there are further, laptop, paper, skins, small, or a path"
    with pytest.raises(ConfigError, match=named):
        load_train_config("large")
