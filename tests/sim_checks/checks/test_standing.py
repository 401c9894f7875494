"""What stands and what topples: closed forms, and MuJoCo with a free base as the witness."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from box_world import body, built, sliding, turning, with_link
from fault_corpus.things import words
from hypothesis import given, settings
from hypothesis import strategies as st

from asset_factory.sim_checks.checks.result import CheckResult
from asset_factory.sim_checks.checks.standing import check_standing
from asset_factory.sim_checks.config import StandingConfig
from asset_factory.sim_checks.description import Mimic
from asset_factory.sim_checks.geometry.kinematics import rotation_about

#: 0.6 m wide, 0.4 m deep, 0.8 m high; the front looks along -y.
CARCASS = ((0.0, 0.0, 0.4), (0.6, 0.4, 0.8))
DOOR = ((0.0, -0.21, 0.4), (0.6, 0.02, 0.7))
HINGE = (-0.3, -0.2, 0.4)


def weighing(link, mass):
    share = mass / link.inertia.mass
    tensor = share * link.inertia.tensor
    return replace(link, inertia=replace(link.inertia, mass=mass, tensor=tensor))


def of_masses(masses, *moving, box=CARCASS):
    """What moves in a box, 10 kg as a rule, and its mass [kg]."""
    description = built(*moving, base=body("base", [box]))
    masses = {"base": 10.0, **masses}
    links = tuple(weighing(link, masses[link.name]) for link in description.links)
    return replace(description, links=links)


def with_door(mass):
    return of_masses({"door": mass}, turning("door", [DOOR], HINGE, (0, 0, -1), 2.0))


def with_drawer(mass, reach=0.4, box=((0.0, 0.0, 0.4), (0.5, 0.4, 0.2))):
    return of_masses({"drawer": mass}, sliding("drawer", [box], (0, -1, 0), reach))


def judged(description):
    result = check_standing(description, StandingConfig())
    json.dumps(dict(result.measurements), allow_nan=False)
    return result


def codes(result):
    return [(finding.code, finding.joint) for finding in result.findings]


def test_a_box_tilts_by_its_half_width_over_its_half_height():
    result = judged(built(base=body("box", [CARCASS])))
    assert codes(result) == []
    assert result.measurements["closed"] == {
        "margin_mm": 200.0,
        "tilt_deg": pytest.approx(math.degrees(math.atan2(0.2, 0.4)), abs=1e-3),
    }


@given(mass=st.floats(0.1, 40.0), reach=st.floats(0.05, 0.8))
@settings(max_examples=30, deadline=None)
def test_a_drawer_takes_the_centre_of_mass_along_by_its_share_of_the_weight(mass, reach):
    result = judged(with_drawer(mass, reach))
    (row,) = result.measurements["joints"]
    assert row["worst_at"] == pytest.approx(reach, abs=1e-6)
    assert row["margin_mm"] == pytest.approx(200.0 - 1000 * mass * reach / (10.0 + mass), abs=2e-3)
    assert (("topples", "drawer") in codes(result)) == (row["margin_mm"] < 5.0)


def test_a_door_is_worst_where_its_centre_is_farthest_out_not_at_the_end_of_its_range():
    result = judged(with_door(10.0))
    (row,) = result.measurements["joints"]
    # About the hinge the door's centre lies (0.3, -0.01) away; it is farthest along -y where that
    # points along -y.
    assert row["worst_at"] == pytest.approx(math.atan2(0.3, 0.01), abs=1e-4)
    assert row["margin_mm"] == pytest.approx(200 - 500 * (0.2 + math.hypot(0.3, 0.01)), abs=1e-3)
    assert codes(result) == [("topples", "door")]
    assert "-50.0 mm" not in result.findings[0].message
    assert "50.1 mm outside" in result.findings[0].message


def test_all_joints_open_may_topple_what_each_alone_does_not():
    left, right = (
        sliding(name, [((x, 0.0, 0.4), (0.25, 0.4, 0.2))], (0, -1, 0), 0.45)
        for name, x in (("left", -0.15), ("right", 0.15))
    )
    result = judged(of_masses({"left": 5.0, "right": 5.0}, left, right))
    assert [row["margin_mm"] for row in result.measurements["joints"]] == [pytest.approx(87.5)] * 2
    assert result.measurements["all_upper"]["margin_mm"] == pytest.approx(-25.0)
    assert codes(result) == [("topples", None)]


def test_a_leg_on_the_moving_part_carries_it():
    assert ("topples", "drawer") in codes(judged(with_drawer(20.0)))
    result = judged(with_drawer(20.0, box=((0.0, 0.0, 0.25), (0.5, 0.4, 0.5))))
    assert ("topples", "drawer") not in codes(result)
    assert result.measurements["joints"][0]["margin_mm"] == pytest.approx(200.0)


def test_a_part_that_would_go_below_the_floor_rests_on_it():
    lift = sliding("lift", [((0.0, -0.3, 0.4), (0.5, 0.1, 0.2))], (0, 0, -1), 0.4)
    (row,) = judged(of_masses({"lift": 1.0}, lift)).measurements["joints"]
    assert row["below_floor_mm"] == pytest.approx(100.0)


def plug():
    """What lifts straight up out of the top."""
    up = sliding("plug", [((0.0, 0.0, 0.85), (0.1, 0.1, 0.1))], (0, 0, 1), 0.2)
    return of_masses({"plug": 1.0}, up)


@pytest.mark.parametrize(
    ("thing", "mass", "lever"),
    [
        # Pulled at the drawer's upper front edge, 0.5 m high, along the floor; worst with the
        # drawer out.
        (with_drawer(0.5, 0.2), 10.5, (0.2 - 0.2 * 0.5 / 10.5) / 0.5),
        (with_drawer(3.0, 0.2), 13.0, (0.2 - 0.2 * 3.0 / 13.0) / 0.5),
        # Straight up tips only by lifting more than the edge opposite still holds.
        (plug(), 11.0, 0.2 / 0.25),
    ],
    ids=["a light drawer", "a heavy drawer", "what lifts straight up"],
)
def test_the_pull_that_tips_is_weight_times_margin_over_height(thing, mass, lever):
    (row,) = judged(thing).measurements["joints"]
    assert row["tipping_force_n"] == pytest.approx(9.81 * mass * lever, rel=1e-4)


def test_a_light_tall_thing_is_pulled_over_by_a_hand():
    drawer = sliding("drawer", [((0, 0, 1.3), (0.2, 0.09, 0.1))], (0, -1, 0), 0.05)
    tower = ((0.0, 0.0, 0.75), (0.3, 0.1, 1.5))
    light = of_masses({"base": 3.0, "drawer": 0.2}, drawer, box=tower)
    (finding,) = judged(light).findings
    assert finding.code == "topples_when_pulled"
    assert finding.value < finding.limit == 20.0


def test_a_follower_leans_out_with_its_leader():
    lower, upper = (
        sliding(name, [((0.0, 0.0, z), (0.5, 0.4, 0.2))], (0, -1, 0), 0.4, mimic=mimic)
        for name, z, mimic in (("lower", 0.4, None), ("upper", 0.65, Mimic("lower")))
    )
    (row,) = judged(of_masses({"lower": 5.0, "upper": 5.0}, lower, upper)).measurements["joints"]
    assert row["margin_mm"] == pytest.approx(200.0 - 1000.0 * 10.0 * 0.4 / 20.0, abs=1e-3)


def test_a_point_or_an_edge_is_no_footing():
    turned = body("roof", [((0.0, 0.0, 0.0), (0.3, 0.3, 0.3))])
    turn = rotation_about(np.array([1.0, 0.0, 0.0]), math.pi / 4)
    (shape,) = turned.collisions
    on_edge = replace(turned, collisions=(replace(shape, vertices=shape.vertices @ turn.T),))
    assert codes(judged(built(base=on_edge))) == [("no_stable_footing", None)]


@pytest.mark.parametrize(("bump", "margin"), [(0.003, 200.0), (0.02, None)])
def test_an_underside_may_be_uneven_by_a_fraction_of_a_degree(bump, margin):
    box = body("box", [CARCASS])
    (shape,) = box.collisions
    lowered = shape.vertices.copy()
    lowered[np.argmin(shape.vertices.sum(axis=1)), 2] -= bump
    rough = replace(box, collisions=(replace(shape, vertices=lowered),))
    assert judged(built(base=rough)).measurements["closed"]["margin_mm"] == margin


def test_closed_and_already_falling_is_said_once():
    whole = with_door(1.0)
    falling = replace(whole.links[0].inertia, center=np.array([0, -0.25, 0.4]))
    assert codes(judged(with_link(whole, "base", inertia=falling))) == [("topples", None)]


def test_what_has_no_masses_or_is_no_tree_gets_no_verdict():
    whole = with_door(1.0)
    unweighed = judged(with_link(whole, "door", inertia=None))
    assert (unweighed.findings, unweighed.measurements) == ((), {"unweighed": ["door"]})
    assert judged(replace(whole, joints=())) == CheckResult()


def geom(box, mass, origin=(0.0, 0.0, 0.0)):
    """A box of MuJoCo's, in a body that lies at ``origin``."""
    place = words(np.subtract(box[0], origin))
    return f'<geom type="box" mass="{mass}" pos="{place}" size="{words(np.divide(box[1], 2.0))}"/>'


def falls(inside, pull=0.0):
    """Whether MuJoCo sees a body topple on a floor, its front pulled harder and harder [N]."""
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><option timestep="0.001" impratio="10" cone="elliptic"/><worldbody>'
        '<geom type="plane" size="5 5 0.1" friction="5 0.1 0.1"/>'
        f'<body name="box"><freejoint/>{inside}</body></worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    hand = np.array([0.0, -0.4, 0.5])
    for step in range(3000):
        force = np.array([0.0, -pull * min(1.0, step / 1000), 0.0])
        data.qfrc_applied[:] = 0.0
        mujoco.mj_applyFT(
            model, data, force, np.zeros(3), hand, model.body("box").id, data.qfrc_applied
        )
        mujoco.mj_step(model, data)
    return float(data.body("box").xmat[8]) < math.cos(math.radians(2.0))


@pytest.mark.parametrize("door_mass", [4.0, 6.0, 7.0, 10.0])
def test_mujoco_with_a_free_base_falls_exactly_where_the_closed_form_says(door_mass):
    result = judged(with_door(door_mass))
    (row,) = result.measurements["joints"]
    place = f'pos="{words(HINGE)}" axisangle="0 0 -1 {math.degrees(row["worst_at"])}"'
    # The open door, 5 cm above the floor, catches the fall after some 4 degrees.
    fell = falls(f"{geom(CARCASS, 10.0)}<body {place}>{geom(DOOR, door_mass, HINGE)}</body>")
    # The door that just holds: 10 kg * 0.2 m = 6.66 kg * 0.3002 m.
    assert fell == (row["margin_mm"] < 0.0) == (door_mass > 6.66)
    assert (("topples", "door") in codes(result)) == (row["margin_mm"] < 5.0)


@pytest.mark.parametrize(("share", "fallen"), [(0.97, False), (1.03, True)])
def test_mujoco_is_pulled_over_by_exactly_the_tipping_force(share, fallen):
    (row,) = judged(with_drawer(3.0, 0.2)).measurements["joints"]
    out = geom(((0.0, -0.2, 0.4), (0.5, 0.4, 0.2)), 3.0)
    assert falls(geom(CARCASS, 10.0) + out, share * row["tipping_force_n"]) == fallen
