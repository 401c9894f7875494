"""What stands in a joint's way may make way for it, but only if it opens before it."""

import pytest
from box_world import body, described, joint
from fault_corpus.broken_motion import deadlock
from fault_corpus.exhibits import urdf

from asset_factory.sim_checks.checks.penetration import check_penetration
from asset_factory.sim_checks.config import PenetrationConfig
from asset_factory.sim_checks.read.read import read_description
from asset_factory.sim_checks.report import Severity

CONFIG = PenetrationConfig()
BASE = body("base", [((0.0, 0.0, -1.0), (4.0, 4.0, 0.1))])
OUT = (0.0, -1.0, 0.0)


def gate(name, at, size, axis):
    """A board that slides by 1 m along an axis."""
    return body(name, [(at, size)]), joint(
        f"{name}_slide", "prismatic", "base", name, (0, 0, 0), axis, (0.0, 1.0)
    )


def drawer(x=0.0, z=0.0):
    """Comes out along -y by 0.5 m; its front is at y = 0."""
    boxes = [((x, 0.25, z), (0.4, 0.5, 0.2))]
    return body("drawer", boxes), joint(
        "drawer_slide", "prismatic", "base", "drawer", (0, 0, 0), OUT, (0.0, 0.5)
    )


def built(*parts):
    return described([BASE, *(link for link, _ in parts)], [line for _, line in parts])


def checked(description):
    result = check_penetration(description, CONFIG)
    return result, {item["joint"]: item for item in result.measurements["joints"]}


def hard(result):
    return [(item.code, item.joint) for item in result.findings if item.severity is Severity.ERROR]


#: Before the drawer, gone to the right.
DOOR = gate("door", (0.0, -0.05, 0.0), (0.6, 0.04, 0.4), (1.0, 0.0, 0.0))


def test_a_drawer_behind_a_door_needs_the_door_open():
    result, joints = checked(built(DOOR, drawer()))
    assert hard(result) == []
    assert joints["drawer_slide"]["needs_open"] == ["door_slide"]
    assert joints["drawer_slide"]["with_those_open"]["excess_mm"] == 0.0
    assert joints["door_slide"]["needs_open"] == []
    (found,) = (item for item in result.findings if item.code == "joint_dependency")
    assert "with door_slide open" in found.message


def test_two_that_bar_each_other_never_open(tmp_path):
    result, joints = checked(read_description(urdf(deadlock())(tmp_path)))
    assert hard(result) == [("sweep_penetration", "along_x"), ("sweep_penetration", "along_y")]
    assert joints["along_x"]["waits_for"] == ["along_y"]
    assert joints["along_y"]["waits_for"] == ["along_x"]
    assert joints["along_x"]["needs_open"] == []
    assert 0.04 < joints["along_x"]["clear_until"] < 0.06


#: Gone upwards before the door can go aside.
BAR = gate("bar", (0.45, -0.05, 0.0), (0.1, 0.04, 0.3), (0.0, 0.0, 1.0))
#: Opens to before the drawer, which with all others at upper would not come out.
LID = gate("lid", (0.0, -0.2, 1.0), (0.3, 0.04, 0.2), (0.0, 0.0, -1.0))
LEFT = gate("left", (-0.15, -0.05, 0.0), (0.28, 0.04, 0.4), (-1.0, 0.0, 0.0))
RIGHT = gate("right", (0.15, -0.05, 0.0), (0.28, 0.04, 0.4), (1.0, 0.0, 0.0))
OUTER = gate("outer", (0.0, -0.3, 0.0), (0.6, 0.04, 0.4), (-1.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ("parts", "needs"),
    [
        ((drawer(), DOOR, BAR), {"door": ["bar_slide"], "drawer": ["bar_slide", "door_slide"]}),
        ((DOOR, LID, drawer()), {"drawer": ["door_slide"]}),
        ((drawer(), LEFT, RIGHT), {"drawer": ["left_slide", "right_slide"]}),
        ((drawer(), DOOR, OUTER), {"drawer": ["door_slide", "outer_slide"]}),
    ],
    ids=["a chain opens from its outer end", "who would be in the way stays shut", "two doors",
         "two doors one behind the other"],
)  # fmt: skip
def test_a_drawer_needs_open_what_must_make_way_and_no_more(parts, needs):
    result, joints = checked(built(*parts))
    assert hard(result) == []
    found = {link.name: joints[line.name]["needs_open"] for link, line in parts}
    assert found == {link.name: needs.get(link.name, []) for link, _ in parts}


def test_what_waits_for_a_door_that_never_opens_is_stuck_too():
    post = body("base", [((0, 0, -1), (4, 4, 0.1)), ((0.5, -0.05, 0.0), (0.05, 0.04, 2))])
    link, slide = drawer()
    result, joints = checked(described([post, link, DOOR[0]], [slide, DOOR[1]]))
    assert hard(result) == [("sweep_penetration", f"{name}_slide") for name in ("drawer", "door")]
    assert joints["drawer_slide"]["waits_for"] == ["door_slide"]
    assert joints["door_slide"]["waits_for"] == []
    assert "door_slide would have to make way" in next(
        f.message for f in result.findings if f.joint == "drawer_slide"
    )


def test_doors_that_open_only_one_at_a_time_do_not_free_what_needs_both():
    """Each opens alone, but both end in one place: what is behind the two stays shut."""
    left = gate("left", (-0.15, -0.05, 0.0), (0.28, 0.04, 0.4), (0.0, 0.0, 1.0))
    boxes = [
        ((0.15, -0.05, 0), (0.28, 0.04, 0.4)),
        ((-0.45, -0.05, 1), (0.1, 0.04, 0.1)),
    ]
    line = joint("right_slide", "prismatic", "base", "right", (0, 0, 0), (1, 0, 0), (0.0, 0.3))
    right = body("right", boxes), line
    result, joints = checked(built(drawer(), left, right))
    assert set(hard(result)) == {("sweep_penetration", "drawer_slide")}
    assert [joints[name]["needs_open"] for name in ("left_slide", "right_slide")] == [[], []]
    assert joints["drawer_slide"]["clear_until"] == pytest.approx(0.03, abs=0.005)
