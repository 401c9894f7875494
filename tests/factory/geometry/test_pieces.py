"""What a skin is cut into, and that modelled meshes are left as they are."""

import numpy as np
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from asset_factory.factory.geometry.pieces import Sheet, pieces
from asset_factory.factory.models.particulate.surface import Surface


def sheet_of(shape, colors=None):
    edges = shape.face_adjacency_edges
    lengths = np.linalg.norm(shape.vertices[edges[:, 0]] - shape.vertices[edges[:, 1]], axis=1)
    return Sheet(shape.area_faces, shape.face_normals, shape.face_adjacency, lengths, colors)


def board(height):
    """A closed board of 61 x 41 points, 10 mm apart, whose top lies at a height [m] each."""
    x, y = np.meshgrid(np.arange(61) * 0.01, np.arange(41) * 0.01, indexing="ij")
    top = np.stack([x, y, height], axis=-1).reshape(-1, 3)
    index = np.arange(61 * 41).reshape(61, 41)
    a, b, c, d = (
        part.ravel() for part in (index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:])
    )
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    shape = trimesh.Trimesh(top, faces, process=False)
    low = trimesh.Trimesh(top * [1, 1, 0] - [0, 0, 0.2], faces[:, ::-1], process=False)
    rim = index[0], index[-1][::-1], index[:, 0][::-1], index[:, -1]
    sides = []
    for edge in rim:
        one, other = edge[:-1], edge[1:]
        sides += [
            np.stack([one, other, other + len(top)], 1),
            np.stack([one, other + len(top), one + len(top)], 1),
        ]
    vertices = np.concatenate([shape.vertices, low.vertices])
    closed = np.concatenate([faces, low.faces + len(top), *sides])
    return trimesh.Trimesh(vertices, closed, process=False)


def grooved():
    """Two panels parted by a groove 3 mm deep."""
    height = np.zeros((61, 41))
    height[30] = -0.003
    return height


def test_a_groove_parts_a_skin():
    shape = board(grooved())
    up = shape.face_normals[:, 2] > 0.99
    surface = Surface.of(np.asarray(shape.vertices), np.asarray(shape.faces))
    assert (surface.components == 0).all()
    for found in (pieces(sheet_of(shape)), surface.pieces):
        left = found[up & (shape.triangles_center[:, 0] < 0.28)]
        right = found[up & (shape.triangles_center[:, 0] > 0.32)]
        assert len(np.unique(left)) == len(np.unique(right)) == 1
        assert left[0] != right[0]


def test_a_flat_skin_is_parted_at_its_edges_alone():
    assert len(np.unique(pieces(sheet_of(board(np.zeros((61, 41))))))) == 6


def test_a_jump_of_colour_parts_a_flat_skin():
    shape = board(np.zeros((61, 41)))
    dark = (shape.triangles_center[:, 0] < 0.2) & (shape.face_normals[:, 2] > 0.5)
    colors = np.where(dark[:, None], 0.2, 0.8) * np.ones(3)
    found = pieces(sheet_of(shape, colors))
    assert set(found[dark]).isdisjoint(found[~dark])
    assert len(np.unique(found)) == 7


def test_crumbs_go_to_what_surrounds_them():
    height = np.zeros((61, 41))
    height[10, 10] = 0.02
    assert len(np.unique(pieces(sheet_of(board(height))))) == 6


def test_components_of_a_modelled_mesh_are_its_pieces():
    boxes = [trimesh.creation.box((1, 1, 1)).apply_translation([2 * k, 0, 0]) for k in range(3)]
    found = pieces(sheet_of(trimesh.util.concatenate(boxes)))
    assert (found == np.repeat(np.arange(3), 12)).all()


def test_a_large_skin_with_crumbs_is_cut_and_the_crumbs_are_not():
    crumb = trimesh.creation.box((0.02, 0.02, 0.02)).apply_translation([0.0, 0.0, 1.0])
    found = pieces(sheet_of(trimesh.util.concatenate([board(grooved()), crumb])))
    assert len(np.unique(found[-12:])) == 1
    assert not np.isin(found[-12:], found[:-12]).any()


@given(st.integers(0, 1000))
@settings(max_examples=10)
def test_pieces_do_not_depend_on_the_order_of_faces(seed):
    shape = board(grooved())
    order = np.random.default_rng(seed).permutation(len(shape.faces))
    shuffled = trimesh.Trimesh(shape.vertices, shape.faces[order], process=False)
    before = pieces(sheet_of(shape))[order]
    after = pieces(sheet_of(shuffled))
    pairs = np.unique(np.stack([before, after]), axis=1)
    assert pairs.shape[1] == len(np.unique(before)) == len(np.unique(after))
