"""Mesh -> answer: sample, ask the network, decode; several times over, if wanted."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

import numpy as np

from ...errors import InputRejected
from ...mesh import FloatArray, IntArray
from .agreement import Consensus, consensus
from .decoding import Decoded, DecodeRules, decode
from .prediction import Prediction
from .proxy import proxy_of
from .sampling import Cloud, sample
from .surface import Surface

MOST_SAMPLES = 64


class Network(Protocol):
    """Whatever answers for a cloud of points."""

    def __call__(self, cloud: Cloud, context: Cloud) -> Prediction:
        """Return the answer for one cloud, all in the network's frame.

        ``cloud`` is to label; features are computed from ``context``, more of the same surface.
        """
        ...


def infer(
    vertices: FloatArray,
    faces: IntArray,
    network: Network,
    *,
    points: int,
    context_points: int,
    most_faces: int,
    samples: int,
    seed: int,
    rules: DecodeRules,
) -> Consensus:
    """Return what the network makes of a mesh.

    Args:
        vertices: object frame, z up [m], shape [vertex_count, 3].
        faces: shape [face_count, 3].
        network: answers for one cloud.
        points: to label per sample; more where a face would have none.
        context_points: for features of the whole shape, per sample.
        most_faces: a mesh with more is shown as a lighter one.
        samples: how many independent samples are read; the one that agrees most with the others is
            taken.
        seed: of all chance; sample ``k`` is the same however many there are.
        rules: how an answer is read.

    Raises:
        InputRejected: ``empty``, ``zero_size``, ``prediction_not_finite``.
        ValueError: there must be at least one point and one sample.
    """
    if points < 1 or context_points < 1 or most_faces < 4 or not 1 <= samples <= MOST_SAMPLES:
        asked = f"{points} points, {context_points} context points, {most_faces} faces, "
        want = f"want at least 1, 1, 4 and 1, and at most {MOST_SAMPLES} samples"
        raise ValueError(f"{asked}{samples} samples: {want}")
    if not len(faces):
        why = "the mesh has no faces; want a surface, no point cloud"
        raise InputRejected("empty", why, value=0.0, unit="faces")
    surface = Surface.of(vertices, faces)
    proxy = proxy_of(surface, most_faces)

    def readings() -> Iterator[Decoded]:
        for number in range(samples):
            rng = np.random.default_rng((seed, number))
            seen = sample(proxy.surface, points, context_points, most_faces, rng)
            answer = network(seen.cloud.inside(seen.box), seen.context.inside(seen.box))
            yield decode(surface, proxy, seen, answer, rules)

    return consensus(tuple(readings()), surface.areas)
