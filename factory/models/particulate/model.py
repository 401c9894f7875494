"""The network with its weights, ready to answer for a cloud of points; imports torch."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from functools import partial
from typing import Any

import numpy as np

from ...errors import ConfigError
from ...mesh import Float32Array, IntArray
from ..network.shape import NetworkShape, Precision, product_dtype, read_shape
from ..network.streaming import (
    Driven,
    PairHead,
    drive,
    embed_chunks,
    finish,
    part_outputs,
)
from ..network.transformer import PartArticulationTransformer
from ..weights.checkpoint import filled, load_tensors, open_checkpoint
from ..weights.sources import PARTFIELD, fetch
from .components import COMPONENT_FEATURES, component_features
from .decoding import assigned
from .field import FeatureField
from .prediction import Prediction
from .sampling import Cloud

_DRIVING_SEED = 0
#: Part queries of the published weights, and the most that a file may ask for.
PUBLISHED_PARTS = "16"
MOST_PARTS = 256


@dataclass(frozen=True)
class PointCloud:
    """Points as the network sees them.

    Attributes:
        points: network frame, in a box with longest side 1 about the origin, z up, shape
            [point_count, 3].
        normals: there; shorter than 1 where they are a mean of two, shape [point_count, 3].
        features: shape [point_count, channels]; ``None`` for networks that want none.
    """

    points: Float32Array
    normals: Float32Array
    features: Float32Array | None = None

    def __post_init__(self) -> None:
        for each in fields(self):
            value = getattr(self, each.name)
            if value is not None:
                object.__setattr__(self, each.name, np.asarray(value, dtype=np.float32))

    def take(self, rows: IntArray) -> PointCloud:
        """Return some of the points."""
        features = None if self.features is None else self.features[rows]
        return PointCloud(self.points[rows], self.normals[rows], features)


@dataclass(frozen=True)
class Model:
    """A Part Articulation Transformer with weights.

    Attributes:
        shape: its sizes and variant.
        dtype: of the products over points, a torch type.
        upright: whether it was taught every axis by its upward direction, so that only limits say
            which way opens.
    """

    shape: NetworkShape
    dtype: Any
    _network: Any = field(repr=False)
    upright: bool = False

    def predict(
        self, cloud: PointCloud, *, driving: int | None = None, least_confidence: float = 0.0
    ) -> Prediction:
        """Return what the network says about a cloud.

        Args:
            cloud: of any size.
            driving: how many of the points the parts are told from, drawn at random but always the
                same ones; the others are only labelled, for less work. All of them by default.
            least_confidence: see :class:`.inference.Network`.
        """
        if driving is not None and driving < len(cloud.points):
            rows = np.random.default_rng(_DRIVING_SEED).permutation(len(cloud.points))[:driving]
            return self.decode(self.encode(cloud.take(np.sort(rows))), cloud, least_confidence)
        hidden = self._embed(cloud)
        driven = drive(self._network, hidden, self.dtype)
        return self._read(driven, hidden, driven.updates[-1:], least_confidence)

    def encode(self, cloud: PointCloud) -> Driven:
        """Encode a cloud's parts: enough to label other points of the same surface."""
        driven: Driven = drive(self._network, self._embed(cloud), self.dtype)
        return driven

    def decode(
        self, driven: Driven, cloud: PointCloud, least_confidence: float = 0.0
    ) -> Prediction:
        """Return what the network says about points, given what others told about the parts.

        Every point is answered for alone: more or fewer of them change nothing.
        """
        return self._read(driven, self._embed(cloud), driven.updates, least_confidence)

    def _embed(self, cloud: PointCloud) -> Any:
        features = cloud.features if self.shape.features else None
        normals = cloud.normals if self.shape.normals else None
        return embed_chunks(self._network, cloud.points, normals, features)

    def _read(
        self, driven: Driven, hidden: Any, updates: tuple[Any, ...], least_confidence: float
    ) -> Prediction:
        masks = PairHead(self._network.mask_head, driven.queries, self.dtype)
        mask_logits = finish(hidden, updates, masks)
        parts = part_outputs(self._network, driven.queries)
        if self.upright:
            parts = _opening(parts)
        closest = None
        if parts["revolute_moment"] is None:
            head = PairHead(self._network.point_motion_decoder, driven.queries, self.dtype)
            closest = head.own_parts(hidden, assigned(mask_logits, least_confidence).parts)
        return Prediction(mask_logits=mask_logits, closest_points=closest, **parts)


def _opening(parts: dict[str, Any]) -> dict[str, Any]:
    """Turn axes round where most of the range lies behind this pose: positive then opens."""
    limits = parts["revolute_range"]
    behind = -limits.min(axis=1) > limits.max(axis=1)
    sign = np.where(behind, -1.0, 1.0).astype(np.float32)[:, None]
    changed = {
        "revolute_direction": parts["revolute_direction"] * sign,
        "revolute_range": np.where(behind[:, None], -limits[:, ::-1], limits),
    }
    moment = parts["revolute_moment"]
    return {**parts, **changed, "revolute_moment": None if moment is None else moment * sign}


@dataclass(frozen=True)
class Particulate:
    """Both networks together: from points of a surface to what the parts are and how they move.

    Attributes:
        model: says it.
        field: gives it features; ``None`` for a model that wants none, or what a point's component
            looks like.
        driving: see :meth:`Model.predict`.
    """

    model: Model
    field: FeatureField | None = None
    driving: int | None = None

    def __post_init__(self) -> None:
        wanted = self.model.shape.features
        given = 0 if self.field is None else self.field.shape.features
        if wanted and wanted != given and not (self.field is None and wanted == COMPONENT_FEATURES):
            wants = f"this network wants {wanted} features per point and gets {given}"
            advice = f"load the weights of {PARTFIELD.network} beside it, {PARTFIELD.source}"
            raise ConfigError(f"{wants}: {advice}. {PARTFIELD.terms}")

    def __call__(self, cloud: Cloud, context: Cloud, least_confidence: float = 0.0) -> Prediction:
        """Return the answer for one cloud, see :class:`.inference.Network`."""
        points = np.asarray(cloud.points, np.float32)
        normals = np.asarray(cloud.normals, np.float32)
        shown = PointCloud(points, normals, self._features(cloud, context))
        return self.model.predict(shown, driving=self.driving, least_confidence=least_confidence)

    def _features(self, cloud: Cloud, context: Cloud) -> Float32Array | None:
        if not self.model.shape.features:
            return None
        if self.field is not None:
            return self.field.features(context.points, cloud.points)
        names = ("points", "normals", "components")
        both = (np.concatenate([getattr(c, name) for c in (cloud, context)]) for name in names)
        return component_features(*both)[: len(cloud.points)]


def load_model(
    checkpoint: str,
    *,
    precision: Precision | str = Precision.FLOAT32,
    device: str = "cpu",
) -> Model:
    """Return a Part Articulation Transformer from a checkpoint; its tensors tell sizes and variant.

    ``checkpoint`` is a safetensors, ``.pt`` or ``.ckpt`` file, or ``hf:owner/repository/file``. No
    tensor tells how many part queries there are: ``max_parts`` in the metadata does; the published
    weights have none there, and 16 queries.

    Raises:
        ConfigError: no such checkpoint, or not one of this network.
    """
    stored = open_checkpoint(fetch(checkpoint))
    queries = stored.metadata.get("max_parts", PUBLISHED_PARTS)
    if not (queries.isdecimal() and 1 <= int(queries) <= MOST_PARTS):
        raise ConfigError(f"{stored.file}: max_parts is {queries!r}, want 1 to {MOST_PARTS}")
    shape = stored.read(partial(read_shape, max_parts=int(queries)))
    network = filled(PartArticulationTransformer, shape, load_tensors(stored), device)
    upright = stored.metadata.get("axes") == "upright"
    return Model(shape, product_dtype(precision), network, upright)
