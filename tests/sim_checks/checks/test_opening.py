"""What stands in a joint's way may make way for it, but only if it opens before it."""

import pytest
from box_world import body, built, penetrating, sliding
from fault_corpus.broken_motion import deadlock
from fault_corpus.exhibits import urdf
from small_cabinet import rows

from asset_factory.sim_checks.read.read import read_description
from asset_factory.sim_checks.report import Severity


def gate(name, at, size, axis):
    """A board that slides by 1 m along an axis."""
    return sliding(name, [(at, size)], axis, 1.0)


def checked(description):
    result = penetrating(description)
    return result, rows(result)


def hard(result):
    return [(item.code, item.joint) for item in result.findings if item.severity is Severity.ERROR]


#: Comes out along -y by 0.5 m; its front is at y = 0.
DRAWER = sliding("drawer", [((0.0, 0.25, 0.0), (0.4, 0.5, 0.2))], (0.0, -1.0, 0.0), 0.5)
#: Before the drawer, gone to the right.
DOOR = gate("door", (0.0, -0.05, 0.0), (0.6, 0.04, 0.4), (1.0, 0.0, 0.0))
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
        ((DOOR, DRAWER), {"drawer": ["door"]}),
        ((DRAWER, DOOR, BAR), {"door": ["bar"], "drawer": ["bar", "door"]}),
        ((DOOR, LID, DRAWER), {"drawer": ["door"]}),
        ((DRAWER, LEFT, RIGHT), {"drawer": ["left", "right"]}),
        ((DRAWER, DOOR, OUTER), {"drawer": ["door", "outer"]}),
    ],
    ids=["a door", "a chain opens from its outer end", "who would be in the way stays shut",
         "two doors", "two doors one behind the other"],
)  # fmt: skip
def test_a_drawer_needs_open_what_must_make_way_and_no_more(parts, needs):
    result, joints = checked(built(*parts))
    assert hard(result) == []
    assert {name: row["needs_open"] for name, row in joints.items() if row["needs_open"]} == needs
    assert joints["drawer"]["with_those_open"]["excess_mm"] == 0.0
    told = {item.joint: item.message for item in result.findings if item.code == "joint_dependency"}
    assert told.keys() == needs.keys()
    assert f"with {' and '.join(needs['drawer'])} open" in told["drawer"]


def test_two_that_bar_each_other_never_open(tmp_path):
    result, joints = checked(read_description(urdf(deadlock())(tmp_path)))
    assert hard(result) == [("sweep_penetration", "along_x"), ("sweep_penetration", "along_y")]
    waiting = {name: (row["waits_for"], row["needs_open"]) for name, row in joints.items()}
    assert waiting == {"along_x": (["along_y"], []), "along_y": (["along_x"], [])}
    assert 0.04 < joints["along_x"]["clear_until"] < 0.06


def test_what_waits_for_a_door_that_never_opens_is_stuck_too():
    post = body("base", [((0, 0, -1), (4, 4, 0.1)), ((0.5, -0.05, 0.0), (0.05, 0.04, 2))])
    result, joints = checked(built(DRAWER, DOOR, base=post))
    assert hard(result) == [("sweep_penetration", "drawer"), ("sweep_penetration", "door")]
    waiting = {name: row["waits_for"] for name, row in joints.items()}
    assert waiting == {"drawer": ["door"], "door": []}
    assert "door would have to make way" in result.findings[0].message


def test_doors_that_open_only_one_at_a_time_do_not_free_what_needs_both():
    """Each opens alone, but both end in one place: what is behind the two stays shut."""
    left = gate("left", (-0.15, -0.05, 0.0), (0.28, 0.04, 0.4), (0.0, 0.0, 1.0))
    boxes = [((0.15, -0.05, 0), (0.28, 0.04, 0.4)), ((-0.45, -0.05, 1), (0.1, 0.04, 0.1))]
    result, joints = checked(built(DRAWER, left, sliding("right", boxes, (1.0, 0.0, 0.0), 0.3)))
    assert set(hard(result)) == {("sweep_penetration", "drawer")}
    assert [joints[name]["needs_open"] for name in ("left", "right")] == [[], []]
    assert joints["drawer"]["clear_until"] == pytest.approx(0.03, abs=0.005)
