"""The same numbers as the original networks: logits, features, closest points, loss inputs.

A GPU says the same, up to what its precision rounds off.
"""

import json
from pathlib import Path

import numpy as np
import pytest
import torch  # noqa: TID253
from ray_calls import answer
from stored_arrays import OUTPUTS
from tiny_checkpoint import write_checkpoint
from tiny_model import field_of, model_of

from asset_factory.factory.config import ParticulateConfig
from asset_factory.factory.models.network.shape import NetworkShape, read_shape
from asset_factory.factory.models.partfield.shape import PartFieldShape, read_partfield_shape
from asset_factory.factory.models.particulate.field import load_field
from asset_factory.factory.models.particulate.model import PointCloud, load_model

KEPT = Path(__file__).with_name("parity.npz")
TINY = NetworkShape(hidden=48, blocks=2, heads=4, features=32)
TINY_FIELD = PartFieldShape(
    channels=32, resolution=16, width=64, layers=2, heads=4, plane_channels=96
)
GAINS = {"point_mask_decoder": 5.0, "part_motion_classifier": 3.0, "part_hierarchy_decoder": 2.0}
CLOSE = {"rtol": 1e-4, "atol": 2e-4}


def case(file, prefix=""):
    """The arrays of one object, without the batch."""
    with np.load(file) as arrays:
        names = [name for name in arrays.files if name.startswith(prefix)]
        found = {name.removeprefix(prefix): arrays[name] for name in names}
    return found if prefix else {name: array[0] for name, array in found.items()}


def assert_same(prediction, wanted):
    for name, original in OUTPUTS.items():
        found = getattr(prediction, name)
        np.testing.assert_allclose(found, wanted[original], err_msg=name, **CLOSE)
    assert np.array_equal(prediction.mask_logits.argmax(1), wanted["part_ids_argmax"])
    closest = wanted["closest_point_on_axis"]
    np.testing.assert_allclose(prediction.closest_points, closest, **CLOSE)


def cloud_of(wanted):
    return PointCloud(wanted["xyz"], wanted["normals"], wanted["feats"])


def test_the_transformer_says_what_the_original_said():
    wanted = case(KEPT, "transformer_")
    assert_same(model_of(TINY, GAINS).predict(cloud_of(wanted)), wanted)


def test_the_features_are_the_originals():
    wanted = case(KEPT, "partfield_")
    features = field_of(TINY_FIELD).features(wanted["points_enc"], wanted["points_dec"])
    np.testing.assert_allclose(features, wanted["point_feat"], **CLOSE)


def test_features_in_bfloat16_stay_within_two_percent():
    wanted = case(KEPT, "partfield_")
    field = field_of(TINY_FIELD, torch.bfloat16)
    features = field.features(wanted["points_enc"], wanted["points_dec"])
    error = np.linalg.norm(features - wanted["point_feat"]) / np.linalg.norm(wanted["point_feat"])
    assert 1e-5 < error < 0.02


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_stored_tiny_weights_say_what_the_original_said(fixtures, seed):
    model = load_model(str(fixtures / "pat_tiny" / f"weights_seed{seed}.safetensors"))
    assert model.shape == TINY
    wanted = case(fixtures / "pat_tiny" / f"forward_seed{seed}.npz")
    assert_same(model.predict(cloud_of(wanted)), wanted)


def test_the_released_size_says_what_the_original_said(fixtures):
    folder = fixtures / "pat_b_full"
    keys = json.loads((folder / "config_and_keys.json").read_text())["keys"]
    shape = read_shape({name: tuple(size) for name, size in keys.items()})
    assert shape == NetworkShape()
    wanted = case(folder / "forward_base0.npz")
    assert_same(model_of(shape, GAINS).predict(cloud_of(wanted)), wanted)


def test_stored_tiny_field_is_the_originals(fixtures):
    field = load_field(str(fixtures / "partfield_tiny" / "weights_base0.safetensors"), heads=4)
    assert field.shape == TINY_FIELD
    wanted = case(fixtures / "partfield_tiny" / "case_base0.npz")
    features = field.features(wanted["points_enc"], wanted["points_dec"])
    np.testing.assert_allclose(features, wanted["point_feat"], **CLOSE)


@pytest.mark.full
def test_the_released_field_is_the_originals(fixtures):
    folder = fixtures / "partfield_full"
    keys = json.loads((folder / "config_and_keys.json").read_text())["keys"]
    shape = read_partfield_shape({name: tuple(size) for name, size in keys.items()})
    assert shape == PartFieldShape()
    wanted = case(folder / "case_base0.npz")
    features = field_of(shape).features(wanted["points_enc"], wanted["points_dec"])
    np.testing.assert_allclose(features, wanted["point_feat"], **CLOSE)


@pytest.mark.full
def test_the_released_size_in_bfloat16_stays_within_two_percent(fixtures):
    wanted = case(fixtures / "pat_b_full" / "forward_base0.npz")
    prediction = model_of(NetworkShape(), GAINS, torch.bfloat16).predict(cloud_of(wanted))
    for name, original in OUTPUTS.items():
        largest = max(1.0, np.abs(wanted[original]).max())
        assert np.abs(getattr(prediction, name) - wanted[original]).max() < 0.02 * largest, name
    clear = wanted["mask_margin"] > 0.05 * np.abs(wanted["point_mask_logits"]).max()
    assert np.array_equal(prediction.mask_logits.argmax(1)[clear], wanted["part_ids_argmax"][clear])


@pytest.mark.skipif(not torch.cuda.is_available(), reason="torch sees no CUDA device")
@pytest.mark.parametrize(("precision", "share"), [("float32", 1e-3), ("bfloat16", 0.02)])
def test_a_gpu_says_what_a_processor_says(tmp_path, precision, share):
    checkpoint = str(write_checkpoint(tmp_path / "tiny.safetensors", base=7))
    settings = {"checkpoint": checkpoint, "points": 300, "context_points": 300}
    here, there = (
        np.frombuffer(answer(ParticulateConfig(**settings, **more), None)[0], np.float32)
        for more in ({}, {"device": "cuda", "precision": precision})
    )
    assert np.abs(there - here).max() < share * max(np.abs(here).max(), 1.0)
