"""What moves has to come near what carries it, somewhere on its way."""

from dataclasses import replace

import pytest
from box_world import body, box_shape, described, joint, with_joint, with_link

from asset_factory.sim_checks.checks.attachment import check_attachment
from asset_factory.sim_checks.config import LintConfig

T = 0.02
#: An open cabinet, a metre wide and deep, of boards.
CARCASS = [
    ((-0.49, 0, 0.5), (T, 1, 1)),
    ((0.49, 0, 0.5), (T, 1, 1)),
    ((0, 0.49, 0.5), (1, T, 1)),
    ((0, 0, 0.01), (1, 1, T)),
    ((0, 0, 0.99), (1, 1, T)),
]


def sliding(y, reach=0.1):
    """A board before, or within, the cabinet; it slides along -y."""
    board = body("door", [((0.0, y, 0.5), (0.6, T, 0.6))])
    slide = joint("slide", "prismatic", "carcass", "door", (0, 0, 0), (0, -1, 0), (0.0, reach))
    return described([body("carcass", CARCASS), board], [slide])


def gaps(description):
    found = check_attachment(description, LintConfig()).findings
    assert all((each.code, str(each.severity)) == ("part_detached", "error") for each in found)
    return [each.value for each in found if each.value is not None]


def test_a_door_in_the_middle_of_its_hollow_cabinet_hangs_on_nothing():
    assert gaps(sliding(0.0)) == [pytest.approx(180.0)]


def test_a_finger_s_width_in_one_pose_is_enough():
    wide = sliding(0.0)
    within = body("door", [((0.0, 0.0, 0.5), (0.93, T, 0.6))])
    assert gaps(with_link(wide, "door", collisions=within.collisions)) == []
    assert gaps(sliding(0.2)) == [pytest.approx(180.0, abs=1.0)]
    near = with_joint(sliding(0.35), "slide", lower=-0.11, upper=0.0)
    assert gaps(near) == []


def test_a_handle_that_is_only_seen_holds_it_too():
    hung = sliding(0.0)
    shapes = (*hung.links[1].visuals, box_shape((0.4, 0.0, 0.5), (0.2, T, T)))
    assert gaps(with_link(hung, "door", visuals=shapes)) == []


def test_links_without_shapes_between_do_not_count():
    far = sliding(0.0)
    bare = replace(body("between", CARCASS), collisions=(), visuals=())
    turn = joint("turn", "revolute", "carcass", "between", (0, 0, 0), (0, 0, 1), (0.0, 0.1))
    chained = with_joint(far, "slide", parent="between")
    chained = replace(chained, links=(*far.links, bare), joints=(turn, *chained.joints))
    assert len(gaps(chained)) == 2


@pytest.mark.parametrize(("behind", "alarms"), [(0.0, 0), (0.02, 0), (0.4, 1)])
def test_a_hinge_holds_its_door_in_every_pose(behind, alarms):
    hinge = (-0.5, -0.5 + behind, 0.5)
    door = body("door", [((0.0, -0.52, 0.5), (1.0, T, 1.0))], hinge)
    turn = joint("hinge", "revolute", "carcass", "door", hinge, (0, 0, -1), (0.0, 1.57))
    assert len(gaps(described([body("carcass", CARCASS), door], [turn]))) == alarms
