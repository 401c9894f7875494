"""Points vote for faces, connected faces are made to agree, dense meshes get labels back."""

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from plain_solids import surface_of
from stored_arrays import arrays

from asset_factory.factory.geometry.edges import label_linked
from asset_factory.factory.models.particulate.decoding import assigned
from asset_factory.factory.models.particulate.labels import (
    Refinement,
    by_component,
    fused_components,
    refined,
    voted,
    with_gaps_filled,
)
from asset_factory.factory.models.particulate.proxy import carried_back, proxy_of
from asset_factory.factory.models.particulate.surface import Surface


def box(*extents, times=2):
    """A box of which every triangle is divided in four that many times."""
    made = trimesh.creation.box(extents=extents or None)
    for _ in range(times):
        made = made.subdivide()
    return made


def boxes_apart(count):
    return surface_of(*(box().apply_translation([3.0 * i, 0, 0]) for i in range(count)))


@pytest.mark.parametrize("name", ["one_box", "three_cc", "ico"])
def test_labels_are_those_of_the_release(fixtures, name):
    held = arrays(fixtures / "geometry" / "face_labels.npz")
    surface = Surface.of(held[f"{name}_vertices"], held[f"{name}_faces"])
    faces = held[f"{name}_point_face"]
    raw = voted(faces[faces >= 0], held[f"{name}_point_part"][faces >= 0], len(surface.faces))
    assert np.array_equal(raw, held[f"{name}_raw"])
    assert np.array_equal(by_component(surface, raw), held[f"{name}_strict"])
    patches, _ = refined(surface, raw, Refinement.PATCH, 0.1)
    assert np.array_equal(patches, held[f"{name}_nonstrict"])


def test_equal_votes_go_to_the_lowest_label_and_no_vote_is_minus_one():
    labels = voted(np.array([0, 0, 0, 0, 2]), np.array([3, 1, 3, 1, 2]), 4)
    assert labels.tolist() == [1, -1, 2, -1]


def test_faces_without_points_take_the_nearest_label():
    surface = surface_of(box(1.0, 1.0, 10.0))
    centers = surface.vertices[surface.faces].mean(axis=1)
    labels = np.full(len(surface.faces), -1)
    points = np.array([[0.0, 0, -5], [0, 0, 5]])
    filled = with_gaps_filled(surface, labels, points, np.array([4, 9]))
    assert np.array_equal(filled, np.where(centers[:, 2] < 0, 4, 9))
    assert np.array_equal(with_gaps_filled(surface, filled, centers, filled), filled)


def noisy(labels, share, count, seed=0):
    rng = np.random.default_rng(seed)
    return np.where(rng.random(len(labels)) < share, rng.integers(0, count, len(labels)), labels)


def test_a_mesh_of_separate_parts_gets_one_label_each():
    surface = boxes_apart(3)
    labels, fused = refined(surface, noisy(surface.components, 0.4, 3), Refinement.AUTO, 0.1)
    assert np.array_equal(labels, surface.components)
    assert fused == 0


def test_a_mesh_of_one_component_keeps_its_parts():
    """Where we leave the release: its default makes one part of every fused mesh."""
    surface = surface_of(box(3.0, 1.0, 1.0, times=3))
    truth = (surface.vertices[surface.faces].mean(axis=1)[:, 0] > 0.7).astype(np.int64)
    labels, fused = refined(surface, noisy(truth, 0.1, 2), Refinement.AUTO, 0.1)
    assert len(np.unique(by_component(surface, noisy(truth, 0.1, 2)))) == 1
    assert fused == 1
    assert (labels == truth).mean() > 0.97
    for label in (0, 1):
        pairs = surface.neighbours
        inside = (labels[pairs] == label).all(axis=1)
        assert len(np.unique(label_linked(len(labels), pairs[inside])[labels == label])) == 1


def test_a_stray_face_on_a_fused_mesh_is_no_part_of_its_own():
    """Where we leave the release: it keeps one patch of every label, if it is a single triangle."""
    surface = surface_of(trimesh.creation.box(extents=(3.0, 1.0, 1.0)).subdivide_loop(5))
    truth = (surface.vertices[surface.faces].mean(axis=1)[:, 0] > 0.7).astype(np.int64)
    inside_the_part = np.flatnonzero(truth)[len(np.flatnonzero(truth)) // 2]
    stray = truth.copy()
    stray[inside_the_part] = 6
    assert 6 in refined(surface, stray, Refinement.PATCH, 0.1)[0]
    labels, fused = refined(surface, stray, Refinement.AUTO, 0.1)
    assert fused == 1
    assert np.array_equal(labels, truth)


def test_a_fused_body_beside_separate_parts_is_cut_and_they_are_not():
    surface = surface_of(box(3.0, 1.0, 1.0), box(3.0, 0.1, 1.0).apply_translation([0, 2, 0]))
    centers = surface.vertices[surface.faces].mean(axis=1)
    fused_part = (surface.components == 0) & (centers[:, 0] > 0.4)
    labels = np.where(surface.components == 1, 7, np.where(fused_part, 2, 0))
    stray = np.flatnonzero(surface.components == 1)[:9]
    labels[stray] = 0
    assert fused_components(surface, labels, 0.1).tolist() == [0]
    done, count = refined(surface, labels, Refinement.AUTO, 0.1)
    assert count == 1
    assert (done[surface.components == 1] == 7).all()
    assert (done[fused_part] == 2).all()


def test_a_small_mistake_in_a_large_mesh_makes_no_component_fused():
    surface = boxes_apart(4)
    labels = surface.components.copy()
    labels[:8] = 9
    assert len(fused_components(surface, labels, 0.1)) == 0
    assert 9 not in refined(surface, labels, Refinement.AUTO, 0.1)[0]


def test_a_screw_is_not_cut_in_two_however_torn_the_network_is_about_it():
    body = box(5.0, 5.0, 5.0, times=1)
    surface = surface_of(body, trimesh.creation.box().apply_translation([9.0, 0, 0]))
    labels = surface.components.copy()
    labels[-6:] = 9
    labels[-7] = 3
    assert len(fused_components(surface, labels, 0.1)) == 0


def test_no_refinement_leaves_labels_alone():
    surface = surface_of(trimesh.creation.icosphere(2))
    labels = np.random.default_rng(0).integers(0, 5, len(surface.faces))
    assert np.array_equal(refined(surface, labels, Refinement.NONE, 0.1)[0], labels)


@given(st.integers(0, 10**6), st.integers(2, 6))
def test_afterwards_every_label_is_one_patch_and_none_is_new(seed, count):
    surface = surface_of(trimesh.creation.icosphere(2), box(times=1))
    labels = np.random.default_rng(seed).integers(0, count, len(surface.faces))
    done, _ = refined(surface, labels, Refinement.PATCH, 0.1)
    same = done[surface.neighbours[:, 0]] == done[surface.neighbours[:, 1]]
    patch = label_linked(len(done), surface.neighbours[same])
    keys = np.stack([surface.components, done], axis=1)
    assert len(np.unique(patch)) == len(np.unique(keys, axis=0))
    assert set(np.unique(done)) <= set(np.unique(labels))


def test_a_dense_mesh_is_seen_lighter_and_labelled_whole():
    spheres = [trimesh.creation.icosphere(4).apply_translation([2.5 * i, 0, 0]) for i in range(3)]
    surface = surface_of(*spheres)
    proxy = proxy_of(surface, 3000)
    assert len(proxy.surface.faces) <= 3000
    assert proxy.surface.components.max() == 2
    components = carried_back(proxy, proxy.surface.components, surface.faces)
    assert np.array_equal(components, surface.components)
    # A border across a component stays where it was, to within a proxy's triangle.
    low = proxy.surface.vertices[proxy.surface.faces].mean(axis=1)[:, 2] < 0
    centers = surface.vertices[surface.faces].mean(axis=1)[:, 2]
    back = carried_back(proxy, low.astype(np.int64), surface.faces)
    assert (back == 1)[centers < -0.15].all()
    assert (back == 0)[centers > 0.15].all()


def test_labels_nobody_gave_come_back_as_none():
    surface = surface_of(trimesh.creation.icosphere(4))
    proxy = proxy_of(surface, 1000)
    back = carried_back(proxy, np.full(len(proxy.surface.faces), -1), surface.faces)
    assert (back == -1).all()
    assert proxy_of(surface, 10**6).vertex is None


@pytest.mark.parametrize(
    ("seed", "threshold"), [(s, t) for s in (0, 1, 2) for t in (0, 20, 40, 60) if (s, t) != (2, 60)]
)
def test_points_are_assigned_as_in_the_release(fixtures, seed, threshold):
    """All but the cases in which it dissolves several parts in one sweep; see the next test."""
    forward = arrays(fixtures / "pat_tiny" / f"forward_seed{seed}.npz")
    held = arrays(fixtures / "pat_tiny" / f"infer_seed{seed}_t{threshold:02d}.npz")
    points = assigned(forward["point_mask_logits"][0], threshold / 100)
    clear = forward["mask_margin"][0] > 1e-3
    assert np.array_equal(points.parts[clear], held["part_ids"][clear])


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_dissolving_goes_one_by_one_and_never_to_the_last(fixtures, seed):
    """Where we leave the release: its sweep judges by old numbers and can delete every part."""
    forward = arrays(fixtures / "pat_tiny" / f"forward_seed{seed}.npz")
    held = arrays(fixtures / "pat_tiny" / f"infer_seed{seed}_t80.npz")
    logits = forward["point_mask_logits"][0]
    points = assigned(logits, 0.8)
    assert len(points.present) >= len(np.unique(held["part_ids"]))
    assert (points.confidence[points.present] >= 0.8).all() or len(points.present) == 1
    only = assigned(logits, 1.1)
    assert len(only.present) == 1
    assert only.confidence[only.present] == 1.0
    assert set(points.present) <= set(assigned(logits).present)


def test_confidence_is_the_geometric_mean_over_the_parts_that_are_there():
    logits = np.log(np.array([[0.6, 0.2, 0.2], [0.9, 0.05, 0.05], [0.1, 0.8, 0.1]]))
    points = assigned(logits)
    assert points.parts.tolist() == [0, 0, 1]
    # The third part has no point, so the others share its probability.
    assert points.confidence == pytest.approx([np.sqrt(0.6 / 0.8 * 0.9 / 0.95), 0.8 / 0.9, 0.0])
