"""Followers move with their leaders and never alone; all that they meet on the way is found."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from box_world import body, box_hull, built, described, joint, penetrating, sliding, turning
from hypothesis import given, settings
from hypothesis import strategies as st

from asset_factory.sim_checks.checks.joint_sweep import JointCourse
from asset_factory.sim_checks.checks.pairs import RestingSolids
from asset_factory.sim_checks.config import PenetrationConfig
from asset_factory.sim_checks.description import Mimic
from asset_factory.sim_checks.geometry.collision import LookBudget
from asset_factory.sim_checks.geometry.kinematics import build_tree
from asset_factory.sim_checks.geometry.path import JointAxis, Path
from asset_factory.sim_checks.geometry.solids import Solids

CONFIG = PenetrationConfig()
Z = (0.0, 0.0, 1.0)
#: Limits that stop no follower.
SPAN = (-10.0, 10.0)


def doors(width, *, mimic):
    """Two doors hinged 1 m apart, open to the sides at first; they turn together and past."""
    lead, led = (
        turning(
            name,
            [((side * (0.5 + width / 2), 0.0, 0.0), (width, 0.02, 0.4))],
            (side * 0.5, 0.0, 0.0),
            (0.0, 0.0, side),
            3.14,
            mimic=follows,
        )
        for name, side, follows in (("lead", -1.0, None), ("led", 1.0, mimic))
    )
    return built(lead, led)


def checked(description):
    result = penetrating(description)
    return [(f.code, str(f.severity), f.joint) for f in result.findings], result.measurements


def test_coupled_doors_that_meet_on_their_way_are_caught_where_geometry_says():
    """At angle a, the far edges pass the middle by w |cos a| - g/2 and more: worst when shut."""
    findings, measured = checked(doors(0.51, mimic=Mimic("lead")))
    assert findings == [("sweep_penetration", "error", "lead")]
    (sweep,) = measured["joints"]
    (pair,) = sweep["pairs"]
    assert pair["depth_mm"] == pytest.approx(20.0, rel=0.02)
    assert pair["point_m"] == pytest.approx([0.0, 0.0, 0.0], abs=0.02)
    # The inner corners, half a thickness before the face, meet first.
    corner = np.hypot(0.51, 0.01), np.arctan2(0.01, 0.51)
    meets = np.pi - np.arccos(0.5 / corner[0]) - corner[1]
    assert meets - 0.2 < sweep["clear_until"] < meets + 0.02


def test_coupled_doors_that_leave_room_pass_and_their_clearance_is_measured():
    findings, measured = checked(doors(0.4985, mimic=Mimic("lead")))
    assert findings == []
    (sweep,) = measured["joints"]
    assert sweep["joint"] == "lead"
    # The farthest corner passes the middle nearest where it points straight there.
    assert sweep["clearance_mm"] == pytest.approx(2000 * (0.5 - np.hypot(0.4985, 0.01)), abs=0.05)


def test_coupled_doors_that_would_only_meet_at_different_angles_pass():
    """One follows at half the angle: when the first is shut, the second stands straight out."""
    findings, measured = checked(doors(0.6, mimic=Mimic("lead", 0.5)))
    assert findings == []
    assert [item["joint"] for item in measured["joints"]] == ["lead"]
    free, _ = checked(doors(0.6, mimic=None))
    assert [code for code, _, _ in free] == ["joints_collide"]


def test_a_follower_that_runs_ahead_at_rest_stands_where_its_leader_puts_it():
    """With an offset of pi the follower is shut at the leader's rest, and hits what is there."""
    turned = doors(0.6, mimic=Mimic("lead", -1.0, 3.14))
    post = body("base", [((0, 0, -1), (4.0, 4.0, 0.1)), ((-0.08, 0, 0), (0.04, 0.04, 0.4))])
    findings, _ = checked(replace(turned, links=(post, *turned.links[1:])))
    assert ("rest_penetration", "error", None) in findings


def test_a_coupled_drawer_needs_a_door_that_opens_alone():
    out = ((0.0, -1.0, 0.0), 0.4)
    door = sliding("door", [((0.0, -0.05, 0.0), (0.6, 0.04, 0.4))], (1.0, 0.0, 0.0), 1.0)
    lead = sliding("lead", [((-2.0, 0.25, 0.0), (0.2, 0.5, 0.2))], *out)
    led = sliding("led", [((0.0, 0.25, 0.0), (0.2, 0.5, 0.2))], *out, mimic=Mimic("lead"))
    findings, measured = checked(built(door, lead, led))
    assert findings == [("joint_dependency", "warning", "lead")]
    needed = {item["joint"]: item["needs_open"] for item in measured["joints"]}
    assert needed == {"door": [], "lead": ["door"]}


def arm(multipliers):
    """A chain of a turn, a slide and a turn, and a fourth link beside it; all follow the first."""
    names = ("base", "upper", "middle", "hand", "beside")
    links = [
        body(name, [((0.3 * i, 0.1 * i, 0.05 * i), (0.2, 0.1, 0.1))])
        for i, name in enumerate(names)
    ]
    ways = [("revolute", Z), ("prismatic", (1.0, 0.0, 0.0)), ("revolute", (0.0, 1.0, 0.0))]
    mimics = [None, *(Mimic("j0", rate, 0.1 * i) for i, rate in enumerate(multipliers, 1))]
    lines = [
        joint(f"j{i}", kind, *names[i : i + 2], (0.1 * i, 0.2, 0), axis, SPAN, mimic=mimics[i])
        for i, (kind, axis) in enumerate(ways)
    ]
    beside = ("k", "revolute", "base", "beside", (0.5, 0.0, 0.0), (1, 0, 0), SPAN)
    return described(links, [*lines, joint(*beside, mimic=Mimic("j0", -0.7))])


@settings(max_examples=15, deadline=None)
@given(first=st.floats(-2.0, 2.0), second=st.floats(-2.0, 2.0), start=st.floats(-1.0, 1.0))
def test_what_one_link_sees_of_another_is_what_the_kinematics_say(first, second, start):
    description = arm((first, second))
    tree = build_tree(description)
    solids = Solids(description, tree, LookBudget())
    poses = solids.place({"j0": start})
    groups = solids.groups(tree.free[0])
    there = tree.link_poses({"j0": start + 0.8})
    heads = [tree.parts[group.parts[0]][0] for group in groups]
    for mover, m in zip(groups, heads, strict=True):
        for stander, s in zip(groups, heads, strict=True):
            if mover is stander:
                continue
            seen = solids.seen(mover, stander, poses, 1.0).pose(0.8) @ poses[m]
            assert seen == pytest.approx(poses[s] @ np.linalg.inv(there[s]) @ there[m], abs=1e-9)
            moved = solids.way(mover, poses, 1.0).pose(0.8) @ poses[m]
            assert moved == pytest.approx(there[m], abs=1e-9)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_the_inverse_undoes_a_motion_whose_points_stay_within_bounds_between_two_places(seed):
    generator = np.random.default_rng(seed)

    def line():
        axis = generator.normal(size=3)
        turning = bool(generator.integers(2))
        unit = axis / np.linalg.norm(axis)
        return JointAxis(turning, generator.normal(size=3), unit), generator.uniform(-2, 2)

    path = Path(tuple(line() for _ in range(generator.integers(1, 5))), 1.5)
    assert path.pose(0.6) @ path.inverse().pose(0.6) == pytest.approx(np.eye(4), abs=1e-9)
    points = box_hull((0.3, 0.0, 0.0), (0.5, 0.2, 0.1)).vertices
    places = np.linspace(0.0, path.length, 5)
    direction = generator.normal(size=3)
    direction /= np.linalg.norm(direction)
    for way in (path, path.inverse()):
        orbit = way.orbit(points)
        boxes = orbit.swept_bounds(places)
        heights = orbit.highest(direction, places[:-1], places[1:])
        for row, (low, high) in enumerate(pairwise(places)):
            for at in np.linspace(low, high, 15):
                pose = way.pose(float(at))
                there = points @ pose[:3, :3].T + pose[:3, 3]
                assert (there @ direction).max() <= heights[row] + 1e-9
                assert (there >= boxes[row, 0] - 1e-9).all()
                assert (there <= boxes[row, 1] + 1e-9).all()
                assert np.linalg.norm(there - points, axis=1).max() <= way.travel(points) + 1e-9


def tangle(seed):
    """Four blocks hung on one another at random, by turns and slides that all follow the first."""
    generator = np.random.default_rng(seed)
    names = ("base", "l1", "l2", "l3", "l4")
    links = [
        body(name, [(generator.normal(size=3) * 0.4, generator.uniform(0.05, 0.5, size=3))])
        for name in names
    ]
    lines = []
    for i, name in enumerate(names[1:], 1):
        kind = ("revolute", "prismatic")[generator.integers(2)]
        parent = names[generator.integers(i)]
        at, axis = generator.normal(size=(2, 3))
        line = joint(f"j{i}", kind, parent, name, 0.3 * at, axis, (-1.0, 1.5) if i == 1 else SPAN)
        leader = f"j{generator.integers(1, max(i, 2))}"
        mimic = Mimic(leader, generator.uniform(-1, 1), generator.uniform(-0.1, 0.1))
        lines.append(line if i == 1 else replace(line, mimic=mimic))
    return described(links, lines)


@pytest.mark.parametrize("seed", range(8))
def test_no_pose_on_the_way_is_worse_than_what_is_found(seed):
    description = tangle(seed)
    tree = build_tree(description)
    solids = Solids(description, tree, LookBudget())
    assert (tree.closed, tree.opened) == ({"j1": -1.0}, {"j1": 1.5})
    solids.place(tree.closed)
    rest = RestingSolids(solids, CONFIG, solids.standings(CONFIG.clearance_m), solids.diagonal())
    found = {pair.parts: pair for pair in JointCourse(tree.free[0], rest, rest.lower).run().pairs}
    for at in np.linspace(-1.0, 1.5, 100):
        solids.place({"j1": at})
        for pair, overlap in solids.standings(0.0).items():
            assert overlap.depth - rest.depth(*pair) <= found[rest.parts(*pair)].bound + 1e-9
    for item in found.values():
        solids.place(item.pose)
        one, other = (solids.items[index].collider for index in item.hulls)
        assert one.stand(other).depth == pytest.approx(item.depth, abs=1e-8)
        assert item.bound <= item.excess + max(2e-5, 0.02 * abs(item.excess)) + 1e-12
        if item.point is not None:
            for hull in (one.hull, other.hull):
                assert (hull.normals @ np.array(item.point) - hull.offsets).max() < 1e-6
