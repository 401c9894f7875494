"""Obvious preferences are recovered from few samples; the command writes what is read back."""

from dataclasses import replace

import numpy as np
import pytest

from asset_factory.factory.articulate.evidence.numbers import GUESS, NAMES
from asset_factory.factory.articulate.evidence.rating import rating_of
from asset_factory.factory.articulate.evidence.setting import SLIDE_SETTING, TURN_SETTING, Setting
from asset_factory.factory.articulate.evidence.usual import likelihood, usual_of, worth
from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.shipped import load_arrays
from asset_factory.learn.datasets.objects import generated
from asset_factory.learn.fit import __main__ as command
from asset_factory.learn.fit.motions import fit_motions
from asset_factory.learn.motions.motion_sample import MotionSample

COUNT = 12


def motion_sample(seed):
    """The largest ``turn_free`` is right; ``tall`` turns by 2 or slides by 1, else by half."""
    rng = np.random.default_rng(seed)
    numbers = np.zeros((COUNT, len(NAMES)), dtype=np.float32)
    numbers[:, : -len(GUESS)] = rng.uniform(-0.3, 0.3, (COUNT, len(NAMES) - len(GUESS)))
    best = int(np.argmax(numbers[:, NAMES.index("turn_free")]))
    right = np.arange(COUNT) == best
    slides = bool(seed % 2)
    tall = float(seed % 3 == 0)
    names = SLIDE_SETTING if slides else TURN_SETTING
    about = rng.uniform(-0.2, 0.2, len(names))
    about[names.index("tall")] = tall
    far = (1.0 if slides else 2.0) * (1.0 if tall else 0.5)
    return MotionSample(
        name=str(seed), numbers=numbers, guessed=np.zeros(COUNT, dtype=bool),
        worth=right.astype(float), right=right,
        alike=np.eye(COUNT, dtype=bool), setting=Setting(slides, 1.0, np.inf, about), range=far,
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


@pytest.mark.parametrize("slides", [False, True])
def test_a_usual_range_is_recovered(stored, slides):
    usual = usual_of(stored, slides)
    unseen = [one for one in map(motion_sample, range(1000, 1060)) if one.setting.slides == slides]
    ranges = [usual.range(one.setting, None) for one in unseen]
    wanted = [one.range for one in unseen]
    assert np.isclose(ranges, wanted, rtol=1e-3, atol=0.0).mean() > 0.9


def test_a_guess_decides_between_usual_ranges(stored):
    usual = usual_of(stored, False)
    doubtful = replace(motion_sample(0).setting, numbers=0.5 * (np.array(TURN_SETTING) == "tall"))
    assert usual.range(doubtful, 2.2) == pytest.approx(2.0, rel=1e-3)
    assert usual.range(doubtful, 0.9) == pytest.approx(1.0, rel=1e-3)


def test_the_same_motion_samples_give_the_same_weights(motion_samples):
    first, again = (fit_motions(motion_samples[:30], steps=5) for _ in range(2))
    assert set(first.arrays) == set(again.arrays)
    for name, values in first.arrays.items():
        assert np.array_equal(values, again.arrays[name])


def test_a_kind_that_nothing_has_is_refused(motion_samples):
    with pytest.raises(ConfigError, match="nothing slides"):
        fit_motions([one for one in motion_samples[:20] if not one.setting.slides], steps=2)


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
    assert usual_of(stored, False).values.ndim == usual_of(stored, True).values.ndim == 1
    card = (tmp_path / "evidence.md").read_text()
    assert f"`python -m asset_factory.learn.fit {' '.join(asked)}`" in card
    assert "| seed | 500 |" in card


def test_the_command_refuses_a_folder_without_objects(tmp_path, capsys):
    asked = ["motions", str(tmp_path / "none"), "--seeds", "0", "--data", str(tmp_path)]
    assert command.main(asked) == 2
    assert "holds no URDF" in capsys.readouterr().err


def test_no_end_is_like_no_end_only():
    values = np.array([1.0, 2.0 * np.pi, np.inf])
    assert likelihood(2.0 * np.pi, values)[0] < likelihood(2.0 * np.pi, values)[2]
    assert likelihood(1.1, values).argmax() == 0
    assert worth(values)[0, 2] < 1e-6
    assert np.allclose(np.diag(worth(values)), 1.0)
