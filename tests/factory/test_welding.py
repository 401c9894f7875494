"""Parts made one with what they hang on."""

import numpy as np

from asset_factory.factory.articulation import Articulation
from asset_factory.factory.posing import face_parts
from asset_factory.factory.training.objects import make_object
from asset_factory.factory.welding import welded

CABINET = make_object("cabinet", 0)


def test_a_welded_part_belongs_to_its_parent_and_the_others_move_as_before():
    gone, left = CABINET.joints[0], CABINET.joints[1]
    found = welded(CABINET, {gone.name})
    assert isinstance(found, Articulation)
    assert [joint.name for joint in found.joints] == [joint.name for joint in CABINET.joints[1:]]
    assert (face_parts(found)[CABINET.parts[gone.child].faces] == 0).all()
    before, after = CABINET.poses({left.name: left.upper}), found.poses({left.name: left.upper})
    assert np.array_equal(before[left.child], after[found.joint(left.name).child])


def test_what_hangs_on_a_welded_part_hangs_on_its_parent():
    chain = make_object("desk_lamp", 1)
    first = next(joint for joint in chain.joints if any(other.parent == joint.child for other in chain.joints))
    found = welded(chain, {first.name})
    assert len(found.parts) == len(chain.parts) - 1
    orphan = next(joint for joint in chain.joints if joint.parent == first.child)
    assert found.parts[found.joint(orphan.name).parent].name == chain.parts[first.parent].name


def test_nothing_welded_is_the_same():
    assert [part.name for part in welded(CABINET, ()).parts] == [part.name for part in CABINET.parts]
