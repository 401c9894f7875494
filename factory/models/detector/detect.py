"""What the detector says of a mesh."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cache
from typing import Any

import numpy as np
import torch  # noqa: TID253 - loaded by whoever runs the network
from scipy.special import expit, softmax

from ...articulation import Weights
from ...mesh import FloatArray, IntArray, Mesh
from ...runtime.store import digest_file
from ..weights.checkpoint import filled, load_tensors
from ..weights.safetensors import read_safetensors
from ..weights.sources import shipped_file
from .canvas import KINDS, look_at
from .decode import Dense, Found, found_parts
from .network import Detector, cues_of

WEIGHTS = shipped_file("detector.safetensors")


@dataclass(frozen=True, eq=False)
class Detection:
    """One object as the detector sees it.

    Attributes:
        dense: what the network says.
        faces: the nearest triangle at the middle of every cell, -1 for none, shape [5, 64, 64].
        kinds: probability of each kind of object, shape [kind_count].
        opens: probability that anything opens.
    """

    dense: Dense
    faces: IntArray
    kinds: FloatArray
    opens: float

    def parts(self, least: float) -> tuple[Found, ...]:
        """Return the parts that are seen with a score of at least ``least``."""
        return found_parts(self.dense, least)

    @property
    def kind(self) -> str:
        """Return the likeliest kind."""
        return KINDS[int(self.kinds.argmax())]


def detect(mesh: Mesh) -> Detection:
    """Return the detections on a mesh, z up, of at least one triangle."""
    canvases = look_at(mesh)
    cues = cues_of(torch.from_numpy(canvases.color), torch.from_numpy(canvases.depth))
    dense = first_of(_network()(cues[None]))
    kinds = softmax(dense.kind)
    return Detection(dense, canvases.cells, kinds, float(expit(dense.opens)))


def first_of(answers: Dense) -> Dense:
    """Return the answers on the first object of a batch, as arrays."""
    return Dense(*(_array(getattr(answers, field.name)) for field in fields(Dense)))


def _array(values: torch.Tensor) -> FloatArray:
    return np.asarray(values[0].float().cpu().numpy(), dtype=np.float64)


def detector_weights() -> Weights:
    """Return what a manifest says of the weights."""
    return Weights(WEIGHTS.name, digest_file(WEIGHTS), "Apache-2.0")


@cache
def _network() -> Any:
    return filled(Detector, len(KINDS), load_tensors(read_safetensors(WEIGHTS)), "cpu")
