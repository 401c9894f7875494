"""Presets state differences; a wrong one is named."""

import pytest
from laid import laid

from asset_factory.factory.config import BuildConfig
from asset_factory.factory.errors import ConfigError
from asset_factory.factory.presets import load_config, shipped_names


def test_every_shipped_preset_loads():
    assert {"default", "strict", "lenient"} <= set(shipped_names("presets"))
    rest = {name: load_config(name).checks.penetration.rest_m for name in shipped_names("presets")}
    assert rest["strict"] < rest["default"] < rest["lenient"]
    assert load_config("default") == BuildConfig()


def test_a_file_changes_only_what_it_names(tmp_path):
    config = load_config(str(laid(tmp_path / "mine.toml", "[decompose]\nerror_m = 1\n")))
    assert config.decompose.error_m == 1.0
    assert config.checks == BuildConfig().checks


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("[decompose]\nerror = 1\n", "no setting 'error'; there are .*error_m"),
        ("[decompose]\nerror_m = 'small'\n", "error_m must be float, e.g."),
        ("decompose = 3\n", "must be a table of settings"),
        ("a = = 3\n", "mine.toml"),
    ],
)
def test_mistakes_are_named(tmp_path, text, sentence):
    path = laid(tmp_path / "mine.toml", text)
    with pytest.raises(ConfigError, match=sentence):
        load_config(str(path))
