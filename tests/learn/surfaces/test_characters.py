"""Characters: other surfaces, same parts and joints; a pass does what it says, nothing else."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from plain_solids import box, parted
from plain_solids import signed_volume as volume
from scipy.spatial import cKDTree

from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.geometry.components import connected_components
from asset_factory.factory.geometry.posing import face_parts
from asset_factory.factory.mesh import Material, Mesh
from asset_factory.factory.models.particulate.surface import Surface
from asset_factory.learn.objects import artist_like, fused_like, make_object
from asset_factory.learn.objects.mixture import in_character
from asset_factory.learn.surfaces import details, skin_like, stretched, surfaces
from asset_factory.learn.surfaces.artist import LEFT_FOR_RIGHT, PASSES
from asset_factory.learn.surfaces.labelled import KEPT_SHARE, Labelled, joined
from asset_factory.learn.surfaces.united import all_united, parts_united

GREY = Material("grey")


def rng(seed=0):
    return np.random.default_rng(seed)


def solids(*spans, part=None):
    """Boxes, each of its own part if none is given."""
    made = []
    for index, (x, y, z) in enumerate(spans):
        mesh = box(x, y, z, GREY)
        label = np.zeros((12, 3), dtype=np.int64)
        label[:, 0] = index if part is None else part[index]
        made.append(Labelled(mesh.vertices, mesh.faces, label))
    return joined(made)


def component_count(mesh):
    return int(connected_components(Mesh.from_triangles(mesh.vertices, mesh.faces)).max()) + 1


UNIT = ((0.0, 1.0), (0.0, 1.0), (0.0, 1.0))
BESIDE = ((1.0, 2.0), (0.0, 1.0), (0.0, 0.5))
INNER = ((0.4, 0.6), (0.4, 0.6), (0.4, 0.6))
DRAWER = ((0.0, 1.0), (-0.1, 0.0), (0.0, 1.0))


@cache
def oven():
    return make_object("oven", 3)


CHANGES = tuple(dict.fromkeys(change for change, _ in PASSES))


@pytest.mark.parametrize(
    "change", CHANGES, ids=lambda change: getattr(change, "func", change).__name__
)
def test_a_pass_keeps_every_part_and_changes_no_argument(change):
    mesh = Labelled.of(oven())
    before = mesh.vertices.copy(), mesh.faces.copy(), mesh.part.copy()
    changed = change(mesh, rng(5))
    assert set(changed.part) == set(mesh.part)
    np.testing.assert_array_equal(np.unique(changed.piece), np.arange(changed.piece_count))
    assert len(changed.faces) == len(changed.label)
    for kept, given_ in zip(before, (mesh.vertices, mesh.faces, mesh.part), strict=True):
        np.testing.assert_array_equal(kept, given_)
    reach = np.subtract(changed.bounds, mesh.bounds)
    assert reach[0].min() > -0.035
    assert reach[1].max() < 0.035


@settings(max_examples=25)
@given(st.sampled_from(["cabinet", "laptop", "trash_can", "chest"]), st.integers(0, 10_000))
def test_artist_like_keeps_names_tree_and_kinds_and_is_repeatable(category, seed):
    original = make_object(category, seed % 7)
    changed = artist_like(original, seed)
    again = artist_like(original, seed)
    assert [p.name for p in changed.parts] == [p.name for p in original.parts]
    assert all(len(part.faces) for part in changed.parts)
    for joint, was in zip(changed.joints, original.joints, strict=True):
        wanted = (was.name, was.kind, was.parent, was.child)
        assert (joint.name, joint.kind, joint.parent, joint.child) == wanted
        assert joint.lower == 0.0 < joint.upper
    assert changed.mesh.vertices.tobytes() == again.mesh.vertices.tobytes()
    assert changed.mesh.faces.tobytes() == again.mesh.faces.tobytes()
    assert all(material.texture is None for material in changed.mesh.materials)


def test_uniting_a_part_gives_one_closed_skin_of_the_same_volume():
    mesh = parts_united(solids(UNIT, BESIDE, part=(0, 0)), rng(), share=1.0)
    assert volume(mesh) == pytest.approx(1.5)
    assert component_count(mesh) == 1
    assert mesh.areas.sum() == pytest.approx(6.0 + 4.0 - 2 * 0.5)


def test_uniting_everything_gives_one_component_of_several_parts():
    apart = ((1.003, 2.0), (0.0, 1.0), (0.0, 0.5))
    mesh = all_united(solids(UNIT, apart))
    assert component_count(mesh) == 1
    assert set(mesh.part) == {0, 1}
    assert component_count(parts_united(solids(UNIT, apart), rng(), share=1.0)) == 2


def test_growing_moves_every_side_by_as_much_and_nothing_turns_inside_out():
    thin = ((0.0, 1.0), (0.0, 0.002), (0.0, 1.0))
    low, high = solids(UNIT, BESIDE).grown(0.01).boxes()
    np.testing.assert_allclose([low[0], high[0]], [[-0.01] * 3, [1.01] * 3], atol=1e-12)
    assert volume(solids(thin).grown(-0.01)) > 0.0


def test_doubling_leaves_no_volume_and_twice_the_surface_in_as_many_components():
    mesh = solids(UNIT, BESIDE)
    twice = surfaces.doubled(mesh, rng())
    assert volume(twice) == pytest.approx(0.0, abs=1e-12)
    assert twice.areas.sum() == pytest.approx(2.0 * mesh.areas.sum())
    assert component_count(twice) == component_count(mesh)


def test_exploding_makes_every_side_a_component_of_its_own():
    mesh = surfaces.exploded(solids(UNIT), rng(), share=1.0)
    assert component_count(mesh) == 6
    assert len(mesh.faces) == 12


def test_a_side_cut_finer_than_its_neighbours_comes_off_and_a_whole_piece_does_not():
    assert component_count(surfaces.patched(solids(UNIT), rng(1), share=0.5)) > 1
    whole = surfaces.subdivided(solids(UNIT), rng(), share=1.0)
    assert component_count(whole) == 1
    assert len(whole.faces) in {48, 192}
    assert volume(whole) == pytest.approx(1.0)


def test_quartering_some_faces_keeps_area_and_labels():
    mesh = solids(UNIT, BESIDE)
    finer = surfaces.quartered(mesh, mesh.part == 1)
    assert len(finer.faces) == 12 + 48
    areas = np.bincount(mesh.part, mesh.areas)
    np.testing.assert_allclose(np.bincount(finer.part, finer.areas), areas)


def test_a_flattened_panel_is_one_sheet_in_the_plane_of_its_front():
    panel = ((0.0, 1.0), (0.0, 0.02), (0.0, 1.0))
    mesh = surfaces.flattened(solids(UNIT, panel, part=(0, 1)), rng(), share=1.0)
    sheet = mesh.corners[mesh.part == 1]
    assert len(sheet) == 2
    assert (sheet[:, :, 1] == 0.0).all()
    assert (mesh.part == 0).sum() == 12


def test_opening_drops_whole_sides_of_boxes():
    boxes = solids(*[UNIT] * 40, part=(0,) * 40)
    kept = np.bincount(surfaces.opened(boxes, rng(), share=1.0).piece)
    assert set(kept) <= {2, 4, 6, 8, 10, 12}
    assert (kept < 12).mean() > 0.5


def test_no_part_is_dropped_however_hidden_it_is():
    both = solids(UNIT, INNER)
    hidden = details.hidden_faces(both, rng())
    assert hidden[12:].all()
    assert not hidden[:12].any()
    assert set(details.without_hidden_pieces(both, rng()).part) == {0, 1}
    assert set(details.without_hidden_pieces(solids(UNIT, INNER, part=(0, 0)), rng()).piece) == {0}
    assert set(surfaces.without_sides(both, rng()).part) == {0, 1}


def test_a_part_that_would_lose_nearly_all_loses_nothing():
    mesh = solids(UNIT, BESIDE)
    dropped = np.zeros(24, dtype=bool)
    dropped[:11] = True
    assert KEPT_SHARE > 1 / 12
    assert len(mesh.without(dropped).faces) == 24
    dropped[:12] = False
    dropped[12:14] = True
    assert len(mesh.without(dropped).faces) == 22


def test_bevelled_boxes_stay_closed_and_inside_their_box():
    mesh = surfaces.bevelled(solids(UNIT, BESIDE), rng(), share=1.0)
    assert component_count(mesh) == 2
    assert len(mesh.faces) == 88
    assert 0.99 < volume(mesh) / 1.5 < 1.0
    np.testing.assert_allclose(mesh.boxes(), solids(UNIT, BESIDE).boxes(), atol=1e-12)


def test_a_curved_front_bulges_forwards_and_the_body_does_not():
    mesh = surfaces.curved(solids(UNIT, ((0.0, 1.0), (-0.02, 0.0), (0.0, 1.0))), rng(), share=1.0)
    body, front = (mesh.corners[mesh.part == part][:, :, 1].min() for part in (0, 1))
    assert -0.05 < front < -0.024
    assert body == 0.0


def test_snapping_lays_vertices_on_a_grid_and_leaves_no_face_without_area():
    mesh = surfaces.snapped(Labelled.of(oven()), rng())
    steps = mesh.vertices[np.unique(mesh.faces)] / 0.001
    np.testing.assert_allclose(steps, np.round(steps), atol=1e-6)
    assert mesh.areas.min() > 0.0


def test_lettering_lies_just_outside_and_looks_outwards():
    for seed in range(8):
        mesh = details.lettered(solids(UNIT), rng(seed))
        corners = mesh.corners[12:]
        out = np.abs(corners - 0.5).max(axis=2).min(axis=1)
        assert ((out > 0.5) & (out < 0.502)).all()
        assert (np.einsum("ij,ij->i", mesh.crosses[12:], corners.mean(axis=1) - 0.5) > 0.0).all()


def test_handles_go_and_doors_stay():
    door = ((0.0, 1.0), (-0.02, 0.0), (0.0, 1.0))
    grip = ((0.4, 0.6), (-0.06, -0.02), (0.5, 0.52))
    mesh = solids(UNIT, door, grip, part=(0, 1, 1))
    gone = [set(details.without_handles(mesh, rng(seed)).piece) for seed in range(12)]
    assert {0, 1} in gone
    assert {0, 1, 2} in gone


def test_stretched_and_mirrored_objects_move_as_their_stretched_and_mirrored_motions():
    original = make_object("cabinet", 2)
    for factors in ((1.2, 0.9, 1.1), LEFT_FOR_RIGHT):
        changed = stretched(original, factors)
        linear = np.diag(factors)
        for joint, was in zip(changed.joints, original.joints, strict=True):
            full = was.motion(was.upper)
            if not joint.turns:
                wanted = linear @ (was.axis * was.upper)
                np.testing.assert_allclose(joint.axis * joint.upper, wanted, atol=1e-12)
                continue
            np.testing.assert_allclose(joint.origin, linear @ was.origin)
            assert joint.upper == was.upper
            if min(factors) < 0.0:
                turned = linear @ full[:3, :3] @ np.linalg.inv(linear)
                np.testing.assert_allclose(joint.motion(joint.upper)[:3, :3], turned, atol=1e-12)
    np.testing.assert_allclose(
        stretched(changed, LEFT_FOR_RIGHT).mesh.vertices, original.mesh.vertices
    )


def test_an_object_with_a_hinge_aslant_is_only_scaled_evenly():
    original = make_object("laptop", 0)
    aslant = replace(original.joints[0], axis=np.array([0.6, 0.8, 0.0]))
    changed = stretched(replace(original, joints=(aslant,)), [2.0, 1.0, 0.5])
    np.testing.assert_allclose(changed.mesh.extents, original.mesh.extents)
    with pytest.raises(ValueError, match="other than 0"):
        stretched(original, [1.0, 0.0, 1.0])


@pytest.mark.parametrize("category", ["chest", "microwave", "laptop"])
def test_a_fused_object_is_closed_near_the_original_and_keeps_every_part(category):
    original = make_object(category, 1)
    fused = fused_like(original, 2)
    mesh = Labelled.of(fused)
    ends = np.sort(fused.mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    shared = np.unique(ends, axis=0, return_counts=True)[1]
    assert (shared % 2 == 0).all()
    assert volume(mesh) > 0.0
    assert all(len(part.faces) for part in fused.parts)
    cell = original.mesh.extents.max() / 40
    np.testing.assert_allclose(fused.mesh.bounds, original.mesh.bounds, atol=2.0 * cell)
    for part in range(len(original.parts)):
        low, high = original.part_mesh(part).bounds
        vertices = fused.part_mesh(part).vertices
        inside = (vertices > low - 3 * cell) & (vertices < high + 3 * cell)
        assert inside.all()
    assert fused.mesh.vertices.tobytes() == fused_like(original, 2).mesh.vertices.tobytes()


def nested(part, parents):
    """A unit cube, a small one inside it and a drawer in front, of these parts, which slide."""
    named = {f"part_{i}": [] for i in range(len(parents) + 1)}
    for spans, own in zip((UNIT, INNER, DRAWER), part, strict=True):
        named[f"part_{own}"].append(box(*spans, GREY))
    axis = np.array([0.0, -1.0, 0.0])
    joints = (
        Joint(f"joint_{i}", JointKind.PRISMATIC, parent, i + 1, axis, np.zeros(3), 0.0, 0.1)
        for i, parent in enumerate(parents)
    )
    return parted(named, *joints)


def test_a_part_that_nobody_sees_is_not_in_a_fused_object():
    fused = fused_like(nested((0, 1, 2), (0, 0)), 0)
    assert [part.name for part in fused.parts] == ["part_0", "part_2"]
    (joint,) = fused.joints
    assert (joint.name, joint.parent, joint.child) == ("joint_1", 0, 1)


@pytest.mark.parametrize(("part", "parents"), [((0, 1, 0), (0,)), ((0, 1, 2), (0, 1))])
def test_what_hangs_on_something_hidden_cannot_be_fused_and_becomes_an_artists(part, parents):
    articulation = nested(part, parents)
    with pytest.raises(ValueError, match="the rest needs them"):
        fused_like(articulation, 0)
    assert in_character(articulation, "generated", 0)[1] == "artist"


def test_what_turns_all_round_stays_round():
    for seed in range(12):
        changed = artist_like(oven(), seed)
        was = oven().mesh.extents
        now = changed.mesh.extents
        assert any(joint.range > 4.0 and abs(joint.axis[1]) == 1.0 for joint in changed.joints)
        assert now[0] / was[0] == pytest.approx(now[2] / was[2], rel=0.06)


def test_an_open_piece_is_never_united():
    two = solids(((0, 1), (0, 1), (0, 1)), ((0.5, 1.5), (0, 1), (0, 1)))
    open_ = two.chosen(np.arange(len(two.faces)) != 0)
    found = parts_united(open_, rng(), share=1.0)
    assert len(found.faces) == len(open_.faces)
    assert volume(found) == pytest.approx(volume(open_))


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_skin_is_one_closed_surface_around_the_object(seed):
    original = make_object("fridge", 3)
    made = skin_like(original, seed, cells=96)
    surface = Surface.of(made.mesh.vertices, made.mesh.faces)
    share = np.bincount(surface.components, weights=surface.areas)
    assert share.max() > 0.98 * share.sum()
    assert (surface.edges.counts == 1).sum() < 0.002 * len(surface.edges.counts)
    cell = original.mesh.extents.max() / 96
    assert np.abs(made.mesh.bounds - original.mesh.bounds).max() < 1.5 * cell
    assert [joint.name for joint in made.joints] == [joint.name for joint in original.joints]


def test_faces_of_a_skin_belong_to_the_part_that_is_nearest():
    original = make_object("dishwasher", 4)
    made = skin_like(original, 5, cells=96)
    part = face_parts(original)
    plain = trimesh.Trimesh(original.mesh.vertices, original.mesh.faces, process=False)
    points, faces = trimesh.sample.sample_surface(plain, 40_000, seed=0)
    centers = made.mesh.vertices[made.mesh.faces].mean(axis=1)
    _, nearest = cKDTree(points).query(centers)
    agreed = face_parts(made) == part[faces[nearest]]
    assert agreed.mean() > 0.95


@pytest.mark.parametrize("seed", range(6))
def test_a_skin_turns_where_one_part_ends_and_another_begins(seed):
    made = skin_like(make_object("fridge", 3), seed, cells=128)
    surface = Surface.of(made.mesh.vertices, made.mesh.faces)
    one, other = surface.neighbours.T
    cosine = np.einsum("ij,ij->i", surface.normals[one], surface.normals[other])
    turn = np.arccos(np.clip(cosine, -1.0, 1.0))
    part = face_parts(made)
    at_seam = part[one] != part[other]
    assert at_seam.sum() > 100
    assert turn[at_seam].mean() > 4.0 * turn[~at_seam].mean()
