"""PartField's encoder, piece by piece."""

from dataclasses import replace

import numpy as np
import pytest
import torch  # noqa: TID253
from tiny_model import TINY_FIELD as TINY
from tiny_model import field_of

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.partfield.encoder import GRID, PartFieldEncoder, voxelize
from asset_factory.factory.models.partfield.shape import (
    PartFieldShape,
    expected_tensors,
    read_partfield_shape,
)


@pytest.mark.parametrize(
    "shape", [PartFieldShape(), TINY, replace(TINY, layers=3, unet=(16, 8, 4), width=32)]
)
def test_the_shape_is_read_back_and_is_the_networks(shape):
    assert read_partfield_shape(expected_tensors(shape)) == shape
    with torch.device("meta"):
        tensors = PartFieldEncoder(shape).state_dict()
    assert {name: (*each.shape,) for name, each in tensors.items()} == expected_tensors(shape)


@pytest.mark.parametrize(
    ("name", "size", "says"),
    [
        ("triplane_transformer.pos_embed", (1, 13, 16), "13 tokens are not three square planes"),
        ("triplane_transformer.pos_embed", (16,), "want 3 dimensions"),
        ("triplane_transformer.pos_embed", (1, 12, 15), "width 15 does not divide into 8 heads"),
        ("pvcnn.unet_encoder.norm_out.bias", (9,), r"shape \[9\], want \[8\]"),
        ("pvcnn.extra.weight", (9,), "no such tensor"),
    ],
)
def test_a_wrong_tensor_is_named(name, size, says):
    with pytest.raises(ConfigError, match=f"{name}.*{says}"):
        read_partfield_shape({**expected_tensors(TINY), name: size})


def test_what_cannot_be_normed_in_groups_or_lacks_layers_is_refused():
    with pytest.raises(ConfigError, match="40 channels do not divide into 32 groups"):
        read_partfield_shape(expected_tensors(replace(TINY, channels=40)))
    tensors = expected_tensors(TINY)
    others = {name: tensors[name] for name in tensors if "transformer.layers" not in name}
    with pytest.raises(ConfigError, match="no PartField"):
        read_partfield_shape(others)


def test_voxels_have_the_axes_x_y_z_and_round_half_to_even():
    cells = torch.tensor([[1.5, 2.5, 3.0], [0.0, 0.0, 31.0]])
    volume = voxelize(torch.tensor([[7.0], [9.0]]), cells)
    assert volume.shape == (1, 1, GRID, GRID, GRID)
    assert volume.nonzero()[:, 2:].tolist() == [[0, 0, 31], [2, 2, 3]]
    assert volume[0, 0, 2, 2, 3] == 7.0


def test_features_do_not_depend_on_where_the_shape_is_or_how_large():
    cloud = np.random.default_rng(3).uniform(-0.5, 0.5, (400, 3)) * [1.0, 0.5, 0.7]
    here = field_of(TINY).features(cloud, cloud[:50])
    there = field_of(TINY).features(
        4.0 * cloud + [8.0, -4.0, 2.0], 4.0 * cloud[:50] + [8.0, -4.0, 2.0]
    )
    assert here.shape == (50, 8)
    # Rounding may move a point over a cell's edge.
    assert np.median(np.abs(here - there)) < 1e-3 * np.abs(here).max()


def test_a_cloud_without_extent_still_has_features():
    assert np.isfinite(field_of(TINY).features(np.ones((5, 3)), np.ones((2, 3)))).all()
