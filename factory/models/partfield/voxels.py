"""Points to features by way of a coarse grid of voxels, then to three planes."""

from __future__ import annotations

from typing import Any

import torch  # noqa: TID253 - this module is only imported to make the encoder
import torch.nn.functional as F  # noqa: N812, TID253
from torch import nn  # noqa: TID253

from .shape import POINT_CHANNELS

Tensor = Any
GRID = 32
PLANES = ((0, 1), (1, 2), (0, 2))
_VOXEL_EPS = 1e-4
_PLANE_MARGIN = 1e-5


class PointFeatures(nn.Module):  # type: ignore[misc]
    """A layer per point, normalised over the whole cloud."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.layers = nn.Sequential(
            nn.Conv1d(POINT_CHANNELS, channels, 1), nn.InstanceNorm1d(channels), nn.ReLU()
        )

    def forward(self, inputs: Tensor) -> Tensor:
        """Map [1, 8, n] to [1, channels, n]."""
        return self.layers(inputs)


class PointVoxelConv(nn.Module):  # type: ignore[misc]
    """A point's own features, plus those around it in a 32^3 grid."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.voxel_layers = nn.Sequential(
            nn.Conv3d(POINT_CHANNELS, channels, 3, padding=1),
            nn.InstanceNorm3d(channels, eps=_VOXEL_EPS),
            nn.LeakyReLU(0.1, inplace=True),
            nn.Conv3d(channels, channels, 3, padding=1),
            nn.InstanceNorm3d(channels, eps=_VOXEL_EPS),
            nn.LeakyReLU(0.1, inplace=True),
        )
        self.point_features = PointFeatures(channels)

    def forward(self, points: Tensor) -> Tensor:
        """Return the features of points within [-1, 1]^3, shape [n, 3] to [1, channels, n]."""
        inputs = torch.cat([points, 2.0 * points, torch.zeros_like(points[:, :2])], dim=1)
        cells = ((points + 1.0) / 2.0 * GRID).clamp(0.0, GRID - 1.0)
        volume = self.voxel_layers(voxelize(inputs, cells))
        # The volume's axes are x, y, z, but the sampler reads coordinates as depth-last: so the
        # release looks each point up with x and z exchanged, and its weights are trained to that.
        places = ((2.0 * cells + 1.0) / GRID - 1.0)[None, :, None, None]
        around = F.grid_sample(
            volume, places, mode="bilinear", padding_mode="border", align_corners=False
        )
        return around[..., 0, 0] + self.point_features(inputs.T[None])


def voxelize(inputs: Tensor, cells: Tensor) -> Tensor:
    """Return the mean of the inputs in every voxel, zero where there are none.

    Args:
        inputs: shape [n, channels].
        cells: in which voxel each lies, from 0 to 31, not yet rounded, shape [n, 3].

    Returns:
        [1, channels, 32, 32, 32], axes x, y, z.
    """
    x, y, z = cells.round().long().unbind(1)
    return scatter_mean(inputs, (x * GRID + y) * GRID + z, GRID**3).T.reshape(
        1, -1, GRID, GRID, GRID
    )


def scatter_to_planes(points: Tensor, features: Tensor, resolution: int) -> Tensor:
    """Return the mean feature in every cell of the planes xy, yz and xz, zero where there is none.

    Args:
        points: within [-1, 1]^3, shape [n, 3].
        features: shape [n, channels].
        resolution: cells along each side.

    Returns:
        [1, 3, channels, resolution, resolution]; rows follow a plane's second coordinate, columns
        its first.
    """
    unit = (points / 2.0 / (1.0 + _PLANE_MARGIN) + 0.5).clamp(0.0, 1.0 - _PLANE_MARGIN)
    cells = (resolution * unit).floor().long()
    planes = [
        scatter_mean(features, cells[:, first] + resolution * cells[:, second], resolution**2).T
        for first, second in PLANES
    ]
    return torch.stack(planes).reshape(1, 3, -1, resolution, resolution)


def scatter_mean(values: Tensor, index: Tensor, size: int) -> Tensor:
    """Average the rows of each index, [n, channels] to [size, channels]; zero for none."""
    sums = values.new_zeros(size, values.shape[1]).index_add_(0, index, values)
    counts = torch.bincount(index, minlength=size).clamp(min=1)
    return sums / counts[:, None]
