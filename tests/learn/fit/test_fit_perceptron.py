"""Small networks learn what can be learned."""

import numpy as np
import pytest

from asset_factory.learn.fit.perceptron import (
    Examples,
    FitSettings,
    Weighing,
    fit_examples,
    fit_perceptron,
)


def _examples():
    rng = np.random.default_rng(0)
    rows = rng.normal(size=(400, 3))
    wanted = (rows[:, :1] * rows[:, 1:2] > 0.0).astype(np.float64)
    return Examples(rows, wanted, np.ones(len(rows)))


def _settings(width, decay, seed):
    weights = dict.fromkeys(("inner", "offset", "outer", "base"), Weighing(0.5, decay))
    return FitSettings(width, 1, weights, 400, seed)


def test_a_network_learns_what_no_line_divides():
    examples = _examples()
    network = fit_examples(examples, _settings(6, 2e-5, 0))
    right = (network.scores(examples.rows) > 0.0) == (examples.wanted > 0.5)
    assert right.mean() > 0.9


@pytest.mark.parametrize("answers", [1, 3])
def test_the_slope_of_the_loss_is_its_own(answers):
    rng = np.random.default_rng(1)
    wanted = rng.random((7, answers))
    wanted = wanted / wanted.sum(axis=1, keepdims=True) if answers > 1 else wanted
    examples = Examples(np.zeros((7, 1)), wanted, rng.random(7))
    scores = rng.normal(size=(7, answers))
    _, slope = examples.cross_entropy(scores)
    for row, column in np.ndindex(scores.shape):
        step = np.zeros_like(scores)
        step[row, column] = 1e-6
        up, down = (examples.cross_entropy(scores + sign * step)[0] for sign in (1, -1))
        assert slope[row, column] == pytest.approx((up - down) / 2e-6, abs=1e-7)


def test_weights_past_the_hidden_layer_are_fitted_too():
    rng = np.random.default_rng(2)
    rows = rng.normal(size=(300, 4))
    truth = rows @ np.array([[1.0], [-2.0], [0.0], [0.5]])

    def loss(scores):
        return float(((scores - truth) ** 2).mean()), 2.0 * (scores - truth) / len(rows)

    linear = fit_perceptron(rows, loss, FitSettings(0, 1, {"direct": Weighing(0.0, 0.0)}, 200))
    assert linear.direct == pytest.approx(np.array([[1.0], [-2.0], [0.0], [0.5]]), abs=1e-3)
    assert linear.scores(rows) == pytest.approx(truth, abs=1e-2)
    weights = {name: Weighing(0.3, 0.0) for name in ("inner", "offset", "outer", "direct")}
    both = fit_perceptron(rows, loss, FitSettings(3, 1, weights, 400))
    assert both.scores(rows) == pytest.approx(truth, abs=5e-2)
