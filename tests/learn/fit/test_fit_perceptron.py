"""Small networks learn what can be learned."""

import numpy as np
import pytest
import torch  # noqa: TID253

from asset_factory.learn.fit.perceptron import (
    FitSettings,
    Weighing,
    cross_entropy,
    fit_perceptron,
    fit_scaled,
)


def test_a_network_learns_what_no_line_divides():
    rows = np.random.default_rng(0).normal(size=(400, 3))
    wanted = (rows[:, :1] * rows[:, 1:2] > 0.0).astype(np.float64)
    weights = dict.fromkeys(("inner", "offset", "outer", "base"), Weighing(0.5, 2e-5))
    network = fit_scaled(rows, cross_entropy(wanted), FitSettings(6, weights, 400))
    right = (network.scores(rows) > 0.0) == (wanted > 0.5)
    assert right.mean() > 0.9


def test_weights_past_the_hidden_layer_are_fitted_too():
    rows = np.random.default_rng(2).normal(size=(300, 4))
    truth = rows @ np.array([[1.0], [-2.0], [0.0], [0.5]])

    def loss(scores):
        return ((scores - torch.from_numpy(truth)) ** 2).mean()

    linear = fit_perceptron(rows, loss, FitSettings(0, {"direct": Weighing(0.0, 0.0)}, 200))
    assert linear.direct == pytest.approx(np.array([[1.0], [-2.0], [0.0], [0.5]]), abs=1e-3)
    assert linear.scores(rows) == pytest.approx(truth, abs=1e-2)
    weights = {name: Weighing(0.3, 0.0) for name in ("inner", "offset", "outer", "direct")}
    both = fit_perceptron(rows, loss, FitSettings(3, weights, 400))
    assert both.scores(rows) == pytest.approx(truth, abs=5e-2)
