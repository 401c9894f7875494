"""What kind of network a checkpoint holds, read off the names and shapes of its tensors."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import partial
from typing import Any

from ...errors import ConfigError

Shape = tuple[int, ...]

FREQUENCIES = 32
PARTFIELD_CHANNELS = 448
_BLOCK = re.compile(r"blocks\.(\d+)\.")
_HYPOTHESIS = re.compile(r"point_mask_decoder\.(\d+)\.0\.weight")


class AxisForm(StrEnum):
    """How a network says where a part's axis of rotation is."""

    CLOSEST_POINTS = "per_point_closest"
    PLUCKER = "per_part_plucker"


@dataclass(frozen=True)
class NetworkShape:
    """Everything that decides the tensors of a Part Articulation Transformer.

    Attributes:
        hidden: width of points and queries.
        blocks: how many times points and queries look at each other.
        heads: of every attention; divides ``hidden``.
        features: channels of a point's features; 0 for a network that sees points and normals
            alone.
        normals: whether it sees normals.
        raw_coords: whether plain coordinates are appended to their sinusoids.
        axis_form: see :class:`AxisForm`.
        hypotheses: how many mask heads there are.
        max_parts: part queries; no tensor tells, so whoever loads a checkpoint says.
        mlp_ratio: width inside perceptrons, in widths of the network; 4 in the released ones.
    """

    hidden: int = 768
    blocks: int = 6
    heads: int = 12
    features: int = PARTFIELD_CHANNELS
    normals: bool = True
    raw_coords: bool = True
    axis_form: AxisForm = AxisForm.CLOSEST_POINTS
    hypotheses: int = 1
    max_parts: int = 16
    mlp_ratio: int = 4

    @property
    def mlp(self) -> int:
        """Return the width inside every two-layer perceptron."""
        return self.mlp_ratio * self.hidden

    @property
    def embedding(self) -> int:
        """Return the numbers that stand for a position or a normal before it is embedded."""
        return 3 * 2 * FREQUENCIES + (3 if self.raw_coords else 0)


def read_shape(tensors: Mapping[str, Shape], max_parts: int = 16) -> NetworkShape:
    """Return the network that a checkpoint was saved from.

    ``tensors`` are shapes by name; none tells ``max_parts``, how many part queries there are.

    Raises:
        ConfigError: a tensor that every such network has is missing, or of an impossible shape.
    """
    sizes = partial(dimensions_of, tensors, "Part Articulation Transformer")
    hidden = sizes("pos_embed.mlp.2.weight", 2)[0]
    (head_width,) = sizes("blocks.0.attn1.norm_q.weight", 1)
    if not head_width or not hidden or hidden % head_width:
        why = f"{head_width} numbers do not divide the width {hidden}"
        raise ConfigError(f"blocks.0.attn1.norm_q.weight: {why}")
    numbers = {int(match[1]) for name in tensors if (match := _BLOCK.match(name))}
    has_features = "feat_proj.weight" in tensors
    shape = NetworkShape(
        hidden=hidden,
        # Their count, not the highest: a name costs nothing and could claim a billion.
        blocks=len(numbers),
        heads=hidden // head_width,
        features=sizes("feat_proj.weight", 2)[1] if has_features else 0,
        normals="normal_embed.mlp.0.weight" in tensors,
        raw_coords=sizes("pos_embed.mlp.0.weight", 2)[1] % 2 == 1,
        axis_form=AxisForm.CLOSEST_POINTS
        if "point_motion_decoder.0.weight" in tensors
        else AxisForm.PLUCKER,
        hypotheses=max(1, sum(1 for name in tensors if _HYPOTHESIS.fullmatch(name))),
        max_parts=max_parts,
        mlp_ratio=sizes("blocks.0.mlp_x.net.2.weight", 2)[1] // hidden,
    )
    check_tensors(tensors, expected_tensors(shape), "Part Articulation Transformer")
    return shape


def dimensions_of(tensors: Mapping[str, Shape], what: str, name: str, count: int) -> Shape:
    """Return the shape of a tensor of ``count`` dimensions, which a network called ``what`` has.

    Raises:
        ConfigError: it is missing, or has another number of dimensions.
    """
    if name not in tensors:
        raise ConfigError(f"{name}: missing; this is no {what} ({len(tensors)} tensors found)")
    if len(tensors[name]) != count:
        raise ConfigError(f"{name}: shape {list(tensors[name])}, want {count} dimensions")
    return tensors[name]


def check_tensors(tensors: Mapping[str, Shape], expected: Mapping[str, Shape], what: str) -> None:
    """Check that a checkpoint has exactly the tensors a network needs.

    Raises:
        ConfigError: names the first tensor that is missing, unknown or of another shape.
    """
    for name, shape in expected.items():
        if name not in tensors:
            raise ConfigError(f"{name}: missing; a {what} needs it ({len(tensors)} tensors found)")
        if tensors[name] != shape:
            want = f"want {list(shape)} in this {what}"
            raise ConfigError(f"{name}: shape {list(tensors[name])}, {want}")
    extra = [name for name in tensors if name not in expected]
    if extra:
        raise ConfigError(f"{extra[0]}: no such tensor in a {what} ({len(extra)} unknown in all)")


def expected_tensors(shape: NetworkShape) -> dict[str, Shape]:
    """Name to shape of every tensor of a network."""
    wide = shape.hidden
    deep = shape.mlp
    tensors: dict[str, Shape] = {}
    if shape.features:
        tensors |= layer("feat_proj", (wide, shape.features))
    for name in ["pos_embed", "normal_embed"] if shape.normals else ["pos_embed"]:
        tensors |= layer(f"{name}.mlp.0", (wide, shape.embedding))
        tensors |= layer(f"{name}.mlp.2", (wide, wide))
    tensors |= layer("part_id_embed.mlp.0", (wide, 2 * FREQUENCIES))
    tensors |= layer("part_id_embed.mlp.2", (wide, wide))
    for number in range(shape.blocks):
        tensors |= _block_tensors(f"blocks.{number}", shape)
    masks = [f"point_mask_decoder.{number}" for number in range(shape.hypotheses)]
    for mask in masks if shape.hypotheses > 1 else ["point_mask_decoder"]:
        tensors |= _head(mask, 2 * wide, deep, 1)
    closest = shape.axis_form is AxisForm.CLOSEST_POINTS
    tensors |= _head("part_hierarchy_decoder", 2 * wide, deep, 1)
    tensors |= _head("part_motion_classifier", wide, deep, 4)
    tensors |= _head("revolute_motion_decoder", wide, deep, 5 if closest else 8)
    tensors |= _head("prismatic_motion_decoder", wide, deep, 5)
    if closest:
        tensors |= _head("point_motion_decoder", 2 * wide, deep, 3)
    return tensors


def parameter_count(tensors: Mapping[str, Shape]) -> int:
    """Return how many numbers those tensors hold."""
    return sum(math.prod(shape) for shape in tensors.values())


def _block_tensors(name: str, shape: NetworkShape) -> dict[str, Shape]:
    wide = shape.hidden
    deep = shape.mlp
    tensors: dict[str, Shape] = {}
    for norm in ("norm1", "norm2", "norm3", "final_norm_x", "final_norm_q"):
        tensors |= layer(f"{name}.{norm}", (wide,))
    for attention in ("attn1", "attn2", "attn3"):
        at = f"{name}.{attention}"
        tensors |= {f"{at}.norm_{side}.weight": (wide // shape.heads,) for side in "qk"}
        tensors |= {f"{at}.to_{side}.weight": (wide, wide) for side in "qkv"}
        tensors |= layer(f"{at}.to_out.0", (wide, wide))
    for perceptron in ("mlp_x", "mlp_q"):
        at = f"{name}.{perceptron}.net"
        tensors |= layer(f"{at}.0.proj", (2 * deep, wide)) | layer(f"{at}.2", (wide, deep))
    return tensors


def layer(name: str, weight: Shape) -> dict[str, Shape]:
    """Name to shape of the tensors of a layer with a bias."""
    return {f"{name}.weight": weight, f"{name}.bias": weight[:1]}


def _head(name: str, inputs: int, middle: int, outputs: int) -> dict[str, Shape]:
    return layer(f"{name}.0", (middle, inputs)) | layer(f"{name}.2", (outputs, middle))


class Precision(StrEnum):
    """Type of the products over points; norms, softmax, sums and part heads are float32 regardless.

    Nothing here chooses by the machine: the same input shall give the same numbers on every one.
    """

    FLOAT32 = "float32"
    BFLOAT16 = "bfloat16"


def product_dtype(precision: Precision | str) -> Any:
    """Return the torch type that ``precision`` means."""
    import torch

    return torch.bfloat16 if Precision(precision) is Precision.BFLOAT16 else torch.float32
