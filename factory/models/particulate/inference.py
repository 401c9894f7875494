"""Mesh -> answer: sample, ask the network, decode; several times over, if wanted."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from ...config import ParticulateConfig
from ...errors import InputRejected
from ...mesh import FloatArray, IntArray
from .agreement import Consensus, consensus
from .decoding import decode
from .prediction import Prediction
from .proxy import proxy_of
from .sampling import Cloud, sample
from .surface import Surface

MOST_SAMPLES = 64


class Network(Protocol):
    """Whatever answers for a cloud of points."""

    def __call__(self, cloud: Cloud, context: Cloud, least_confidence: float = 0.0) -> Prediction:
        """Return the answer for one cloud, all in the network's frame.

        Args:
            cloud: points to label.
            context: more of the same surface, from which features are computed.
            least_confidence: as for :func:`~.decoding.assigned`, which gives every point the part
                whose axis it is asked for.
        """
        ...


def infer(
    vertices: FloatArray, faces: IntArray, network: Network, config: ParticulateConfig
) -> Consensus:
    """Return what the network makes of a mesh.

    Args:
        vertices: object frame, z up [m], shape [vertex_count, 3].
        faces: shape [face_count, 3].
        network: answers for one cloud.
        config: how the mesh is shown and its answers are read. Of several samples the one that
            agrees most with the others is taken; sample ``k`` is the same however many there are.

    Raises:
        InputRejected: ``empty``, ``zero_size``, ``prediction_not_finite``.
    """
    if not len(faces):
        why = "the mesh has no faces; want a surface, no point cloud"
        raise InputRejected("empty", why, value=0.0, unit="faces")
    surface = Surface.of(vertices, faces)
    proxy = proxy_of(surface, config.max_faces)

    counts = (config.points, config.context_points, config.max_faces)
    readings = []
    for number in range(config.samples):
        rng = np.random.default_rng((config.seed, number))
        seen = sample(proxy.surface, *counts, rng)
        both = (seen.cloud.inside(seen.box), seen.context.inside(seen.box))
        answer = network(*both, config.least_confidence)
        readings.append(decode(surface, proxy, seen, answer, config))
    return consensus(readings, surface.areas)
