"""A U-Net over pictures (Ronneberger et al., MICCAI 2015), run in numpy.

It needs no framework, so that every installation reads a mesh alike.
"""

from collections.abc import Mapping

import numpy as np

from ..mesh import FloatArray

#: It answers for squares of so many pixels, and halves its picture so often.
SQUARE = 2
HALVINGS = 4
#: Rows and columns of a picture are multiples of this.
GRID = SQUARE * 2**HALVINGS

Weights = Mapping[str, FloatArray]


def picture_scores(weights: Weights, picture: FloatArray) -> FloatArray:
    """Return every answer's score for every square, [answer_count, rows / 2, columns / 2].

    One coarse first layer, pairs of layers at each of four halved sizes, and likewise up again.

    Args:
        weights: float32 by layer, normalisations folded in.
        picture: shape [channel_count, rows, columns], a multiple of :data:`GRID` each way.
    """
    levels = [_layer(weights, "first", picture, step=SQUARE)]
    for number in range(HALVINGS):
        levels.append(_pair(weights, f"down_{number}", _halved(levels[-1])))
    inner = levels.pop()
    for number in reversed(range(1, HALVINGS)):
        beside = levels.pop()
        inner = _pair(weights, f"up_{number}", np.concatenate([_doubled(inner), beside]))
    inner = _layer(weights, "last", np.concatenate([_doubled(inner), levels.pop()]))
    return convolved(inner, weights["answer.weight"], weights["answer.bias"])


def convolved(
    values: FloatArray, kernel: FloatArray, bias: FloatArray, step: int = 1
) -> FloatArray:
    """Return the cross-correlation with zeros around.

    Args:
        values: shape [channels, rows, columns].
        kernel: shape [answers, channels, width, width], ``width`` odd.
        bias: shape [answers].
        step: between two places of the answer.
    """
    width = kernel.shape[-1]
    rows, columns = (length // step for length in values.shape[1:])
    room = (width // 2, width // 2)
    padded = np.pad(values.astype(np.float32), ((0, 0), room, room))
    found = np.repeat(bias[:, None], rows * columns, axis=1)
    for row in range(width):
        for column in range(width):
            part = padded[:, row::step, column::step][:, :rows, :columns]
            found += kernel[:, :, row, column] @ part.reshape(len(part), -1)
    shaped: FloatArray = found.reshape(-1, rows, columns)
    return shaped


def _pair(weights: Weights, name: str, values: FloatArray) -> FloatArray:
    return _layer(weights, f"{name}.1", _layer(weights, f"{name}.0", values))


def _layer(weights: Weights, name: str, values: FloatArray, step: int = 1) -> FloatArray:
    """Return a convolution, cut off below 0."""
    found = convolved(values, weights[f"{name}.weight"], weights[f"{name}.bias"], step)
    return np.maximum(found, 0.0)


def _halved(values: FloatArray) -> FloatArray:
    """Return the greatest of every four."""
    channels, rows, columns = values.shape
    return np.asarray(values.reshape(channels, rows // 2, 2, columns // 2, 2).max(axis=(2, 4)))


def _doubled(values: FloatArray) -> FloatArray:
    """Return every value four times, as a square."""
    return values.repeat(2, axis=1).repeat(2, axis=2)
