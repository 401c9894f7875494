"""What is seen on single sides, and by several proposers, becomes parts, each once."""

from dataclasses import replace

import numpy as np
import pytest
from plain_solids import box_between, parted

from asset_factory.factory.articulate.detected.boxes import with_whole_drawers
from asset_factory.factory.articulate.detected.merging import likely_hinges, seen_parts
from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.intake.stated import Hinge, StatedKind
from asset_factory.factory.models.detector.canvas import (
    CANVAS,
    LONGEST,
    WAYS,
    PanelWay,
    Sort,
)
from asset_factory.factory.models.detector.decode import Found
from asset_factory.factory.part import PartKind
from asset_factory.factory.views.raster import Side

TALL = np.array([0.5, 0.5, 1.0])


def seen(side, box, sort, way, score=0.9, sure=0.95, extents=TALL):
    """Return a part that is seen in shares of a side's picture."""
    wide, high = np.abs(side.frame[:2] @ (extents / extents.max() * LONGEST))
    low = (CANVAS - np.array([wide, high])) / 2.0
    corners = (low + np.array(box).reshape(2, 2) * [wide, high]).ravel()
    ways = np.full(len(WAYS), (1.0 - sure) / (len(WAYS) - 1))
    ways[WAYS.index(way)] = sure
    return Found(side, corners, sort, score, ways)


def stated_parts(found, extents):
    return tuple(part.stated for part in seen_parts(found, extents))


def test_panels_keep_their_side_box_and_hinge():
    found = [
        seen(Side.FRONT, [0.0, 0.6, 1.0, 1.0], Sort.DOOR, PanelWay.RIGHT),
        seen(Side.FRONT, [0.0, 0.0, 1.0, 0.3], Sort.DRAWER, PanelWay.OUT),
        seen(Side.LEFT, [0.1, 0.4, 0.9, 0.8], Sort.FLAP, PanelWay.BOTTOM),
    ]
    parts = {part.kind: part for part in stated_parts(found, TALL)}
    assert parts[StatedKind.DOOR].hinge is Hinge.RIGHT
    assert parts[StatedKind.DRAWER].hinge is None
    assert parts[StatedKind.FLAP].side is Side.LEFT
    assert parts[StatedKind.DOOR].box == pytest.approx((0.0, 0.6, 1.0, 1.0))


def test_an_unsure_hinge_is_left_to_geometry():
    door = seen(Side.FRONT, [0.0, 0.0, 1.0, 1.0], Sort.DOOR, PanelWay.LEFT, sure=0.4)
    unsure = door.ways.copy()
    unsure[WAYS.index(PanelWay.RIGHT)] = 0.35
    (part,) = stated_parts([replace(door, ways=unsure)], TALL)
    assert part.hinge is None


@pytest.mark.parametrize(("high", "kind"), [(1.0, StatedKind.DOOR), (0.5, StatedKind.DRAWER)])
def test_what_is_much_higher_than_wide_is_no_drawer(high, kind):
    drawer = seen(Side.FRONT, [0.0, 0.0, 1.0, high], Sort.DRAWER, PanelWay.OUT)
    (part,) = stated_parts([drawer], TALL)
    assert part.kind is kind


def test_a_panel_in_another_is_left_out():
    whole = seen(Side.FRONT, [0.0, 0.0, 1.0, 1.0], Sort.DOOR, PanelWay.LEFT, score=0.9)
    half = seen(Side.FRONT, [0.0, 0.0, 1.0, 0.5], Sort.DRAWER, PanelWay.OUT, score=0.6)
    assert [part.kind for part in stated_parts([half, whole], TALL)] == [StatedKind.DOOR]


def test_a_panel_that_is_seen_from_behind_too_is_one():
    extents = np.array([0.5, 0.05, 1.0])
    front = seen(Side.FRONT, [0.1, 0, 0.9, 1], Sort.DOOR, PanelWay.LEFT, 0.9, extents=extents)
    behind = seen(Side.BACK, [0.1, 0, 0.9, 1], Sort.DOOR, PanelWay.RIGHT, 0.7, extents=extents)
    (part,) = stated_parts([behind, front], extents)
    assert part.side is Side.FRONT


def test_a_lid_that_all_sides_show_is_one_hinged_where_most_say():
    top = [0.0, 0.7, 1.0, 1.0]
    found = [
        seen(Side.FRONT, top, Sort.LID, PanelWay.TOP, 0.95),
        seen(Side.RIGHT, top, Sort.LID, PanelWay.RIGHT, 0.8),
        seen(Side.LEFT, top, Sort.LID, PanelWay.TOP, 0.6),
        seen(Side.TOP, [0, 0, 1, 1], Sort.LID, PanelWay.TOP, 0.9),
    ]
    (lid,) = stated_parts(found, TALL)
    assert lid.kind is StatedKind.LID
    assert lid.side is Side.FRONT
    assert lid.hinge is Hinge.BACK
    assert lid.box[1] == pytest.approx(0.7)


def test_sides_that_contradict_one_another_still_say_along_which_axis_a_lid_is_hinged():
    top = [0.0, 0.7, 1.0, 1.0]
    found = [
        seen(Side.RIGHT, top, Sort.LID, PanelWay.TOP, 0.9),
        seen(Side.LEFT, top, Sort.LID, PanelWay.TOP, 0.9),
        seen(Side.TOP, [0, 0, 1, 1], Sort.LID, PanelWay.TOP, 0.8),
    ]
    (lid,) = stated_parts(found, TALL)
    assert lid.hinge is None
    assert likely_hinges(found)[:2] == [Side.LEFT, Side.RIGHT]


def test_a_lid_that_only_the_top_shows_is_in_the_top():
    (lid,) = stated_parts([seen(Side.TOP, [0.2, 0.2, 0.8, 0.8], Sort.LID, PanelWay.LEFT)], TALL)
    assert lid.side is Side.TOP
    assert lid.hinge is Hinge.LEFT


def test_what_moves_otherwise_is_no_panel():
    wheel = seen(Side.FRONT, [0.0, 0.0, 0.2, 0.1], Sort.OTHER, PanelWay.OTHER)
    knob = seen(Side.FRONT, [0.4, 0.4, 0.5, 0.5], Sort.CONTROL, PanelWay.OTHER)
    assert stated_parts([wheel, knob], TALL) == ()


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
    carried = replace(made, joints=(made.joints[0], replace(made.joints[1], parent=1)))
    assert with_whole_drawers(carried) is carried
