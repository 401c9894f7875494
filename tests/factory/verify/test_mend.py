"""A joint that is slightly wrong is mended where that frees it, told, and can be left alone."""

from dataclasses import replace

import numpy as np
import pytest
from plain_solids import parted, sized_box, sized_hull
from test_repair import contact, hard, joint, verdict

from asset_factory.factory.articulation import Joint, JointKind
from asset_factory.factory.asset import Asset, Hull, Inertial, PartBody
from asset_factory.factory.config import RepairConfig
from asset_factory.factory.geometry.posing import posed
from asset_factory.factory.manufacture.plan import Plan, Spare, as_planned
from asset_factory.factory.manufacture.repair import RepairKind
from asset_factory.factory.manufacture.separate.sweep import swept_m
from asset_factory.factory.mesh import Mesh
from asset_factory.factory.part import PartKind
from asset_factory.factory.verify.repair import next_plan

CONFIG = RepairConfig()
#: The hulls of both are cut apart already.
STARTED = Plan(separate=frozenset({("base", "door")}))
SURE = Spare()
#: The door may be fixed where it cannot move.
SMALL = Spare(joints=frozenset({"hinge"}))
UP = (0.0, 0.0, 1.0)
DOWN = (0.0, 0.0, -1.0)
#: By 8 degrees.
TILTED = (np.sin(np.radians(8.0)), 0.0, -np.cos(np.radians(8.0)))
#: At the outer front edge of the door's end.
EDGE = (-0.3, -0.225, 0.0)


def cabinet(
    axis=UP, origin=EDGE, upper=1.5, lower=0.0, kind=JointKind.REVOLUTE, more=None, joints=()
):
    """A block with a door before it, whose front is at -y; the door hangs at its left edge.

    There may be more boxes, of these parts or of others, which joints hold: sizes and middles.
    """
    boxes = {"base": [((0.6, 0.4, 0.8), (0.0, 0.0, 0.0))]}
    boxes["door"] = [((0.6, 0.02, 0.8), (0.0, -0.215, 0.0))]
    for name, added in (more or {}).items():
        boxes[name] = boxes.get(name, []) + added
    direction = np.array(axis) / np.linalg.norm(axis)
    hinge = Joint("hinge", kind, 0, 1, direction, np.asarray(origin), lower, upper)
    inertial = Inertial(1.0, np.zeros(3), np.eye(3))
    hulls = [tuple(sized_hull(*each) for each in own) for own in boxes.values()]
    bodies = tuple(PartBody(own, inertial, None, "exact") for own in hulls)
    meshes = {
        name: [Mesh.from_triangles(*sized_box(*each)) for each in own]
        for name, own in boxes.items()
    }
    return Asset("cabinet", parted(meshes, hinge, *joints), bodies)


def above(origin=EDGE, axis=UP):
    """The hinge of another door above the first."""
    return Joint("above", JointKind.REVOLUTE, 0, 2, np.array(axis), np.array(origin), 0.0, 1.5)


def blocked(asset, clear_until):
    upper = asset.articulation.joints[0].upper
    measured = joint(upper=upper, clear_until=clear_until, pairs=[contact(5.0, at=upper)])
    return verdict(hard("sweep_penetration", name="hinge"), joints=[measured])


def mended(asset, clear_until=0.01, plan=STARTED, config=CONFIG, spare=SURE):
    return next_plan(blocked(asset, clear_until), plan, config, spare, asset)


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        # About +z it turns into the block; about -z it opens.
        ({"axis": UP}, "opened inwards"),
        ({"axis": TILTED}, "8.0 degrees off"),
        ({"axis": DOWN, "origin": (-0.27, -0.205, 0.0)}, "front edge"),
    ],
    ids=["turned round", "straightened", "moved to the edge"],
)
def test_what_is_slightly_wrong_of_a_hinge_is_mended_and_told(wrong, told):
    asset = cabinet(**wrong)
    plan = mended(asset)
    assert told in plan.repairs[-1].sentence
    hinge = as_planned(asset.articulation, plan).joints[0]
    assert hinge.axis == pytest.approx(DOWN)
    assert hinge.origin[:2] == pytest.approx(EDGE[:2])
    assert (hinge.lower, hinge.upper) == (0.0, 1.5)


def test_a_hinge_in_what_the_door_lies_before_goes_to_the_edge_between_them():
    # 45 mm behind the door and 30 beside its edge; the front edge is too far.
    inside = cabinet(axis=DOWN, origin=(-0.27, -0.16, 0.0), upper=np.pi)
    plan = mended(inside)
    assert "54.1 mm off its panel's back edge" in plan.repairs[-1].sentence
    hung = as_planned(inside.articulation, plan).joints[0]
    assert hung.origin[:2] == pytest.approx((-0.3, -0.205))
    assert swept_m(inside, hung) < 1e-4


@pytest.mark.parametrize(("deep", "left"), [(0.008, True), (0.03, False)])
def test_what_the_edge_leaves_in_the_way_is_for_the_cut_that_follows(deep, left):
    # A side of the cabinet that reaches beyond the door's edge, before its front.
    beside = {"base": [((0.02, 0.2, 0.8), (-0.311, -0.105 - deep, 0.0))]}
    plan = mended(cabinet(axis=DOWN, origin=(-0.27, -0.16, 0.0), more=beside))
    assert (plan is not None and "back edge" in plan.repairs[-1].sentence) is left


@pytest.mark.parametrize(
    "asset",
    [
        cabinet(axis=DOWN, origin=(0.0, -0.215, 0.0)),
        cabinet(axis=DOWN, origin=(-0.05, 0.1, 0.0)),
        cabinet(axis=(1.0, 0.0, 1.0)),
    ],
    ids=["turns about its middle", "hung in the block", "an axis far off"],
)
def test_what_no_small_change_frees_is_left_to_the_judge(asset):
    assert mended(asset) is None


def test_a_hinge_that_no_edge_frees_goes_to_the_line_of_its_neighbour():
    # A side reaches before the door, and its rim before its own front edge, so that neither edge
    # will do; the true line is that of the door above.
    line = (-0.3, -0.24, 0.0)
    wrong = {"axis": DOWN, "origin": (-0.27, -0.205, 0.0)}
    more = {
        "base": [((0.02, 0.2, 0.8), (-0.311, -0.135, 0.0))],
        "door": [((0.02, 0.1, 0.8), (-0.29, -0.275, 0.0))],
    }
    assert mended(cabinet(**wrong, more=more)) is None
    more["upper"] = [((0.6, 0.02, 0.3), (0.0, -0.215, 0.6))]
    plan = mended(cabinet(**wrong, more=more, joints=[above(line, DOWN)]))
    assert "46.1 mm off that of its neighbour" in plan.repairs[-1].sentence
    assert plan.mended["hinge"].origin == pytest.approx(line)


def test_doors_on_one_line_are_turned_round_together():
    # Something stands 3.5 mm in the lower door's way out, which a cut may plane off.
    more = {"base": [((0.1, 0.1, 0.8), (-0.3, -0.87, 0.0))]}
    assert mended(cabinet(more=more)) is None
    more["base"].append(((0.6, 0.4, 0.4), (0.0, 0.0, 0.6)))
    more["upper"] = [((0.6, 0.02, 0.3), (0.0, -0.215, 0.6))]
    asset = cabinet(more=more, joints=[above()])
    stuck = [joint(name, upper=1.5, clear_until=0.01) for name in ("hinge", "above")]
    given = verdict(hard("sweep_penetration", name="hinge"), joints=stuck)
    started = Plan(separate=frozenset({("base", "door"), ("base", "upper")}))
    plan = next_plan(given, started, CONFIG, SURE, asset)
    axes = {name: tuple(each.axis) for name, each in plan.mended.items()}
    assert axes == {"hinge": DOWN, "above": DOWN}


def test_what_is_askew_and_goes_too_far_is_straightened_and_ended():
    asset = cabinet(axis=TILTED, upper=5.5)
    plan = mended(asset)
    assert [each.sentence.split()[0] for each in plan.repairs] == ["mended", "ended"]
    hinge = as_planned(asset.articulation, plan).joints[0]
    assert hinge.axis == pytest.approx(DOWN)
    assert 2.75 <= hinge.upper < 4.75
    # What would have to be turned round besides is no small change.
    assert mended(replace(asset, articulation=cabinet(axis=(1.0, 0.0, 1.0)).articulation)) is None


@pytest.mark.parametrize("axis", [TILTED, (0.3, 0.0, -1.0)], ids=["a little", "much"])
def test_a_hinge_that_is_askew_to_its_door_turns_about_its_edge(axis):
    asset = cabinet(axis=axis)
    told = verdict(hard("axis_oblique", name="hinge"))
    plan = next_plan(told, STARTED, CONFIG, SURE, asset)
    assert [each.kind for each in plan.repairs] == [RepairKind.AXIS_SQUARED]
    hinge = as_planned(asset.articulation, plan).joints[0]
    assert hinge.axis == pytest.approx(DOWN)
    assert hinge.origin == pytest.approx(EDGE)
    assert next_plan(told, plan, CONFIG, SURE, asset) is None, "once"
    geometry = replace(CONFIG, kinds="geometry")
    assert next_plan(told, STARTED, geometry, SURE, asset) is None


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("ajar", [0.0, 0.7])
def test_a_hinge_without_limits_goes_as_far_as_it_is_free_and_closes_where_it_is_smallest(
    sign, ajar
):
    shut = cabinet(axis=DOWN)
    drawn = posed(shut.articulation, {"hinge": ajar})
    turn = shut.articulation.joints[0].motion(ajar)
    door = shut.bodies[1].hulls[0]
    moved = Hull(door.vertices @ turn[:3, :3].T + turn[:3, 3], door.faces)
    turn = {"axis": np.array([0.0, 0.0, sign]), "lower": -np.pi, "upper": np.pi}
    endless = replace(drawn.joints[0], kind=JointKind.CONTINUOUS, **turn)
    bodies = (shut.bodies[0], replace(shut.bodies[1], hulls=(moved,)))
    asset = replace(shut, articulation=replace(drawn, joints=(endless,)), bodies=bodies)
    plan = mended(asset)
    planned = as_planned(asset.articulation, plan)
    hinge = planned.joints[0]
    assert hinge.kind is JointKind.REVOLUTE
    if not ajar:
        assert planned.parts[1].kind is PartKind.DOOR
    assert hinge.axis == pytest.approx(DOWN)
    assert hinge.lower == pytest.approx(-ajar, abs=0.06)
    assert 4.4 < hinge.upper + ajar < 4.75
    assert "had none" in plan.repairs[-1].sentence


def test_what_has_no_room_to_turn_without_limits_gets_none():
    # Between two blocks before the cabinet.
    walls = [((0.1, 0.6, 0.8), (x, -0.53, 0.0)) for x in (-0.36, 0.36)]
    more = {"base": [*walls, ((0.6, 0.1, 0.8), (0.0, -0.3, 0.0))]}
    endless = {"kind": JointKind.CONTINUOUS, "lower": -np.pi, "upper": np.pi}
    plan = mended(cabinet(**endless, more=more))
    assert plan is None or not plan.mended


def test_what_turns_without_end_is_as_drawn_while_another_part_moves():
    # Half a turn on, the arm would be in the door's way.
    knob = Joint("knob", JointKind.CONTINUOUS, 0, 2, UP, (0.5, -0.5, 0.0), -np.pi, np.pi)
    arm = {"arm": [((0.4, 0.02, 0.1), (0.75, -0.5, 0.0))]}
    asset = cabinet(axis=DOWN, more=arm, joints=[knob])
    assert swept_m(asset, asset.articulation.joints[0]) < 1e-6


@pytest.mark.parametrize("code", ["jammed", "rest_penetration"])
def test_a_small_part_that_cannot_move_is_fixed_where_nothing_else_is_wrong(code):
    wrong = hard(code, name="hinge" if code == "jammed" else None)
    plan = next_plan(verdict(wrong), STARTED, CONFIG, SMALL, cabinet())
    assert plan.frozen == {"hinge"}
    other = verdict(wrong, hard("jammed", name="other"))
    assert next_plan(other, STARTED, CONFIG, SMALL, cabinet()) is None


def test_a_small_part_that_is_pressed_into_another_is_not_turned_round():
    assert not mended(cabinet(), spare=SMALL).mended


def test_a_joint_is_mended_once_and_only_if_joints_may_be():
    inwards = cabinet()
    assert mended(inwards, plan=mended(inwards)) is None
    for kinds in ("geometry", "none"):
        assert mended(inwards, config=replace(CONFIG, kinds=kinds)) is None


def test_a_joint_that_is_ended_early_ends_where_it_touches_nothing():
    # It opens, and comes into the block again after three quarters of a turn.
    asset = cabinet(axis=DOWN, upper=5.5)
    plan = mended(asset, clear_until=4.8)
    assert not plan.mended
    ended = replace(asset.articulation.joints[0], upper=plan.upper["hinge"])
    assert 2.75 < ended.upper < 4.75
    assert swept_m(asset, ended) < 1e-4


def test_a_closed_end_that_lies_in_something_is_pulled_in():
    # Down to -0.4 it turns into the block; as modelled it is free.
    asset = cabinet(axis=DOWN, lower=-0.4)
    given = verdict(hard("rest_penetration"), rest=[contact(20.0)], joints=[joint()])
    plan = next_plan(given, STARTED, CONFIG, SURE, asset)
    assert "began hinge at" in plan.repairs[-1].sentence
    begins = as_planned(asset.articulation, plan).joints[0].lower
    assert -0.1 < begins <= 0.0


@pytest.mark.parametrize("clear_until", [-0.3, -0.05])
def test_no_joint_ends_before_the_pose_as_modelled(clear_until):
    # Half of its range is free, so it would be long enough; but all of that lies below 0.
    asset = cabinet(axis=DOWN, lower=-1.5, upper=0.4)
    measured = replace(joint(upper=0.4, clear_until=clear_until), lower=-1.5)
    assert (clear_until + 1.5) / 1.9 > CONFIG.least_range_share
    given = verdict(hard("sweep_penetration", name="hinge"), joints=[measured])
    plan = next_plan(given, STARTED, CONFIG, SURE, asset)
    assert plan is None or "hinge" not in plan.upper


def test_a_joint_that_is_never_free_gets_no_end():
    plan = mended(cabinet(axis=DOWN), clear_until=0.0)
    assert plan is None or "hinge" not in plan.upper


def test_a_way_is_looked_at_up_to_its_very_end():
    # The door stands 5 mm before the block, and is pushed 6 mm towards it.
    asset = cabinet(axis=(0.0, 1.0, 0.0), upper=0.006, kind=JointKind.PRISMATIC)
    deepest = swept_m(asset, asset.articulation.joints[0])
    assert deepest == pytest.approx(0.001)
