"""Trees of parts: chains move along, carriers make a part that turns and slides."""

from __future__ import annotations

import numpy as np
import pytest

from asset_factory.factory.articulation import JointKind
from asset_factory.factory.training.objects.looks import BLACK, STEEL
from asset_factory.factory.training.objects.solids import box
from asset_factory.factory.training.objects.trees import hinge, slider, tree, wheel

BODY = [box((3.0, 4.0), (0.0, 1.0), (5.0, 6.0), STEEL)]
ARM = [box((3.0, 4.0), (0.0, 1.0), (6.1, 7.0), BLACK)]
HAND = [box((3.0, 4.0), (0.0, 1.0), (7.1, 8.0), BLACK)]


def test_the_object_is_put_on_the_ground_over_the_origin_with_its_joints():
    made = tree(BODY, [hinge("arm", ARM, (0, 0, 1), (3.0, 0.0, 6.0), 1.0)])
    np.testing.assert_allclose(made.mesh.bounds, [[-0.5, -0.5, 0.0], [0.5, 0.5, 2.0]], atol=1e-12)
    assert made.mesh.bounds[0, 2] == 0.0
    np.testing.assert_allclose(made.joint("arm_joint").origin, [-0.5, -0.5, 1.0])


def test_what_hangs_on_a_part_moves_with_it():
    made = tree(
        BODY,
        [
            hinge("arm", ARM, (0, 0, 1), (3.0, 0.0, 6.0), 1.0),
            slider("hand", HAND, (1, 0, 0), (3.0, 0.0, 7.0), 0.5, parent="arm"),
        ],
    )
    assert [(j.parent, j.child) for j in made.joints] == [(0, 1), (1, 2)]
    poses = made.poses({"arm_joint": np.pi / 2, "hand_joint": 0.25})
    # The hand's own slide, along +X, has turned into +Y.
    np.testing.assert_allclose(poses[2][:3, 3] - poses[1][:3, 3], [0.0, 0.25, 0.0], atol=1e-12)


def test_a_part_that_turns_and_slides_hangs_on_a_carrier_without_faces():
    made = tree(
        BODY,
        [
            wheel("cap", ARM, (0, 0, 1), (3.5, 0.5, 6.0), slide=0.2),
            hinge("tab", HAND, (1, 0, 0), (3, 0, 7), 1.0, parent="cap"),
        ],
    )
    assert [p.name for p in made.parts] == ["body", "cap_carrier", "cap", "tab"]
    assert len(made.parts[1].faces) == 0
    turn, slide, tab = made.joints
    assert (turn.kind, slide.kind) == (JointKind.CONTINUOUS, JointKind.PRISMATIC)
    assert (turn.lower, turn.upper) == (-np.pi, np.pi)
    assert (slide.lower, slide.upper) == (0.0, 0.2)
    assert tab.parent == 2
    assert sum(len(p.faces) for p in made.parts) == len(made.mesh.faces)


def test_a_limb_without_its_parent_is_refused():
    with pytest.raises(KeyError, match="nobody"):
        tree(BODY, [hinge("arm", ARM, (0, 0, 1), (0, 0, 0), 1.0, parent="nobody")])
