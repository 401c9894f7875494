"""What a checkpoint's tensors tell about its network, and what is said when they tell nonsense."""

import re
import subprocess
import sys
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
    "name", ["feat_proj.bias", "blocks.1.attn2.to_k.weight", "revolute_motion_decoder.2.bias"]
)
def test_a_missing_tensor_is_named(name):
    tensors = expected_tensors(TINY)
    del tensors[name]
    with pytest.raises(ConfigError, match=re.escape(f"{name}: missing")):
        read_shape(tensors)


@pytest.mark.parametrize(
    "name", ["blocks.0.norm1.bias", "point_mask_decoder.0.weight", "part_id_embed.mlp.0.weight"]
)
def test_a_tensor_of_another_shape_is_named_with_both_shapes(name):
    tensors = expected_tensors(TINY)
    want = list(tensors[name])
    tensors[name] = (3, *tensors[name][1:])
    with pytest.raises(ConfigError) as caught:
        read_shape(tensors)
    assert name in str(caught.value)
    assert str([3, *want[1:]]) in str(caught.value)
    assert str(want) in str(caught.value)


def test_an_unknown_tensor_is_named():
    with pytest.raises(ConfigError, match=r"text_proj\.weight: no such tensor"):
        read_shape({**expected_tensors(TINY), "text_proj.weight": (16, 16)})


@pytest.mark.parametrize(
    "tensors", [{}, {"conv1.weight": (64, 3, 7, 7)}, {"pos_embed.mlp.2.weight": ()}]
)
def test_a_foreign_checkpoint_is_refused_by_the_tensor_it_lacks(tensors):
    with pytest.raises(ConfigError, match=r"pos_embed\.mlp\.2\.weight"):
        read_shape(tensors)


def test_a_block_number_costs_nothing():
    tensors = {**expected_tensors(TINY), "blocks.999999999.norm1.weight": (16,)}
    with pytest.raises(ConfigError, match=r"blocks\.2\.norm1\.weight: missing"):
        read_shape(tensors)


def test_no_torch_before_a_model_is_loaded():
    loading = "asset_factory.factory.models.particulate.loading"
    code = f"import sys, {loading}; sys.exit('torch' in sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


@pytest.mark.parametrize(
    ("name", "shape", "width"),
    [("blocks.0.attn1.norm_q.weight", (5,), 16), ("pos_embed.mlp.2.weight", (0, 0), 0)],
)
def test_heads_that_do_not_divide_the_width_are_refused(name, shape, width):
    with pytest.raises(ConfigError, match=f"do not divide the width {width}"):
        read_shape({**expected_tensors(TINY), name: shape})
