"""A drawer's front and its box, found by two proposers, slide as one part."""

from dataclasses import replace

import numpy as np
import pytest
from plain_solids import box_between, parted

from asset_factory.factory.articulate.detected.boxes import with_whole_drawers
from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.part import PartKind

CASE = box_between((-0.5, 0.0, 0.0), (0.5, 0.5, 0.02))
DRAWER = box_between((-0.4, 0.0, 0.1), (0.4, 0.02, 0.3))


def cabinet(low, high, kind=PartKind.PART, axis=(0.0, -1.0, 0.0), joint=JointKind.PRISMATIC):
    """A case with a drawer, and before it in the tree a part between two corners [m]."""
    slides = ((1, axis, joint), (2, (0.0, -1.0, 0.0), JointKind.PRISMATIC))
    joints = (Joint(f"j{n}", how, 0, n, np.array(a), np.zeros(3), 0.0, 0.3) for n, a, how in slides)
    made = parted({"base": [CASE], "own": [box_between(low, high)], "drawer": [DRAWER]}, *joints)
    kinds = (PartKind.BODY, kind, PartKind.DRAWER)
    parts = (replace(part, kind=each) for part, each in zip(made.parts, kinds, strict=True))
    return replace(made, parts=tuple(parts))


@pytest.mark.parametrize(
    ("low", "high"),
    [
        ((-0.35, 0.02, 0.12), (0.35, 0.4, 0.28)),
        ((-0.42, -0.02, 0.08), (0.42, 0.0, 0.32)),
        ((0.0, 0.05, 0.12), (0.41, 0.4, 0.28)),
    ],
    ids=["its box", "its front", "half of its box, a little beside it"],
)
def test_what_slides_in_line_with_a_drawer_is_part_of_it(low, high):
    made = cabinet(low, high)
    whole = with_whole_drawers(made)
    assert [part.name for part in whole.parts] == ["base", "drawer"]
    faces = np.sort(whole.parts[1].faces)
    assert faces.tolist() == np.sort(np.concatenate([p.faces for p in made.parts[1:]])).tolist()
    assert [joint.name for joint in whole.joints] == ["j2"]


@pytest.mark.parametrize(
    "made",
    [
        cabinet((-0.4, 0.0, 0.32), (0.4, 0.02, 0.5)),
        cabinet((-0.5, -0.02, 0.0), (0.5, 0.0, 0.5)),
        cabinet((-0.35, 0.02, 0.12), (0.35, 0.4, 0.28), kind=PartKind.DRAWER),
        cabinet((-0.35, 0.02, 0.12), (0.35, 0.4, 0.28), axis=(1.0, 0.0, 0.0)),
        cabinet((-0.35, 0.02, 0.12), (0.35, 0.4, 0.28), joint=JointKind.REVOLUTE),
    ],
    ids=["above it", "a whole front", "a drawer of its own", "another way", "turns"],
)
def test_what_does_not_is_left(made):
    assert with_whole_drawers(made) is made


def test_a_part_that_carries_another_is_left():
    made = cabinet((-0.35, 0.02, 0.12), (0.35, 0.4, 0.28))
    drawer = replace(made.joints[1], parent=1)
    carried = replace(made, joints=(made.joints[0], drawer))
    assert with_whole_drawers(carried) is carried
