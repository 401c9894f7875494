"""What a PartField checkpoint holds, read off the names and shapes of its tensors."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

from ...errors import ConfigError
from ..network.shape import Shape, check_tensors, dimensions_of, layer

POINT_CHANNELS = 8
NORM_GROUPS = 32
#: The first channels of the finished planes hold a distance field and no features; no tensor tells.
SDF_CHANNELS = 64
# Heads of the training losses and three layers whose result the release computes and throws away.
_LAYERS = tuple(f"pvcnn.pc_encoder.encoder.{number}." for number in (1, 2, 3))
UNUSED = ("logit_scale", "sdf_decoder.", *_LAYERS)


@dataclass(frozen=True)
class PartFieldShape:
    """Everything that decides the tensors that PartField's encoder uses.

    Attributes:
        channels: of points and planes before the transformer.
        unet: channels of the U-Net per level, finest first.
        resolution: cells along each side of a plane.
        width: of the transformer's tokens.
        layers: of the transformer.
        heads: of its attention; no tensor tells.
        plane_channels: of the finished planes.
    """

    channels: int = 256
    unet: tuple[int, ...] = (32, 64, 128)
    resolution: int = 128
    width: int = 1024
    layers: int = 6
    heads: int = 8
    plane_channels: int = 512

    @property
    def features(self) -> int:
        """Return the channels of a point's feature."""
        return self.plane_channels - SDF_CHANNELS

    @property
    def coarse(self) -> int:
        """Return the tokens along each side of a plane."""
        return self.resolution // 4


def read_partfield_shape(tensors: Mapping[str, Shape], heads: int = 8) -> PartFieldShape:
    """Return the encoder that a checkpoint was saved from.

    ``tensors`` are shapes by name; none tells the transformer's ``heads``.

    Raises:
        ConfigError: a tensor is missing, unknown, or of an impossible shape.
    """
    sizes = partial(dimensions_of, tensors, "PartField")
    place = "triplane_transformer.pos_embed"
    tokens, width = sizes(place, 3)[1:]
    coarse = math.isqrt(tokens // 3)
    if tokens != 3 * coarse**2:
        raise ConfigError(f"{place}: {tokens} tokens are not three square planes")
    if width % heads:
        raise ConfigError(f"{place}: width {width} does not divide into {heads} heads")
    levels: list[int] = []
    while (name := f"pvcnn.unet_encoder.down_convs.{len(levels)}.block.conv1.weight") in tensors:
        levels.append(sizes(name, 4)[0])
    layers = 0
    while f"triplane_transformer.transformer.layers.{layers}.norm1.weight" in tensors:
        layers += 1
    shape = PartFieldShape(
        channels=sizes("pvcnn.pc_encoder.encoder.0.voxel_layers.0.weight", 5)[0],
        unet=tuple(levels),
        resolution=4 * coarse,
        width=width,
        layers=layers,
        heads=heads,
        plane_channels=sizes("triplane_transformer.upsampler.weight", 4)[1],
    )
    if not levels or not layers or shape.features <= 0 or shape.resolution % 2 ** (len(levels) - 1):
        raise ConfigError(f"this is no PartField: it would be {shape}")
    joined = (fine + coarse for fine, coarse in itertools.pairwise(shape.unet))
    normed = (shape.channels, *shape.unet, *joined)
    uneven = [wide for wide in normed if not wide or wide % min(NORM_GROUPS, wide)]
    if uneven:
        why = f"{uneven[0]} channels do not divide into {NORM_GROUPS} groups"
        raise ConfigError(f"pvcnn.unet_encoder: {why}")
    used = {name: size for name, size in tensors.items() if not name.startswith(UNUSED)}
    check_tensors(used, expected_tensors(shape), "PartField")
    return shape


def expected_tensors(shape: PartFieldShape) -> dict[str, Shape]:
    """Name to shape of every tensor the encoder uses."""
    wide = shape.width
    channels = shape.channels
    planes = shape.plane_channels
    voxels = "pvcnn.pc_encoder.encoder.0"
    tensors = layer(f"{voxels}.voxel_layers.0", (channels, POINT_CHANNELS, 3, 3, 3))
    tensors |= layer(f"{voxels}.voxel_layers.3", (channels, channels, 3, 3, 3))
    tensors |= layer(f"{voxels}.point_features.layers.0", (channels, POINT_CHANNELS, 1))
    tensors |= _unet_tensors("pvcnn.unet_encoder", shape)
    at = "triplane_transformer"
    tensors[f"{at}.pos_embed"] = (1, 3 * shape.coarse**2, wide)
    for number in range(shape.layers):
        own = f"{at}.transformer.layers.{number}"
        tensors |= layer(f"{own}.norm1", (wide,)) | layer(f"{own}.norm2", (wide,))
        tensors[f"{own}.self_attn.in_proj_weight"] = (3 * wide, wide)
        tensors[f"{own}.self_attn.out_proj.weight"] = (wide, wide)
        tensors |= layer(f"{own}.mlp.0", (4 * wide, wide))
        tensors |= layer(f"{own}.mlp.3", (wide, 4 * wide))
    tensors |= layer(f"{at}.transformer.norm", (wide,))
    tensors |= layer(f"{at}.downsampler.0", (wide, channels, 3, 3))
    tensors |= layer(f"{at}.downsampler.3", (wide, wide, 3, 3))
    tensors |= {f"{at}.upsampler.weight": (wide, planes, 4, 4), f"{at}.upsampler.bias": (planes,)}
    tensors |= layer(f"{at}.mlp.0", (planes, channels))
    return tensors | layer(f"{at}.mlp.2", (planes, planes))


def _unet_tensors(at: str, shape: PartFieldShape) -> dict[str, Shape]:
    levels = shape.unet
    tensors = dict[str, Shape]()
    for level, (inner, outer) in enumerate(zip((shape.channels, *levels), levels, strict=False)):
        tensors |= _res_tensors(f"{at}.down_convs.{level}.block", inner, outer)
    for step, outer in enumerate(reversed(levels[:-1])):
        joined = levels[-1 - step] + outer
        tensors |= layer(f"{at}.up_convs.{step}.norm1", (joined,))
        tensors |= _res_tensors(f"{at}.up_convs.{step}.block", joined, outer)
    tensors |= layer(f"{at}.norm_out", (levels[0],))
    return tensors | layer(f"{at}.conv_final", (shape.channels, levels[0], 1, 1))


def _res_tensors(at: str, inputs: int, outputs: int) -> dict[str, Shape]:
    tensors = layer(f"{at}.norm1", (inputs,)) | layer(f"{at}.conv1", (outputs, inputs, 3, 3))
    tensors |= layer(f"{at}.norm_mid", (outputs,)) | layer(f"{at}.norm2", (outputs,))
    for plane in range(3):
        tensors |= layer(f"{at}.conv_3daware.plane_convs.{plane}", (outputs, 3 * outputs, 1, 1))
    tensors |= layer(f"{at}.conv2", (outputs, outputs, 3, 3))
    if inputs != outputs:
        tensors |= layer(f"{at}.nin_shortcut", (outputs, inputs, 1, 1))
    return tensors
