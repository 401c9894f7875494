"""The streamed network is the plain one, whatever the chunks, the batch or the order of points."""

from copy import deepcopy
from dataclasses import replace
from unittest.mock import patch

import numpy as np
import pytest
import torch  # noqa: TID253
from hypothesis import given, settings
from hypothesis import strategies as st
from random_network import cloud_of
from tiny_checkpoint import write_checkpoint
from tiny_model import TINY, plainly, random_cloud, tiny_model

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.network import streaming
from asset_factory.factory.models.network.layers import Attention
from asset_factory.factory.models.network.shape import AxisForm, product_dtype
from asset_factory.factory.models.network.streaming import QueryPass, drive, embed_chunks
from asset_factory.factory.models.particulate.decoding import assigned
from asset_factory.factory.models.particulate.model import Particulate, PointCloud, load_model

CLOSE = {"rtol": 1e-4, "atol": 1e-4}
PART_FIELDS = ("hierarchy_logits", "motion_logits")
PART_FIELDS += ("revolute_direction", "revolute_range", "prismatic_direction", "prismatic_range")


@pytest.mark.parametrize(
    "shape",
    [
        TINY,
        replace(TINY, features=0),
        replace(TINY, normals=False),
        replace(TINY, raw_coords=False, blocks=1),
        replace(TINY, max_parts=5),
        replace(TINY, axis_form=AxisForm.PLUCKER),
        replace(TINY, hypotheses=2),
    ],
)
def test_streamed_is_plain(shape):
    model = tiny_model(shape)
    cloud = random_cloud(777, shape)
    masks, closest, parts = plainly(model, cloud)
    prediction = model.predict(cloud)
    np.testing.assert_allclose(prediction.mask_logits, masks, **CLOSE)
    for name in PART_FIELDS:
        wanted = getattr(parts, name)[0].numpy()
        np.testing.assert_allclose(getattr(prediction, name), wanted, err_msg=name, **CLOSE)
    if shape.axis_form is AxisForm.PLUCKER:
        assert prediction.closest_points is None
        moment = parts.revolute_moment[0].numpy()
        np.testing.assert_allclose(prediction.revolute_moment, moment, **CLOSE)
    else:
        assert prediction.revolute_moment is None
        np.testing.assert_allclose(prediction.closest_points, closest, **CLOSE)


def test_of_several_mask_heads_the_first_answers():
    network = tiny_model(replace(TINY, hypotheses=2))._network
    first, second = network.point_mask_decoder
    assert network.mask_head is first
    assert not torch.equal(first[0].weight, second[0].weight)


@settings(max_examples=30)
@given(count=st.integers(1, 40), chunk=st.integers(1, 50), seed=st.integers(0, 5))
def test_chunks_do_not_matter(count, chunk, seed):
    model = tiny_model()
    cloud = random_cloud(count, seed=seed)
    inputs = (cloud.points, cloud.normals, cloud.features)
    told = []
    for size in (count, chunk):
        with patch.object(streaming, "CHUNK", size):
            embedded = embed_chunks(model._network, *inputs)
            told.append((drive(model._network, embedded, torch.float32).queries, embedded))
    for whole, parts in zip(*told, strict=True):
        np.testing.assert_allclose(whole.numpy(), parts.numpy(), **CLOSE)


def test_a_batch_is_its_clouds_one_by_one():
    model = tiny_model()
    clouds = [random_cloud(60, seed=seed) for seed in range(3)]
    rows = zip(*((each.points, each.normals, each.features) for each in clouds), strict=True)
    stacked = [torch.tensor(np.stack(row)) for row in rows]
    with torch.no_grad():
        hidden, queries = model._network(*stacked)
        masks = model._network.mask_logits(hidden, queries)
        closest = model._network.closest_points(hidden, queries, masks.argmax(-1))
    for number, cloud in enumerate(clouds):
        prediction = model.predict(cloud)
        np.testing.assert_allclose(prediction.mask_logits, masks[number].numpy(), **CLOSE)
        np.testing.assert_allclose(prediction.closest_points, closest[number].numpy(), **CLOSE)


def test_a_cloud_that_drives_itself_is_predicted():
    model = tiny_model()
    cloud = random_cloud(700)
    decoded = model.decode(model.encode(cloud), cloud)
    predicted = model.predict(cloud)
    np.testing.assert_allclose(decoded.mask_logits, predicted.mask_logits, **CLOSE)
    np.testing.assert_allclose(decoded.hierarchy_logits, predicted.hierarchy_logits, **CLOSE)
    assert np.array_equal(model.predict(cloud, driving=700).mask_logits, predicted.mask_logits)


def test_points_that_do_not_drive_are_answered_for_alone():
    model = tiny_model()
    cloud = random_cloud(700)
    driven = model.encode(random_cloud(100, seed=9))
    everything = model.decode(driven, cloud)
    some = np.array([5, 600, 17])
    alone = model.decode(driven, cloud.take(some))
    np.testing.assert_allclose(alone.mask_logits, everything.mask_logits[some], **CLOSE)


def test_few_driving_points_always_give_the_same_answer_for_all():
    model = tiny_model()
    cloud = random_cloud(700)
    few = model.predict(cloud, driving=300)
    assert few.mask_logits.shape == (700, 16)
    assert np.array_equal(few.mask_logits, model.predict(cloud, driving=300).mask_logits)
    assert not np.array_equal(few.mask_logits, model.predict(cloud).mask_logits)
    # They are a fair sample: the more of them, the closer to what all would tell.
    wanted = model.predict(cloud).motion_logits
    driven = [model.predict(cloud, driving=count).motion_logits for count in (10, 80, 640)]
    errors = [np.abs(each - wanted).max() for each in driven]
    assert errors[0] > errors[1] > errors[2] > 0.0


def test_points_of_parts_that_are_dissolved_say_where_the_axis_of_the_next_one_is():
    model = tiny_model()
    cloud = random_cloud(90)
    sure = model.predict(cloud)
    less = model.predict(cloud, least_confidence=0.4)
    assert np.array_equal(less.mask_logits, sure.mask_logits)
    owners = [assigned(sure.mask_logits, least).parts for least in (0.0, 0.4)]
    moved = owners[0] != owners[1]
    assert 0 < moved.sum() < 90
    _, closest, _ = plainly(model, cloud, owners[1])
    np.testing.assert_allclose(less.closest_points, closest, **CLOSE)
    np.testing.assert_allclose(less.closest_points[~moved], sure.closest_points[~moved], **CLOSE)
    assert (np.abs(less.closest_points - sure.closest_points)[moved].max(axis=1) > 0.0).all()


def test_bfloat16_stays_within_two_percent_of_the_largest_logit():
    cloud = random_cloud(500)
    exact = tiny_model(dtype=torch.float32).predict(cloud)
    rough = tiny_model(dtype=torch.bfloat16).predict(cloud)
    for name in ("mask_logits", *PART_FIELDS):
        wanted = getattr(exact, name)
        got = getattr(rough, name)
        assert np.abs(got - wanted).max() < 0.02 * max(np.abs(wanted).max(), 1.0), name
    assert not np.array_equal(exact.mask_logits, rough.mask_logits)


def test_logits_of_any_size_do_not_overflow_the_sums():
    attention = Attention(8, 2, 0.0).eval().requires_grad_(False)
    attention.norm_q.weight.fill_(15.0)
    attention.norm_k.weight.fill_(15.0)
    draw = np.random.default_rng(0).normal
    asking, asked = (torch.tensor(draw(size=(count, 8)), dtype=torch.float32) for count in (3, 64))
    streamed = QueryPass(attention, asking, torch.float32)
    for chunk in asked.split(7):
        streamed.see(chunk)
    wanted = attention(asking, asked).numpy()
    np.testing.assert_allclose(streamed.found().numpy(), wanted, atol=1e-3)


def test_gradients_reach_every_weight():
    shape = replace(TINY, blocks=1)
    network = deepcopy(tiny_model(shape)._network).requires_grad_(True)
    cloud = random_cloud(20, shape)
    inputs = (cloud.points, cloud.normals, cloud.features)
    hidden, queries = network(*(torch.tensor(each)[None] for each in inputs))
    parts = network.part_outputs(queries)
    outputs = [getattr(parts, name) for name in PART_FIELDS]
    outputs += [network.closest_points(hidden, queries, torch.zeros(1, 20).long())]
    outputs += [network.mask_logits(hidden, queries)]
    sum(output.square().sum() for output in outputs).backward()
    gradients = {name: weight.grad for name, weight in network.named_parameters()}
    assert not [name for name, grad in gradients.items() if grad is None or not grad.any()]


def test_a_network_without_its_features_says_where_they_are():
    with pytest.raises(ConfigError, match="NON-COMMERCIAL"):
        Particulate(tiny_model())
    answer = Particulate(tiny_model(replace(TINY, features=0)))(cloud_of(4), cloud_of(9))
    assert answer.mask_logits.shape == (4, 16)


def test_precision_is_what_is_asked_for_on_every_machine():
    assert product_dtype("bfloat16") is torch.bfloat16
    assert product_dtype("float32") is torch.float32
    with pytest.raises(ValueError, match="auto"):
        product_dtype("auto")


def test_an_upright_axis_is_turned_round_where_its_limits_say_that_it_opens_backwards(tmp_path):
    file = write_checkpoint(tmp_path / "upright.safetensors", base=3, metadata={"axes": "upright"})
    plain = write_checkpoint(tmp_path / "plain.safetensors", base=3)
    rng = np.random.default_rng(0)
    cloud = PointCloud(rng.uniform(-0.5, 0.5, (50, 3)), rng.normal(size=(50, 3)))
    told = load_model(str(file)).predict(cloud)
    raw = load_model(str(plain)).predict(cloud)
    behind = -raw.revolute_range.min(axis=1) > raw.revolute_range.max(axis=1)
    assert 0 < behind.sum() < len(behind)
    np.testing.assert_array_equal(told.revolute_direction[behind], -raw.revolute_direction[behind])
    np.testing.assert_array_equal(told.revolute_range[behind], -raw.revolute_range[behind][:, ::-1])
    np.testing.assert_array_equal(told.revolute_range[~behind], raw.revolute_range[~behind])
    assert (told.revolute_range.max(axis=1) >= -told.revolute_range.min(axis=1)).all()


@pytest.mark.parametrize("queries", ["0", "-3", "many", "100000"])
def test_a_file_that_asks_for_no_number_of_parts_is_refused(tmp_path, queries):
    file = write_checkpoint(tmp_path / "odd.safetensors", metadata={"max_parts": queries})
    with pytest.raises(ConfigError, match="want 1 to 256"):
        load_model(str(file))
