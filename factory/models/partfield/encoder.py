"""PartField's encoder: by voxels a cloud makes a field, which gives any point a feature."""

from __future__ import annotations

from typing import Any

import torch  # noqa: TID253 - this module is only imported to make the encoder
import torch.nn.functional as F  # noqa: N812, TID253
from torch import nn  # noqa: TID253

from ..network.layers import named
from .shape import POINT_CHANNELS, SDF_CHANNELS, PartFieldShape
from .unet import PlaneUNet

Tensor = Any
_CHUNK = 8192
_EPS = 1e-6
#: Voxels along each edge of the cube, and the axes of the planes that they are seen on.
GRID = 32
PLANES = ((0, 1), (1, 2), (0, 2))
_VOXEL_EPS = 1e-4
_PLANE_MARGIN = 1e-5


class SelfAttention(nn.Module):  # type: ignore[misc]
    """Attention among all cells, without biases, with torch's names for its tensors.

    Torch's own module multiplies a batch of one in a layout that takes bfloat16 element by element.
    """

    def __init__(self, width: int, heads: int) -> None:
        super().__init__()
        self.heads = heads
        self.in_proj_weight = nn.Parameter(torch.zeros(3 * width, width))
        self.out_proj = nn.Linear(width, width, bias=False)

    def forward(self, tokens: Tensor) -> Tensor:
        """Map [n, width] to the same."""
        sides = F.linear(tokens, self.in_proj_weight).unflatten(1, (3, self.heads, -1))
        sides = sides.permute(1, 2, 0, 3)
        found = F.scaled_dot_product_attention(*sides[:, None].unbind(0))
        return self.out_proj(found[0].transpose(0, 1).flatten(1))


class Layer(nn.Module):  # type: ignore[misc]
    """Attention among all cells and a perceptron, each on normalised tokens."""

    def __init__(self, width: int, heads: int) -> None:
        super().__init__()
        self.norm1 = nn.LayerNorm(width, eps=_EPS)
        self.norm2 = nn.LayerNorm(width, eps=_EPS)
        self.self_attn = SelfAttention(width, heads)
        # The third place is a dropout's, which has no tensors; it keeps the last layer's number.
        self.mlp = nn.Sequential(
            nn.Linear(width, 4 * width), nn.GELU(), nn.Identity(), nn.Linear(4 * width, width)
        )

    def forward(self, tokens: Tensor) -> Tensor:
        """Map [n, width] to the same."""
        tokens = tokens + self.self_attn(self.norm1(tokens))
        return tokens + self.mlp(self.norm2(tokens))


class TriplaneTransformer(nn.Module):  # type: ignore[misc]
    """Planes four times coarser, through the transformer, upsampled and added to the input."""

    def __init__(self, shape: PartFieldShape) -> None:
        super().__init__()
        wide = shape.width
        planes = shape.plane_channels
        self.shape = shape
        self.pos_embed = nn.Parameter(torch.zeros(1, 3 * shape.coarse**2, wide))
        self.downsampler = nn.Sequential(
            nn.Conv2d(shape.channels, wide, 3, padding=1),
            nn.ReLU(inplace=True),
            nn.MaxPool2d(2),
            nn.Conv2d(wide, wide, 3, padding=1),
            nn.ReLU(inplace=True),
            nn.MaxPool2d(2),
        )
        layers = (Layer(wide, shape.heads) for _ in range(shape.layers))
        self.transformer = named(layers=nn.Sequential(*layers), norm=nn.LayerNorm(wide, eps=_EPS))
        self.upsampler = nn.ConvTranspose2d(wide, planes, 4, stride=4)
        self.mlp = nn.Sequential(
            nn.Linear(shape.channels, planes), nn.ReLU(inplace=True), nn.Linear(planes, planes)
        )

    def forward(self, planes: Tensor) -> Tensor:
        """Map [1, 3, channels, n, n] to [1, 3, plane_channels, n, n]."""
        # One plane at a time: the first layer's result takes 67 MB per plane at the released size.
        coarse = torch.cat([self.downsampler(plane) for plane in planes.unbind(1)])
        tokens = coarse.flatten(2).transpose(1, 2).reshape(-1, self.shape.width)
        tokens = self.transformer(tokens + self.pos_embed[0])
        coarse = tokens.reshape(3, -1, self.shape.width).transpose(1, 2)
        coarse = coarse.unflatten(2, (self.shape.coarse, -1))
        cells = self.mlp(planes[0].permute(0, 2, 3, 1).contiguous()).permute(0, 3, 1, 2)
        return (self.upsampler(coarse) + cells)[None]


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
        # A layer per point, normalised over the whole cloud.
        alone = nn.Conv1d(POINT_CHANNELS, channels, 1)
        self.point_features = named(
            layers=nn.Sequential(alone, nn.InstanceNorm1d(channels), nn.ReLU())
        )

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
    means = scatter_mean(inputs, (x * GRID + y) * GRID + z, GRID**3)
    return means.T.reshape(1, -1, GRID, GRID, GRID)


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


class PointsToPlanes(nn.Module):  # type: ignore[misc]
    """Points to three planes."""

    def __init__(self, shape: PartFieldShape) -> None:
        super().__init__()
        self.resolution = shape.resolution
        # Only the first of the release's four layers: it throws the others' results away.
        self.pc_encoder = named(encoder=nn.Sequential(PointVoxelConv(shape.channels)))
        self.unet_encoder = PlaneUNet(shape.channels, shape.unet)

    def forward(self, points: Tensor) -> Tensor:
        """Map [n, 3] within [-1, 1]^3 to [1, 3, channels, resolution, resolution]."""
        found = self.pc_encoder(points)[0].T.to(points.dtype)
        return self.unet_encoder(scatter_to_planes(points, found, self.resolution))


class PartFieldEncoder(nn.Module):  # type: ignore[misc]
    """Points to a field of features on three planes, with the tensor names of the release."""

    def __init__(self, shape: PartFieldShape) -> None:
        super().__init__()
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
        return planes[0, :, SDF_CHANNELS:]


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
