"""Training's objects: any seed gives one, the same one again, and shares are kept."""

import collections

import numpy as np
import pytest

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.geometry.components import connected_components
from asset_factory.learn.objects import MixtureSettings, make_object, sample_object
from asset_factory.learn.objects.mixture import in_character


@pytest.mark.parametrize("seed", range(12))
def test_any_seed_gives_a_closed_object_with_a_joint_and_the_same_one_again(seed):
    one, again = (sample_object(np.random.default_rng(seed))[1] for _ in range(2))
    assert one.movable_joints
    assert len(one.movable_joints) < 16
    assert all(joint.lower <= 0.0 for joint in one.joints)
    assert one.mesh.vertices.tobytes() == again.mesh.vertices.tobytes()


def test_a_name_says_how_to_make_the_object_again():
    settings = MixtureSettings(categories=("laptop", "chest"))
    for seed in range(4):
        name, articulation = sample_object(np.random.default_rng(seed), settings)
        category, made, character, look = name.split("-")
        again, became = in_character(make_object(category, int(made)), character, int(look))
        assert became == character
        assert again.mesh.vertices.tobytes() == articulation.mesh.vertices.tobytes()


def test_characters_come_in_their_shares():
    settings = MixtureSettings(categories=("trash_can",), artist=0.5, generated=0.5, plain=0.5)
    names = (sample_object(np.random.default_rng(seed), settings)[0] for seed in range(60))
    found = collections.Counter(name.split("-")[2] for name in names)
    assert 20 <= found["generated"] <= 40
    assert 6 <= found["plain"] <= 25
    assert 6 <= found["artist"] <= 25


def test_skins_are_drawn_by_their_weight():
    settings = MixtureSettings(categories=("trash_can",), artist=0.0, generated=0.0, skin=1.0)
    name, made = sample_object(np.random.default_rng(0), settings)
    assert "-skin-" in name
    assert len(np.unique(connected_components(made.mesh))) < 5


def test_settings_from_a_file_are_checked():
    assert MixtureSettings(categories=["oven"]).categories == ("oven",)
    with pytest.raises(ConfigError, match="there is no \\['sofa'\\]"):
        MixtureSettings(categories=("sofa",))
    with pytest.raises(ConfigError, match="one of them above"):
        MixtureSettings(artist=0.0, generated=0.0)
    with pytest.raises(ConfigError, match="plain must be 0 to 1, not 2"):
        MixtureSettings(plain=2.0)
    with pytest.raises(ConfigError, match="most_parts"):
        MixtureSettings(most_parts=1)
    with pytest.raises(ConfigError, match="too few for oven"):
        sample_object(np.random.default_rng(0), MixtureSettings(categories=("oven",), most_parts=2))
    with pytest.raises(ValueError, match="want one of plain, artist, generated, skin"):
        in_character(make_object("chest", 0), "shiny", 0)
