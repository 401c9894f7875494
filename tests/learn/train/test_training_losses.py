"""Losses, the matcher, the head on pairs: the original's numbers, and what they always promise."""

from dataclasses import replace

import numpy as np
import pytest
import torch  # noqa: TID253
from box_sampled_objects import box_sampled
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linear_sum_assignment
from stored_arrays import arrays

from asset_factory.factory.models.network import transformer
from asset_factory.factory.models.network.layers import two_layers
from asset_factory.factory.models.network.shape import AxisForm, NetworkShape
from asset_factory.factory.models.network.transformer import PartArticulationTransformer
from asset_factory.factory.models.particulate.model import load_model
from asset_factory.learn.samples.batches import Batch, collate
from asset_factory.learn.samples.sample import DrawSettings, draw
from asset_factory.learn.train import losses
from asset_factory.learn.train.losses import NAMES, Counts, count, forward, targets_of, taught
from asset_factory.learn.train.matching import arranged_columns, assignment_costs, match
from asset_factory.learn.train.settings import LossSettings

ORIGINAL = {
    "mask": "point_mask_loss",
    "dice": "dice_loss",
    "hierarchy": "motion_hierarchy_loss",
    "motion": "part_motion_classification_loss",
    "revolute_direction": "part_motion_axis_loss_revolute",
    "prismatic_direction": "part_motion_axis_loss_prismatic",
    "revolute_range": "part_motion_range_loss_revolute",
    "prismatic_range": "part_motion_range_loss_prismatic",
    "closest_points": "point_closest_point_on_axis_loss",
}
SHAPE = NetworkShape(hidden=16, blocks=2, heads=2, features=0, max_parts=6, mlp_ratio=2)


@pytest.fixture
def network():
    torch.manual_seed(0)
    return PartArticulationTransformer(SHAPE)


def boxes(count):
    rng = np.random.default_rng(0)
    drawn = [draw(box_sampled(seed), rng, DrawSettings(points=40)) for seed in range(count)]
    return collate(drawn, 6).to("cpu")


def found_losses(network, batch, settings, counts=None, said=None):
    """What a network's answers cost, or others ``said`` in their place."""
    targets = targets_of(batch, settings)
    answers = said or forward(network, batch, settings)
    counts = counts or Counts(*count(batch, targets, settings))
    return losses.losses(answers, batch, targets, counts, settings)


@pytest.mark.parametrize("seed", range(3))
def test_the_losses_and_the_matcher_are_the_originals(fixtures, seed):
    folder = fixtures / "pat_tiny"
    network = load_model(str(folder / f"weights_seed{seed}.safetensors"))._network
    wanted = arrays(folder / f"losses_seed{seed}.npz")
    structure = wanted["part_structure_matrix"]
    taught_by = {
        "points": wanted["xyz"],
        "normals": wanted["normals"],
        "features": wanted["feats"],
        "part_ids": wanted["part_ids"],
        "counts": wanted["num_valid_parts"],
        "parents": np.where(structure.any(1), structure.argmax(1), -1),
        "motion": wanted["gt_part_motion_class"],
        "revolute_direction": np.ascontiguousarray(wanted["gt_revolute_plucker"][..., :3]),
        "revolute_range": wanted["gt_revolute_range"],
        "prismatic_direction": wanted["gt_prismatic_axis"],
        "prismatic_range": wanted["gt_prismatic_range"],
        "closest_points": wanted["gt_closest_point_on_axis"],
    }
    batch = Batch(**taught_by).to("cpu")
    found = found_losses(network, batch, LossSettings(dice=1.0))
    for name, original in ORIGINAL.items():
        loss = wanted[f"loss_matched_{original}"]
        np.testing.assert_allclose(found[name].item(), loss, rtol=1e-4, err_msg=name)
    logits = torch.from_numpy(wanted["matcher_logits"])
    queries = match(logits, batch.part_ids, batch.counts).numpy()
    columns = wanted["matcher_sorted_columns"]
    for row, chosen, column in zip(queries, batch.counts.tolist(), columns, strict=True):
        np.testing.assert_array_equal(row[:chosen], column[:chosen])


@given(st.integers(0, 1000), st.integers(1, 6), st.booleans())
def test_the_match_is_the_best_assignment_and_a_permutation(seed, parts, root_first):
    rng = np.random.default_rng(seed)
    logits = torch.tensor(rng.normal(size=(1, 20, 6)), dtype=torch.float32)
    part_ids = torch.tensor(rng.integers(0, parts, (1, 20)))
    queries = match(logits, part_ids, torch.tensor([parts]), root_first=root_first)[0].numpy()
    np.testing.assert_array_equal(np.sort(queries), np.arange(6))
    cost = assignment_costs(logits, part_ids)[0, :parts].numpy()
    if root_first:
        assert queries[0] == 0
        cost = cost.copy()
        cost[0, 1:] = 1e6
        cost[1:, 0] = 1e6
    best = cost[linear_sum_assignment(cost)].sum()
    assert cost[np.arange(parts), queries[:parts]].sum() == pytest.approx(best, rel=1e-5)


def test_columns_follow_the_match():
    logits = torch.arange(12.0).view(1, 2, 6)
    wanted = [9, 7, 6, 8, 10, 11]
    assert arranged_columns(logits, torch.tensor([[3, 1, 0, 2, 4, 5]]))[0, 1].tolist() == wanted


def test_nothing_that_moves_and_no_edge_teach_nothing_wrong(network):
    batch = boxes(2)
    kinds = ("revolute", "prismatic")
    moving = [f"{kind}_{what}" for kind in kinds for what in ("direction", "range")]
    still = replace(
        batch,
        part_ids=torch.zeros_like(batch.part_ids),
        counts=torch.ones_like(batch.counts),
        parents=torch.full_like(batch.parents, -1),
        motion=torch.zeros_like(batch.motion),
        **{name: torch.zeros_like(getattr(batch, name)) for name in moving},
    )
    settings = LossSettings(dice=1.0, auxiliary=1.0, sign_free=True)
    found = found_losses(network, still, settings)
    losses.total(found, settings).backward()
    assert all(np.isfinite(found[name].item()) for name in NAMES)
    for name in (*moving, "closest_points"):
        assert found[name].item() == 0.0
    gradients = [each.grad for each in network.parameters() if each.grad is not None]
    assert all(torch.isfinite(gradient).all() for gradient in gradients)


def test_micro_batches_add_up_to_the_whole_step(network):
    batch = boxes(5)
    settings = LossSettings(dice=1.0, auxiliary=0.5)
    whole = found_losses(network, batch, settings)
    micro = list(batch.split(2))
    counted = [count(each, targets_of(each, settings), settings) for each in micro]
    counts = Counts(*map(sum, zip(*counted, strict=True)))
    shares = [found_losses(network, each, settings, counts) for each in micro]
    for name in NAMES:
        added = sum(share[name].item() for share in shares)
        assert added == pytest.approx(whole[name].item(), rel=1e-5), name


def test_an_opposite_direction_is_as_good_where_the_range_reads_the_same_from_both_ends(network):
    batch = boxes(1)
    direction = torch.tensor([0.0, 0.0, 1.0]).expand(1, 6, 3)
    limits = [[-1.0, 1.0], [0.0, 1.0], [-3.2, 3.2], [-1.0, 0.5], [0.0, 6.3], [-0.1, 0.1]]
    turning = {"counts": torch.tensor([6]), "motion": torch.ones(1, 6, dtype=torch.long)}
    turning["revolute_range"] = torch.tensor(limits)[None]
    batch = replace(batch, revolute_direction=direction, **turning)
    answers = forward(network, batch, LossSettings())
    said = replace(answers.parts, revolute_direction=-direction)
    answers = replace(answers, parts=said)
    for settings, wrong in ((LossSettings(), 6), (LossSettings(sign_free=True), 2)):
        found = found_losses(network, batch, settings, said=answers)
        # Opposite unit vectors along a coordinate differ by 2 in one coordinate of three.
        assert found["revolute_direction"].item() == pytest.approx(wrong / 6 * 2 / 3)


def test_parts_without_a_point_teach_only_if_asked():
    batch = boxes(1)
    batch = replace(batch, part_ids=torch.zeros_like(batch.part_ids))
    assert targets_of(batch, LossSettings()).parts.sum() == batch.counts[0]
    assert targets_of(batch, LossSettings(unseen_parts=False)).parts.sum() == 1


def test_an_upright_axis_is_the_same_joint_turned_about():
    batch = boxes(3)
    upright = taught(batch, LossSettings(upright_axes=True))
    direction = upright.revolute_direction
    limits = upright.revolute_range
    assert (direction.gather(-1, direction.abs().argmax(-1, keepdim=True)) >= 0).all()
    # Turning by a limit about an axis is one rotation vector, whichever way the axis points.
    for low, high in ((0, 1), (1, 0)):
        was = batch.revolute_direction * batch.revolute_range[..., low, None]
        same = direction * limits[..., low, None]
        other = direction * limits[..., high, None]
        assert torch.where((same - was).abs() < 1e-6, same, other).allclose(was, atol=1e-6)
    assert (limits[..., 0] <= limits[..., 1]).all()
    assert taught(batch, LossSettings()) is batch


def test_a_network_that_says_axes_by_moments_is_taught_those_of_the_annotated_axes():
    torch.manual_seed(0)
    network = PartArticulationTransformer(replace(SHAPE, axis_form=AxisForm.PLUCKER))
    batch = boxes(6)
    settings = LossSettings()
    assert Counts(*count(batch, targets_of(batch, settings), settings)).closest_points > 0
    answers = forward(network, batch, settings)
    assert answers.closest_points is None
    # The moment of the axis through any of its points, as a part says it.
    moment = torch.zeros_like(answers.parts.revolute_moment)
    for row in range(len(batch)):
        for part in range(int(batch.counts[row])):
            points = batch.closest_points[row][batch.part_ids[row] == part]
            if len(points):
                direction = batch.revolute_direction[row, part]
                moment[row, part] = torch.linalg.cross(direction, points[0])
    told = replace(answers, parts=replace(answers.parts, revolute_moment=moment))
    right = found_losses(network, batch, settings, said=told)["closest_points"]
    assert right.item() == pytest.approx(0.0, abs=1e-5)
    wrong = replace(told, parts=replace(answers.parts, revolute_moment=moment + 0.5))
    found = found_losses(network, batch, settings, said=wrong)["closest_points"]
    assert found.item() == pytest.approx(0.5, abs=1e-5)


@pytest.mark.parametrize("cached", [1, 1 << 18])
def test_pairs_and_their_gradients_are_those_of_the_concatenated_rows(monkeypatch, cached):
    monkeypatch.setattr(transformer, "_CACHED", cached)
    torch.manual_seed(0)
    head = two_layers(10, 7, 1).double()
    rows = torch.randn(3, 4, 5, dtype=torch.float64, requires_grad=True)
    columns = torch.randn(3, 6, 5, dtype=torch.float64, requires_grad=True)
    above = torch.randn(3, 4, 6, dtype=torch.float64)
    leaves = (rows, columns, *head.parameters())
    found = transformer.pair_logits(head, rows, columns)
    gradients = torch.autograd.grad((found * above).sum(), leaves)
    both = torch.cat(
        [rows[:, :, None].expand(-1, -1, 6, -1), columns[:, None].expand(-1, 4, -1, -1)], dim=-1
    )
    wanted = head(both)[..., 0]
    torch.testing.assert_close(found, wanted)
    torch.testing.assert_close(gradients, torch.autograd.grad((wanted * above).sum(), leaves))
