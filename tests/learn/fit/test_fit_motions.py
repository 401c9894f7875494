"""Obvious preferences are recovered from few samples; the command writes what is read back."""

import numpy as np
import pytest

from asset_factory.factory.articulate.evidence.numbers import GUESS, NAMES
from asset_factory.factory.articulate.evidence.rating import rating_of
from asset_factory.factory.models.shipped import load_arrays
from asset_factory.learn.datasets.objects import generated
from asset_factory.learn.fit import __main__ as command
from asset_factory.learn.fit.motions import fit_motions
from asset_factory.learn.motions.motion_sample import MotionSample

COUNT = 12


def motion_sample(seed):
    """The largest ``turn_free`` is right."""
    rng = np.random.default_rng(seed)
    numbers = np.zeros((COUNT, len(NAMES)), dtype=np.float32)
    numbers[:, : -len(GUESS)] = rng.uniform(-0.3, 0.3, (COUNT, len(NAMES) - len(GUESS)))
    best = int(np.argmax(numbers[:, NAMES.index("turn_free")]))
    right = np.arange(COUNT) == best
    return MotionSample(
        name=str(seed), numbers=numbers, guessed=np.zeros(COUNT, dtype=bool),
        worth=right.astype(float), right=right, alike=np.eye(COUNT, dtype=bool),
    )  # fmt: skip


@pytest.fixture(scope="module")
def motion_samples():
    return [motion_sample(seed) for seed in range(240)]


@pytest.fixture(scope="module")
def stored(motion_samples):
    return fit_motions(motion_samples, steps=60)


def test_a_preference_is_recovered_for_parts_never_seen(stored):
    rating = rating_of(stored, "guided")
    unseen = [motion_sample(seed) for seed in range(1000, 1060)]
    hits = [one.right[int(np.argmax(rating.scores(one.numbers)))] for one in unseen]
    assert np.mean(hits) > 0.8
    assert rating.confidence(0.99) > rating.confidence(0.3)


def test_the_same_motion_samples_give_the_same_weights(motion_samples):
    first, again = (fit_motions(motion_samples[:30], steps=5) for _ in range(2))
    assert set(first.arrays) == set(again.arrays)
    for name, values in first.arrays.items():
        assert np.array_equal(values, again.arrays[name])


def test_the_command_writes_what_the_evidence_reads_and_a_card(tmp_path, monkeypatch, capsys):
    kinds = ["chest", "nightstand", "laptop"]
    monkeypatch.setattr(command, "generated", lambda seeds: generated(seeds, kinds))
    output = tmp_path / "evidence.safetensors"
    asked = ["motions", str(output), "--seeds", "1", "--steps", "3"]
    assert command.main(asked) == 0
    assert f"weights in {output}" in capsys.readouterr().out
    stored = load_arrays(output)
    for name in ("guided", "blind"):
        assert rating_of(stored, name).scores(np.zeros((2, len(NAMES)))).shape == (2,)
    card = (tmp_path / "evidence.md").read_text()
    assert f"`python -m asset_factory.learn.fit {' '.join(asked)}`" in card
    assert "| seed | 500 |" in card


@pytest.mark.parametrize(
    ("name", "says"),
    [("motions", "holds no URDF"), ("trust", "--split: 0 for 1 folders of --data")],
)
def test_the_command_refuses_folders_that_it_cannot_use(tmp_path, capsys, name, says):
    asked = [name, str(tmp_path / "none"), "--seeds", "0", "--data", str(tmp_path)]
    assert command.main(asked) == 2
    assert says in capsys.readouterr().err
