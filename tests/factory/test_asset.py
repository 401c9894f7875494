"""Hulls and inertias that no simulator should be given cannot be constructed."""

import numpy as np
import pytest
import trimesh

from asset_factory.factory.articulation import Articulation, Part
from asset_factory.factory.asset import Asset, Hull, Inertial, PartBody
from asset_factory.factory.errors import InvalidAsset
from asset_factory.factory.mesh import Mesh

BOX = trimesh.creation.box((1, 2, 3))


def test_a_box_has_its_volume_wherever_it_lies():
    assert Hull(BOX.vertices + 100.0, BOX.faces).volume == pytest.approx(6.0)


@pytest.mark.parametrize(
    ("vertices", "faces"),
    [
        (BOX.vertices[:3], [[0, 1, 2]]),
        (BOX.vertices * [1, 1, 0], BOX.faces),
        (BOX.vertices, BOX.faces[:, ::-1]),
        (BOX.vertices * np.nan, BOX.faces),
    ],
)
def test_flat_inverted_or_broken_hulls_are_refused(vertices, faces):
    with pytest.raises(InvalidAsset, match="hull"):
        Hull(vertices, faces)


@pytest.mark.parametrize(
    ("mass", "moments", "sentence"),
    [
        (0.0, (1, 1, 1), "mass must be more than 0, not 0.0 kg"),
        (np.nan, (1, 1, 1), "mass must be more than 0, not nan kg"),
        (1.0, (1, 1, -1), "smallest principal moment is -1"),
        (1.0, (1, 1, 3), "triangle inequality"),
        (1.0, (1, 1, np.inf), "not finite"),
    ],
)
def test_impossible_inertias_are_refused(mass, moments, sentence):
    with pytest.raises(InvalidAsset, match=sentence):
        Inertial(mass, np.zeros(3), np.diag(np.array(moments, dtype=float)))


def test_a_part_with_faces_needs_a_hull():
    mesh = Mesh.from_triangles(BOX.vertices, BOX.faces)
    articulation = Articulation(mesh, (Part("base", np.arange(12)),), (), "test")
    inertial = Inertial(1.0, np.zeros(3), np.eye(3))
    with pytest.raises(InvalidAsset, match="no hull to collide with"):
        Asset("box", articulation, (PartBody((), inertial),))
    asset = Asset("box", articulation, (PartBody((Hull(BOX.vertices, BOX.faces),), inertial),))
    assert (asset.hull_count, asset.mass) == (1, 1.0)
