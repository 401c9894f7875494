"""Parts made one with what they hang on."""

import numpy as np
import pytest

from asset_factory.factory.articulation import Articulation, JointKind
from asset_factory.factory.geometry.posing import face_parts
from asset_factory.factory.geometry.welding import welded
from asset_factory.learn.objects import make_object

CABINET = make_object("cabinet", 0)


def test_a_welded_part_belongs_to_its_parent_and_the_others_move_as_before():
    gone = CABINET.joints[0]
    left = CABINET.joints[1]
    found = welded(CABINET, {gone.name})
    assert isinstance(found, Articulation)
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
