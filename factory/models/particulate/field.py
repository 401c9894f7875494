"""PartField: features of points from a sample of the whole surface. All that others ask of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt
import torch  # noqa: TID253 - this module is only imported to load the encoder

from ...mesh import Float32Array
from ..network.shape import Precision, product_dtype
from ..partfield.encoder import PartFieldEncoder, sample_field
from ..partfield.shape import UNUSED, PartFieldShape, read_partfield_shape
from ..weights.checkpoint import filled, load_tensors, open_checkpoint
from ..weights.sources import fetch

_HALF_SIZE = 0.9


@dataclass(frozen=True)
class FeatureField:
    """PartField's encoder with weights.

    Attributes:
        shape: its sizes.
        dtype: of the products, a torch type.
        device: where it runs.
    """

    shape: PartFieldShape
    dtype: Any
    device: str
    _encoder: Any = field(repr=False)

    def features(self, context: npt.ArrayLike, points: npt.ArrayLike) -> Float32Array:
        """Return a feature for every point.

        Args:
            context: a sample of the whole surface, any frame, shape [context_count, 3]; features
                depend on it.
            points: where features are wanted, same frame, shape [point_count, 3].

        Returns:
            [point_count, channels].
        """
        cloud = np.asarray(context, dtype=np.float32)
        low = cloud.min(axis=0)
        high = cloud.max(axis=0)
        scale = 2.0 * _HALF_SIZE / max(float((high - low).max()), float(np.finfo(np.float32).tiny))

        def inside(where: npt.ArrayLike) -> Any:
            placed = (np.asarray(where, dtype=np.float32) - (low + high) / 2.0) * np.float32(scale)
            return torch.tensor(placed, device=self.device)

        lowered = self.dtype is not torch.float32
        with (
            torch.inference_mode(),
            torch.autocast(self.device.split(":")[0], self.dtype, enabled=lowered),
        ):
            field = self._encoder(inside(cloud))
        with torch.inference_mode():
            return np.asarray(sample_field(field, inside(points)).cpu().numpy())


def load_field(
    checkpoint: str,
    *,
    precision: Precision | str = Precision.FLOAT32,
    device: str = "cpu",
    heads: int = 8,
) -> FeatureField:
    """Return PartField's encoder. The published weights are for non-commercial use only.

    ``checkpoint`` is a safetensors, ``.pt`` or ``.ckpt`` file, or ``hf:owner/repository/file``. No
    tensor tells how many heads its transformer has; the published weights have 8.

    Raises:
        ConfigError: no such checkpoint, or not one of this network.
    """
    stored = open_checkpoint(fetch(checkpoint))
    shape = stored.read(partial(read_partfield_shape, heads=heads))
    encoder = filled(PartFieldEncoder, shape, load_tensors(stored, leave=UNUSED), device)
    return FeatureField(shape, product_dtype(precision), device, encoder)
