"""PartField's encoder, piece by piece."""

from dataclasses import replace

import numpy as np
import pytest
import torch  # noqa: TID253
from tiny_model import TINY_FIELD as TINY
from weight_rule import weights

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.partfield.encoder import (
    GRID,
    PartFieldEncoder,
    PointVoxelConv,
    sample_field,
    scatter_mean,
    scatter_to_planes,
    voxelize,
)
from asset_factory.factory.models.partfield.shape import (
    PartFieldShape,
    expected_tensors,
    read_partfield_shape,
)
from asset_factory.factory.models.partfield.unet import PlaneExchange
from asset_factory.factory.models.particulate.field import FeatureField


def field(shape=TINY):
    encoder = PartFieldEncoder(shape)
    encoder.load_state_dict(weights(expected_tensors(shape), 0))
    return FeatureField(shape, torch.float32, "cpu", encoder.eval().requires_grad_(False))


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


def test_channels_that_cannot_be_normed_in_groups_are_refused():
    with pytest.raises(ConfigError, match="40 channels do not divide into 32 groups"):
        read_partfield_shape(expected_tensors(replace(TINY, channels=40)))


def test_what_lacks_layers_is_refused():
    tensors = expected_tensors(TINY)
    others = {name: tensors[name] for name in tensors if "transformer.layers" not in name}
    with pytest.raises(ConfigError, match="no PartField"):
        read_partfield_shape(others)


def test_scattered_means_are_means():
    values = torch.tensor([[1.0, 10.0], [3.0, 30.0], [5.0, 50.0]])
    means = scatter_mean(values, torch.tensor([2, 2, 0]), 4)
    assert means.tolist() == [[5.0, 50.0], [0.0, 0.0], [2.0, 20.0], [0.0, 0.0]]


def test_voxels_have_the_axes_x_y_z_and_round_half_to_even():
    cells = torch.tensor([[1.5, 2.5, 3.0], [0.0, 0.0, 31.0]])
    volume = voxelize(torch.tensor([[7.0], [9.0]]), cells)
    assert volume.shape == (1, 1, GRID, GRID, GRID)
    assert volume.nonzero()[:, 2:].tolist() == [[0, 0, 31], [2, 2, 3]]
    assert volume[0, 0, 2, 2, 3] == 7.0


def test_rows_of_a_plane_follow_its_second_coordinate():
    # The point is at cells 0, 3, 7 of 8 along x, y, z.
    planes = scatter_to_planes(torch.tensor([[-1.0, -0.1, 1.0]]), torch.tensor([[4.0]]), 8)
    wanted = [[[3, 0]], [[7, 3]], [[7, 0]]]
    assert [plane.nonzero()[:, 1:].tolist() for plane in planes[0]] == wanted


def test_points_look_their_voxels_up_with_x_and_z_exchanged():
    layer = PointVoxelConv(4).eval()
    layer.voxel_layers = torch.nn.Identity()
    layer.point_features.layers = torch.nn.Threshold(1e9, 0.0)
    corner = [-1.0, 0.0, 1.0]
    other = [0.5, 0.25, -0.5]
    with torch.no_grad():
        found = layer(torch.tensor([corner, other, [1.0, 0.0, -1.0]]))[0, :3].T
    # The first point finds what the third one left at the mirrored place, as the release does.
    np.testing.assert_allclose(found[0], [1.0, 0.0, -1.0], atol=1e-6)
    np.testing.assert_allclose(found[2], corner, atol=1e-6)


def test_a_plane_hears_of_its_column_and_row_from_the_others():
    exchange = PlaneExchange(1)
    for conv, kernel in zip(exchange.plane_convs, ([0, 1, 0], [0, 0, 1], [1, 0, 0]), strict=True):
        weight = torch.tensor(kernel, dtype=torch.float32).reshape(1, 3, 1, 1)
        conv.weight = torch.nn.Parameter(weight)
        torch.nn.init.zeros_(conv.bias)
    first, second, third = torch.tensor(np.random.default_rng(0).normal(size=(3, 4, 4)))
    with torch.no_grad():
        found = exchange(torch.cat([first, second, third]).float()[None, None])[0, 0].split(4)
    np.testing.assert_allclose(found[0], second.mean(dim=1)[None, :].expand(4, 4), atol=1e-6)
    np.testing.assert_allclose(found[1], first.mean(dim=0)[:, None].expand(4, 4), atol=1e-6)
    np.testing.assert_allclose(found[2], third, atol=1e-6)


def test_a_field_is_read_bilinearly_and_summed_over_planes():
    axis = torch.linspace(-1.0, 1.0, 5)
    columns = axis[None, :].expand(5, 5)
    rows = axis[:, None].expand(5, 5)
    planes = torch.stack([columns, 10.0 * rows, 100.0 * columns])[:, None]
    points = torch.tensor([[0.3, -0.7, 0.2], [-0.9, 0.1, 0.8]])
    wanted = points[:, 0] + 10.0 * points[:, 2] + 100.0 * points[:, 0]
    np.testing.assert_allclose(sample_field(planes, points)[:, 0], wanted, rtol=1e-5)


def test_features_do_not_depend_on_where_the_shape_is_or_how_large():
    cloud = np.random.default_rng(3).uniform(-0.5, 0.5, (400, 3)) * [1.0, 0.5, 0.7]
    here = field().features(cloud, cloud[:50])
    there = field().features(4.0 * cloud + [8.0, -4.0, 2.0], 4.0 * cloud[:50] + [8.0, -4.0, 2.0])
    assert here.shape == (50, 8)
    # Rounding may move a point over a cell's edge.
    assert np.median(np.abs(here - there)) < 1e-3 * np.abs(here).max()


def test_features_depend_on_the_whole_cloud():
    cloud = np.random.default_rng(3).uniform(-0.5, 0.5, (400, 3))
    whole, half = (field().features(each, cloud[:9]) for each in (cloud, cloud[:200]))
    assert not np.allclose(whole, half, atol=1e-3)


def test_a_cloud_without_extent_still_has_features():
    assert np.isfinite(field().features(np.ones((5, 3)), np.ones((2, 3)))).all()
