"""The same object in another pose is the same object."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from asset_factory.factory.geometry.posing import closed, face_parts, posed, turned
from asset_factory.learn.objects import make_object

CABINET = make_object("cabinet", 0)


def corners(articulation, values=None):
    """Every face corner with its joints at some values, shape [face_count, 3, 3]."""
    poses = articulation.poses(values)[face_parts(articulation)]
    corners = articulation.mesh.vertices[articulation.mesh.faces]
    return np.einsum("nij,nkj->nki", poses[:, :3, :3], corners) + poses[:, None, :3, 3]


@given(share=st.floats(0.0, 1.0), further=st.floats(0.0, 1.0))
def test_what_an_opened_object_can_reach_is_what_it_could_reach_before(share, further):
    opened = posed(CABINET, {joint.name: share * joint.upper for joint in CABINET.joints})
    there = {joint.name: further * (joint.upper - joint.lower) for joint in CABINET.joints}
    here = {joint.name: there[joint.name] + joint.lower for joint in opened.joints}
    np.testing.assert_allclose(corners(opened, here), corners(CABINET, there), atol=1e-9)
    assert [p.name for p in opened.parts] == [p.name for p in CABINET.parts]


def test_closing_undoes_opening():
    opened = posed(CABINET, {joint.name: joint.upper for joint in CABINET.joints})
    assert np.abs(corners(opened) - corners(CABINET)).max() > 0.1
    np.testing.assert_allclose(corners(closed(opened)), corners(CABINET), atol=1e-9)


def test_a_turned_object_moves_as_before_but_turned():
    about = turned(CABINET, np.pi / 2)
    values = {joint.name: joint.upper for joint in CABINET.joints}
    x, y, z = np.moveaxis(corners(CABINET, values), -1, 0)
    np.testing.assert_allclose(corners(about, values), np.stack([-y, x, z], axis=-1), atol=1e-9)


def test_a_value_out_of_reach_is_refused():
    with pytest.raises(ValueError, match=r"is outside \[0, "):
        posed(CABINET, {CABINET.joints[0].name: 99.0})
    with pytest.raises(KeyError):
        posed(CABINET, {"nobody": 0.0})
