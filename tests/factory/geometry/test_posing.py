"""The same object in another pose is the same; parts are made one with what they hang on."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from asset_factory.factory.articulation import JointKind
from asset_factory.factory.geometry.posing import closed, face_parts, posed, turned
from asset_factory.factory.geometry.welding import welded
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


def test_a_welded_part_belongs_to_its_parent_and_the_others_move_as_before():
    gone, left, *_ = CABINET.joints
    found = welded(CABINET, {gone.name})
    assert [joint.name for joint in found.joints] == [joint.name for joint in CABINET.joints[1:]]
    assert (face_parts(found)[CABINET.parts[gone.child].faces] == 0).all()
    before = CABINET.poses({left.name: left.upper})
    after = found.poses({left.name: left.upper})
    assert np.array_equal(before[left.child], after[found.joint(left.name).child])
    same = welded(CABINET, ())
    assert [part.name for part in same.parts] == [part.name for part in CABINET.parts]


def test_what_hangs_on_a_welded_part_hangs_on_its_parent():
    chain = make_object("desk_lamp", 1)
    parents = {joint.parent for joint in chain.joints}
    first = next(joint for joint in chain.joints if joint.child in parents)
    found = welded(chain, {first.name})
    assert len(found.parts) == len(chain.parts) - 1
    orphan = next(joint for joint in chain.joints if joint.parent == first.child)
    assert found.parts[found.joint(orphan.name).parent].name == chain.parts[first.parent].name


@pytest.mark.parametrize("kind", [JointKind.PRISMATIC, JointKind.CONTINUOUS])
def test_a_part_on_a_carrier_without_one_of_its_joints_keeps_the_other(kind):
    chair = make_object("office_chair", 0)
    carried = next(part for part in range(len(chair.parts)) if not len(chair.parts[part].faces))
    pair = [joint for joint in chair.joints if carried in (joint.parent, joint.child)]
    gone = next(joint for joint in pair if joint.kind is kind)
    (left,) = [joint for joint in pair if joint is not gone]
    found = welded(chair, {gone.name})
    assert all(len(part.faces) for part in found.parts)
    assert len(found.joints) == len(chair.joints) - 1
    moved = chair.parts[next(joint.child for joint in pair if joint.parent == carried)].faces
    assert set(moved) <= set(found.parts[found.joint(left.name).child].faces)
