"""What a checkpoint's tensors tell about its network, and what is said when they tell nonsense."""

import re
from dataclasses import replace

import pytest
import torch  # noqa: TID253

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.network.shape import (
    AxisForm,
    NetworkShape,
    expected_tensors,
    parameter_count,
    read_shape,
)
from asset_factory.factory.models.network.transformer import PartArticulationTransformer

TINY = NetworkShape(hidden=16, blocks=2, heads=2, features=6)
#: The paper's sizes; B is the released one.
SIZES = [
    NetworkShape(hidden=384, blocks=6, heads=6),
    NetworkShape(hidden=768, blocks=6, heads=12),
    NetworkShape(hidden=1024, blocks=12, heads=16),
    NetworkShape(hidden=1152, blocks=14, heads=16),
]
VARIANTS = [
    TINY,
    replace(TINY, features=0),
    replace(TINY, normals=False),
    replace(TINY, raw_coords=False),
    replace(TINY, axis_form=AxisForm.PLUCKER),
    replace(TINY, hypotheses=3),
    replace(TINY, blocks=12, heads=4),
    replace(TINY, max_parts=9),
]
LACKING = ("feat_proj.bias", "blocks.1.attn2.to_k.weight", "revolute_motion_decoder.2.bias")


@pytest.mark.parametrize("shape", [*SIZES, *VARIANTS])
def test_every_size_and_variant_has_exactly_its_tensors_and_is_read_back_from_them(shape):
    assert read_shape(expected_tensors(shape), shape.max_parts) == shape
    with torch.device("meta"):
        tensors = PartArticulationTransformer(shape).state_dict()
    assert {name: (*each.shape,) for name, each in tensors.items()} == expected_tensors(shape)


def test_the_released_size_has_as_many_numbers_as_the_published_file():
    # The published model.pt takes 605,383,018 bytes: four per number, and 82 kB of names.
    tensors = expected_tensors(NetworkShape())
    assert (len(tensors), parameter_count(tensors)) == (272, 151_325_203)


@pytest.mark.parametrize(
    ("name", "shape", "told"),
    [
        *((name, None, f"{name}: missing") for name in LACKING),
        ("blocks.0.norm1.bias", (3,), "blocks.0.norm1.bias: shape [3], want [16]"),
        ("point_mask_decoder.0.weight", (3, 32), "decoder.0.weight: shape [3, 32], want [64, 32]"),
        ("text_proj.weight", (16, 16), "text_proj.weight: no such tensor"),
        # A block's number costs nothing.
        ("blocks.999999999.norm1.weight", (16,), "blocks.2.norm1.weight: missing"),
        ("blocks.0.attn1.norm_q.weight", (5,), "do not divide the width 16"),
        ("pos_embed.mlp.2.weight", (0, 0), "do not divide the width 0"),
    ],
)
def test_a_tensor_that_is_missing_or_another_is_named(name, shape, told):
    tensors = {**expected_tensors(TINY), name: shape}
    with pytest.raises(ConfigError, match=re.escape(told)):
        read_shape({name: tensors[name] for name in tensors if tensors[name] is not None})


@pytest.mark.parametrize(
    "tensors", [{}, {"conv1.weight": (64, 3, 7, 7)}, {"pos_embed.mlp.2.weight": ()}]
)
def test_a_foreign_checkpoint_is_refused_by_the_tensor_it_lacks(tensors):
    with pytest.raises(ConfigError, match=r"pos_embed\.mlp\.2\.weight"):
        read_shape(tensors)
