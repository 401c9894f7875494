"""Small networks: their sum in closed form, and files that are for other numbers refused.

Beside each shipped file of plain arrays a card says which command makes it.
"""

from pathlib import Path

import numpy as np
import pytest
from repository import ROOT

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.perceptron import Perceptron, inputs_of, linear
from asset_factory.factory.models.shipped import Arrays, load_arrays
from asset_factory.factory.models.weights.safetensors import write_arrays

WEIGHTS = ROOT / "configs" / "weights"
FILES = sorted(path.name for path in WEIGHTS.iterdir() if path.suffix != ".md")


def _network():
    rng = np.random.default_rng(0)
    shapes = ((3, 4), (4,), (4, 2), (2,), (3, 2))
    return Perceptron(*(rng.normal(size=shape) for shape in shapes))


def test_scores_are_the_sum_of_both_ways():
    network = _network()
    numbers = np.array([0.3, -1.0, 2.0])
    hidden = np.tanh(numbers @ network.inner + network.offset)
    assert network.direct is not None
    wanted = hidden @ network.outer + network.base + numbers @ network.direct
    assert network.scores(numbers) == pytest.approx(wanted)
    assert network.scores(np.stack([numbers, 0.0 * numbers])).shape == (2, 2)
    # A linear model is a network of no width.
    assert linear(np.array([1.0, 2.0])).scores(np.array([3.0, 4.0])) == pytest.approx([11.0])


def test_what_is_far_from_what_was_learned_counts_as_no_farther():
    network = Perceptron(*_network().arrays("n").values(), np.zeros(3), np.ones(3))
    assert np.array_equal(network.scores(np.full(3, 4.0)), network.scores(np.full(3, 400.0)))


def test_a_network_comes_back_from_its_file(tmp_path):
    file = tmp_path / "some.safetensors"
    write_arrays(file, _network().arrays("some"), inputs_of({"some": ("a", "b", "c")}))
    assert file.stat().st_mode & 0o777 == 0o644
    found = Perceptron.read(load_arrays(file), "some", ("a", "b", "c"))
    assert np.array_equal(found.inner, _network().inner)
    assert found.mean is None
    first = file.read_bytes()
    write_arrays(file, _network().arrays("some"), inputs_of({"some": ("a", "b", "c")}))
    assert file.read_bytes() == first


def test_a_file_for_other_numbers_is_refused():
    stored = Arrays(Path("some.safetensors"), {}, inputs_of({"some": ("a", "b")}))
    with pytest.raises(ConfigError, match=r"some\.safetensors: some was fitted .*\['c'\]"):
        Perceptron.read(stored, "some", ("a", "b", "c"))
    with pytest.raises(ConfigError, match="another order"):
        Perceptron.read(stored, "some", ("b", "a"))


@pytest.mark.parametrize("file", FILES)
def test_weights_are_plain_numbers_with_a_card(file):
    arrays = load_arrays(WEIGHTS / file).arrays
    # A turn without end is longer than any.
    assert not any(np.isnan(values).any() for values in arrays.values())
    card = (WEIGHTS / file).with_suffix(".md").read_text(encoding="utf-8")
    assert card.startswith(f"# {file}\n")
    assert "| made" in card
    assert f"configs/weights/{file}" in card or "`factory train " in card
    assert "seed" in card
    assert "by hand" not in card
    assert "| terms | Apache-2.0 |" in card
