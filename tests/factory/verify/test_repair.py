"""A plan follows from a verdict alone, never comes twice, and gives up where nothing can help."""

from dataclasses import asdict, replace

import numpy as np
import pytest
from export_samples import cabinet
from modelled_furniture import drawer_chest

from asset_factory.factory.articulate.locate import located
from asset_factory.factory.articulation import Articulation, Joint, JointKind, Part
from asset_factory.factory.config import RepairConfig
from asset_factory.factory.geometry.components import connected_components
from asset_factory.factory.manufacture.plan import (
    MANY_FACES,
    Plan,
    Spare,
    dispensable_joints,
    first_plan,
)
from asset_factory.factory.mesh import Mesh
from asset_factory.factory.part import PartSource, Proposer
from asset_factory.factory.verify.repair import next_plan
from asset_factory.factory.verify.repairs.shorten import SHORTER
from asset_factory.factory.verify.validate import Verdict
from asset_factory.sim_checks import Finding, Report, Severity
from asset_factory.sim_checks.measurements import (
    PENETRATION,
    MeasuredContact,
    MeasuredJoint,
    MeasuredNeighbour,
    MeasuredPair,
    MeasuredPenetration,
)

CONFIG = RepairConfig()
#: A hinge and a slide that move freely, and that were guessed: nobody mends them.
GUESSED = tuple(replace(joint, confidence=0.5) for joint in cabinet().articulation.joints)
ASSET = replace(cabinet(), articulation=replace(cabinet().articulation, joints=GUESSED))
#: The longest of the ends that are tried, as a share of the way to where a joint fails.
LONGEST = SHORTER[0]
NONE_SMALL = Spare()
NOTHING_DONE = Plan()


def contact(depth_mm, links=("base", "door"), at=None):
    figures = {"links": links, "shapes": links, "depth_mm": depth_mm, "kind": "plain"}
    figures |= dict.fromkeys(("point_m", "visual_mm", "cause"))
    if at is None:
        return MeasuredContact(**figures)
    return MeasuredPair(**figures, excess_mm=depth_mm, bound_mm=depth_mm, at=at)


def joint(name="hinge", upper=2.0, clear_until=None, pairs=()):
    return MeasuredJoint(
        joint=name,
        lower=0.0,
        upper=upper,
        unit="rad",
        excess_mm=0.0,
        clearance_mm=None,
        visual_clearance_mm=None,
        clear_until=clear_until,
        looks=1,
        pairs=tuple(pairs),
        needs_open=(),
        waits_for=(),
        with_those_open=None,
    )


def hard(code, parts=("base", "door"), name=None):
    return Finding(code, Severity.ERROR, f"{code} happened", joint=name, parts=parts)


def verdict(*findings, rest=(), joints=(), near=()):
    measured = MeasuredPenetration(1.0, 2, (), tuple(rest), None, tuple(joints), tuple(near), ())
    measurements = {"asset.urdf": {PENETRATION: measured.to_dict()}}
    return Verdict(Report("asset.urdf", findings=findings, measurements=measurements))


def planned(given, before=NOTHING_DONE, spare=NONE_SMALL, config=CONFIG):
    """The plan that follows from a verdict and the plan before."""
    return next_plan(given, before, config, spare, ASSET)


def blocked(*others, name="hinge", clear_until=1.5):
    """A joint that runs into something there, and what else is found."""
    found = hard("sweep_penetration", name=name)
    return verdict(*others, found, joints=[joint(name, clear_until=clear_until)])


def test_a_clean_asset_needs_no_plan():
    assert planned(verdict(rest=[contact(-4.0)], joints=[joint()])) is None


DOOR = ("door", "base")
PAIR = frozenset({("base", "door")})
CUT = "cut the hulls apart of base and door"
KNUCKLE = Finding("hinge_overlap", Severity.WARNING, "knuckle", parts=DOOR)
EXCLUDED = "excluded from contact in MuJoCo, as other engines do: base and door"


@pytest.mark.parametrize(
    ("given", "changed", "sentence"),
    [
        (verdict(rest=[contact(-0.5, DOOR)]), {"separate": PAIR}, CUT),
        (
            verdict(joints=[joint(pairs=[contact(-0.5, DOOR, at=1.0)])]),
            {"separate": PAIR}, CUT,
        ),
        (verdict(KNUCKLE), {"exclude": PAIR}, EXCLUDED),
    ],
    ids=["hulls that nearly touch", "hulls that nearly touch on the way", "a knuckle that remains"],
)  # fmt: skip
def test_what_is_too_near_is_cut_apart_or_excluded_once(given, changed, sentence):
    plan = planned(given)
    assert plan == replace(NOTHING_DONE, **changed, repairs=plan.repairs)
    assert [each.sentence for each in plan.repairs] == [sentence]
    assert planned(given, plan) is None


def test_a_joint_that_runs_into_something_late_ends_before_and_early_is_not_shortened_to_nothing():
    plan = planned(blocked())
    assert plan.upper == {"hinge": LONGEST * 1.5}
    assert "ended hinge at 1.47 instead of 2 rad" in plan.repairs[-1].sentence
    assert planned(blocked(clear_until=0.2)) is None


def test_a_joint_that_another_stops_once_a_little_open_ends_there():
    met = asdict(contact(9.0, at=1.9))
    near = [
        MeasuredNeighbour(**met, joint="hinge", open=name, unit="rad", free_until=end)
        for name, end in (("slide", 1.8), ("flap", 1.6), ("lid", 1.2))
    ]
    # What only meets it somewhere is told and left.
    found = [
        replace(hard("joint_obstructed", name="hinge"), joints=("hinge", each.open))
        for each in near[:2]
    ]
    given = verdict(*found, joints=[joint()], near=near)
    plan = planned(given)
    assert plan.upper == {"hinge": LONGEST * 1.6}
    assert planned(given, plan) is None
    early = [replace(each, free_until=0.5) for each in near]
    assert planned(verdict(*found, joints=[joint()], near=early)) is None


def test_a_small_blocked_part_is_frozen_and_says_after_how_much():
    plan = planned(blocked(name="slide", clear_until=0.2), spare=Spare(frozenset({"slide"})))
    assert plan.frozen == {"slide"}
    assert "after 10% of its range" in plan.repairs[-1].sentence


def test_one_hopeless_joint_makes_the_whole_hopeless():
    joints = [joint(clear_until=0.1), joint("slide", clear_until=0.1)]
    given = verdict(hard("sweep_penetration", name="hinge"), joints=joints)
    assert planned(given, spare=Spare(frozenset({"slide"}))) is None


@pytest.mark.parametrize(
    "code", ["rest_penetration", "no_collision", "limits_swapped", "simulator_crashed"]
)
def test_what_no_repair_mends_gets_no_plan(code):
    assert planned(blocked(hard(code))) is None


def lying_in(*parts):
    return Finding("rest_penetration", Severity.ERROR, "they overlap", parts=parts)


GUESSES = Spare(frozenset({"a_hinge", "b_hinge"}), {"b": "b_hinge", "a": "a_hinge"})


def test_of_two_guessed_parts_that_lie_in_one_another_the_less_sure_is_given_up():
    apart = frozenset({("a", "b"), ("a", "base")})
    before = Plan(separate=apart, exclude=frozenset({("b", "base")}))
    plan = planned(verdict(lying_in("a", "b")), before, GUESSES)
    assert plan.given_up == {"b_hinge"}
    assert plan.separate == {("a", "base")}
    assert plan.exclude == frozenset()
    assert "gave up b_hinge: b lies in a" in plan.repairs[-1].sentence


def test_a_guessed_part_that_lies_in_a_known_one_is_given_up_and_two_known_ones_are_hopeless():
    assert planned(verdict(lying_in("a", "base")), spare=GUESSES).given_up == {"a_hinge"}
    assert planned(verdict(lying_in("base", "shelf")), spare=GUESSES) is None
    assert planned(verdict(lying_in("a", "base"), hard("no_collision")), spare=GUESSES) is None
    given_up = Plan(given_up=frozenset({"a_hinge"}))
    assert planned(verdict(lying_in("a", "base")), given_up, GUESSES) is None


def test_of_what_jams_only_the_guess_worth_least_is_given_up():
    jammed = Finding("jammed", Severity.ERROR, "a jams", joint="a_hinge", joints=("b_hinge",))
    moved = {"joint": "best", "joints": ("a_hinge",)}
    pushed = Finding("others_moved", Severity.ERROR, "a is pushed", **moved)
    plan = planned(verdict(jammed, pushed), spare=GUESSES)
    assert plan.given_up == {"b_hinge"}
    assert [each.sentence for each in plan.repairs] == ["gave up b_hinge: a jams"]
    alone = Finding("jammed", Severity.ERROR, "the best one jams", joint="best")
    assert planned(verdict(jammed, alone), spare=GUESSES) is None


def test_a_guessed_hinge_that_is_blocked_is_moved_to_the_front_edge_once():
    given = blocked()
    spare = Spare(hinges=frozenset({"hinge", "other"}))
    plan = planned(given, spare=spare)
    assert plan.rehung == {"hinge"}
    (repair,) = plan.repairs
    assert repair.sentence == "moved hinge to the door's front edge: it ran into something"
    assert planned(given, plan, spare).upper == {"hinge": LONGEST * 1.5}


def test_what_nobody_gets_into_is_made_hollow_once():
    found = verdict(hard("interior_filled", parts=("lever",)))
    plan = planned(found)
    assert plan.hollow == {"lever"}
    assert "lever" in plan.repairs[-1].sentence
    assert planned(found, plan) is None
    assert planned(found, config=RepairConfig(kinds="geometry")) == plan
    assert planned(found, config=RepairConfig(kinds="none")) is None
    soft = Finding("interior_filled", Severity.WARNING, "little is left", parts=("lever",))
    assert planned(verdict(soft)) is None


JOINED = Finding("hulls_joined", Severity.WARNING, "12 hulls joined to 8", parts=("base",))


def test_hulls_that_were_joined_are_left_apart_before_any_joint_is_changed():
    given = blocked(JOINED)
    plan = planned(given)
    assert plan.closely
    assert not plan.upper
    assert "base" in plan.repairs[-1].sentence
    assert planned(given, plan).upper == {"hinge": LONGEST * 1.5}


def test_joined_hulls_stay_joined_where_nothing_or_another_part_is_wrong_or_there_are_too_many():
    wrong = hard("rest_penetration")
    assert planned(verdict(JOINED)) is None
    assert planned(verdict(JOINED, wrong), Plan(fewer=10)) is None
    assert planned(verdict(wrong)) is None
    assert planned(verdict(JOINED, hard("rest_penetration", parts=("door", "handle")))) is None
    assert planned(verdict(JOINED, hard("simulator_crashed", parts=()))).closely


FRONTS = Spare(fronts=frozenset({"drawer"}))


def drawer(proposer):
    """The upper drawer of a chest, by whoever says so."""
    mesh = drawer_chest()
    own = np.isin(connected_components(mesh), (2, 4))
    front = Part("drawer", np.flatnonzero(own), source=PartSource("upper", proposer))
    parts = (Part("base", np.flatnonzero(~own)), front)
    out = np.array([0.0, -1.0, 0.0])
    joint = Joint("slide", JointKind.PRISMATIC, 0, 1, out, np.zeros(3), upper=0.3)
    return located(Articulation(mesh, parts, (joint,), "auto"))


def test_a_front_that_sticks_is_built_anew_once():
    stuck = verdict(hard("rest_penetration", ("base", "drawer")))
    plan = planned(stuck, spare=FRONTS)
    assert plan.build_fronts
    assert [each.sentence for each in plan.repairs] == ["built fronts and body anew: drawer"]
    assert planned(stuck, plan, FRONTS) is None
    # Nothing is built for other faults, or without fronts.
    assert planned(verdict(hard("no_mass", ("base", "drawer"))), spare=FRONTS) is None
    assert planned(stuck) is None


def test_only_guessed_fronts_are_built():
    assert dispensable_joints(drawer(Proposer.RULES), 0.1).fronts == {"drawer"}
    assert not dispensable_joints(drawer(Proposer.ANNOTATION), 0.1).fronts


def test_fronts_of_many_faces_are_built_at_once():
    chest = drawer(Proposer.RULES)
    assert first_plan(chest, FRONTS) == Plan()
    faces = np.tile(chest.mesh.faces, (MANY_FACES // len(chest.mesh.faces) + 1, 1))
    own = chest.parts[1]
    base = Part("base", np.setdiff1d(np.arange(len(faces)), own.faces))
    mesh = Mesh.from_triangles(chest.mesh.vertices, faces)
    carved = replace(chest, mesh=mesh, parts=(base, own))
    assert first_plan(carved, FRONTS).build_fronts
    assert first_plan(carved, Spare()) == Plan()
