"""PartField's encoder: a cloud makes a field, and the field gives any point a feature."""

from typing import Any

import torch  # noqa: TID253 - this module is only imported to make the encoder
import torch.nn.functional as F  # noqa: N812, TID253
from torch import nn  # noqa: TID253

from .shape import PartFieldShape
from .triplane import TriplaneTransformer
from .unet import PlaneUNet
from .voxels import PLANES, PointVoxelConv, scatter_to_planes

Tensor = Any
_CHUNK = 8192


class PointEncoder(nn.Module):  # type: ignore[misc]
    """Only the first of the release's four layers: it throws the others' results away."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.encoder = nn.ModuleList([PointVoxelConv(channels)])


class PointsToPlanes(nn.Module):  # type: ignore[misc]
    """Points to three planes."""

    def __init__(self, shape: PartFieldShape) -> None:
        super().__init__()
        self.resolution = shape.resolution
        self.pc_encoder = PointEncoder(shape.channels)
        self.unet_encoder = PlaneUNet(shape.channels, shape.unet)

    def forward(self, points: Tensor) -> Tensor:
        """Map [n, 3] within [-1, 1]^3 to [1, 3, channels, resolution, resolution]."""
        features = self.pc_encoder.encoder[0](points)
        return self.unet_encoder(
            scatter_to_planes(points, features[0].T.to(points.dtype), self.resolution)
        )


class PartFieldEncoder(nn.Module):  # type: ignore[misc]
    """Points to a field of features on three planes, with the tensor names of the release."""

    def __init__(self, shape: PartFieldShape) -> None:
        super().__init__()
        self.shape = shape
        self.pvcnn = PointsToPlanes(shape)
        self.triplane_transformer = TriplaneTransformer(shape)

    def forward(self, points: Tensor) -> Tensor:
        """Return the field of a cloud.

        A point's feature depends on the whole cloud, so another sample of the same shape gives
        others.

        Args:
            points: within [-0.9, 0.9]^3, shape [n, 3].

        Returns:
            Planes xy, yz and xz, shape [3, features, resolution, resolution].
        """
        planes = self.triplane_transformer(self.pvcnn(points))
        return planes[0, :, self.shape.sdf_channels :]


def sample_field(planes: Tensor, points: Tensor) -> Tensor:
    """Return the features of points, the sum of what the three planes say.

    Args:
        planes: of the field, shape [3, features, resolution, resolution].
        points: in the frame of the cloud that made the field, shape [n, 3].

    Returns:
        [n, features], float32.
    """
    features = torch.zeros(len(points), planes.shape[1], dtype=torch.float32, device=planes.device)
    for plane, (first, second) in zip(planes.float(), PLANES, strict=True):
        for start in range(0, len(points), _CHUNK):
            places = points[start : start + _CHUNK, [first, second]][None, None]
            found = F.grid_sample(
                plane[None], places, mode="bilinear", padding_mode="border", align_corners=True
            )
            features[start : start + _CHUNK] += found[0, :, 0].T
    return features
