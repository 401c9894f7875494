"""The picture network: its arithmetic against other libraries."""

import numpy as np
import pytest
from scipy import signal

from asset_factory.factory.articulate.seams.sight import CUES
from asset_factory.factory.models.picture_network import GRID, convolved, picture_scores


def test_a_convolution_is_a_cross_correlation():
    rng = np.random.default_rng(0)
    values = rng.normal(size=(3, 8, 6))
    kernel = rng.normal(size=(2, 3, 3, 3))
    bias = rng.normal(size=2)
    found = convolved(values, kernel.astype(np.float32), bias.astype(np.float32))
    expected = [
        sum(signal.correlate2d(values[c], kernel[k, c], mode="same") for c in range(3)) + bias[k]
        for k in range(2)
    ]
    assert found == pytest.approx(np.stack(expected), abs=1e-5)
    halved = convolved(values, kernel.astype(np.float32), bias.astype(np.float32), step=2)
    assert halved == pytest.approx(np.stack(expected)[:, ::2, ::2], abs=1e-5)


def test_it_computes_what_was_trained():
    torch = pytest.importorskip("torch")
    from asset_factory.learn.elevations.network import PictureNetwork

    torch.manual_seed(3)
    network = PictureNetwork()
    cues = torch.randn(2, len(CUES), 4 * GRID, 3 * GRID)
    # Normalisations learn from what they see before they are folded in.
    network(3.0 * cues + 1.0)
    network.eval()
    with torch.no_grad():
        expected = network(cues)[0].numpy()
    assert picture_scores(network.folded(), cues[0].numpy()) == pytest.approx(expected, abs=1e-4)
