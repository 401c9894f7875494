"""Coupled double doors in every engine: they start shut, open together and push nobody."""

from contextlib import closing
from dataclasses import replace

import numpy as np
import pytest
from engines import skipped_if_missing
from fault_corpus.things import Body, Move, Thing, at, box, with_move, write_mjcf, write_urdf
from hypothesis import given
from hypothesis import strategies as st
from sliders import Sliders

from asset_factory.sim_checks.checks.loading import check_loading
from asset_factory.sim_checks.checks.motion import check_motion
from asset_factory.sim_checks.config import CheckConfig, MotionConfig
from asset_factory.sim_checks.description import Mimic
from asset_factory.sim_checks.geometry.kinematics import rotation_about
from asset_factory.sim_checks.read.read import read_here
from asset_factory.sim_checks.report import Severity
from asset_factory.sim_checks.simulators.catalog import installed, simulator
from asset_factory.sim_checks.simulators.drive import sweep
from asset_factory.sim_checks.simulators.observe import observe

CONFIG = MotionConfig()
ENGINES = skipped_if_missing("sapien", "mujoco", "pybullet")
MIMICS = [Mimic("lead", -1.0), Mimic("lead", 1.0), Mimic("lead", -1.0, 0.5)]
#: Who couples a door that opens as far as the other, and at the same time.
MIRRORING = ("sapien", "mujoco")
#: How far each door opens [rad].
OPEN = 1.8


@pytest.fixture(params=ENGINES)
def engine(request):
    return request.param


def doors(mimic, width=0.47, *, drawer=False):
    """Two doors before a 1 m carcass, shut with the leader at 0; a drawer wider than either."""
    sign = 1.0 if mimic.multiplier > 0.0 else -1.0
    hinge = np.array([0.5, -0.03, 0.0])
    shut = box((-width / 2 - 0.005, 0.0, 0.0), (width, 0.02, 0.4))
    # At 0 the follower stands where it has yet to turn by the offset to be shut.
    right = shut @ rotation_about(np.array([0.0, 0.0, sign]), -mimic.offset).T + hinge
    lower, upper = sorted((mimic.offset, mimic.multiplier * OPEN + mimic.offset))
    left = box((-0.5 + width / 2 + 0.005, -0.03, 0.0), (width, 0.02, 0.4))
    bodies = [
        Body("carcass", (box((0.0, 0.25, -0.25), (1.0, 0.5, 0.02)),), at(0.0, 0.0, 0.0), 10.0),
        Body("left", (left,), at(-0.5, -0.03, 0.0), 1.0),
        Body("right", (right,), at(*hinge), 1.0),
    ]
    moves = [
        Move("lead", "revolute", "carcass", "left", (0.0, 0.0, -1.0), 0.0, OPEN),
        Move("led", "revolute", "carcass", "right", (0.0, 0.0, sign), lower, upper, mimic),
    ]
    if drawer:
        tray = box((0.0, 0.25, 0.0), (0.6, 0.45, 0.2))
        bodies.append(Body("drawer", (tray,), at(0.0, 0.0, 0.0), 2.0))
        moves.append(Move("slide", "prismatic", "carcass", "drawer", (0.0, -1.0, 0.0), 0.0, 0.3))
    return Thing("doors", tuple(bodies), tuple(moves))


def judged(path, engine):
    description = read_here(path)
    seen = observe(engine, path, CONFIG, ())
    findings = []
    for check in (check_loading, check_motion):
        findings += check(description, seen, CheckConfig()).findings
    return findings, {motion.joint: motion for motion in seen.motions}


def hard(findings):
    return {finding.code for finding in findings if finding.severity is Severity.ERROR}


@pytest.mark.parametrize(
    ("mimic", "drawer", "coupling"),
    [
        *((mimic, drawer, MIRRORING) for mimic in MIMICS for drawer in (False, True)),
        # SAPIEN's own coupling, the wrong way round, is told where that makes a difference.
        (Mimic("lead", 1.0, 0.5), False, ("mujoco",)),
        (Mimic("lead", -0.9), False, ("mujoco",)),
        (Mimic("lead", -0.5), False, ("mujoco",)),
    ],
)
def test_sound_coupled_doors_pass(tmp_path, engine, mimic, drawer, coupling):
    findings, motions = judged(write_urdf(doors(mimic, drawer=drawer), tmp_path), engine)
    told = [] if engine in coupling else ["mimic_ignored"]
    assert [finding.code for finding in findings] == told
    for motion in motions.values():
        assert motion.reached > 0.98
        assert motion.returned < 0.01
        assert motion.others_moved < 0.01
    assert motions["lead"].range == pytest.approx(OPEN)
    assert motions["led"].range == pytest.approx(abs(mimic.multiplier) * OPEN)
    if drawer:
        assert len(motions["slide"].needs_open) == 1


@pytest.mark.parametrize("mimic", MIMICS)
def test_coupled_doors_that_overlap_fail(tmp_path, engine, mimic):
    findings, _ = judged(write_urdf(doors(mimic, 0.52), tmp_path), engine)
    assert hard(findings) & {"jammed", "not_returned"}


@pytest.mark.skipif(not installed("mujoco"), reason="MuJoCo is not installed")
@pytest.mark.parametrize(
    "mimic", [Mimic("lead", -1.0), Mimic("lead", 1.0, 0.5), Mimic("lead", -0.9, 0.2)]
)
def test_doors_that_an_mjcf_equality_couples_pass_and_fail_alike(tmp_path, mimic):
    assert judged(write_mjcf(doors(mimic), tmp_path), "mujoco")[0] == []
    assert "jammed" in hard(judged(write_mjcf(doors(mimic, 0.52), tmp_path), "mujoco")[0])


def chain(parents, mimics):
    """Three slides on a post, the second and third of which follow another."""
    bodies = [Body(name, (), at(0.0, 0.0, 0.0), 1.0) for name in ("post", "a", "b", "c")]
    pairs = zip("abc", ("post", *parents), (None, *mimics), strict=True)
    way = ((1.0, 0.0, 0.0), -9.0, 9.0)
    moves = [Move(f"j{name}", "prismatic", parent, name, *way, led) for name, parent, led in pairs]
    return Thing("chain", tuple(bodies), tuple(moves))


@pytest.mark.parametrize(
    ("parents", "mimics"),
    [
        (("post", "post"), (Mimic("ja", 2.0, 0.2), Mimic("jb", -0.5, 0.1))),
        # Two gears in a row at other rates than 1 never settle in SAPIEN.
        (("a", "b"), (Mimic("ja", -1.0, 0.1), Mimic("jb", 1.0, -0.3))),
        (("post", "b"), (Mimic("ja", -1.0, 0.1), Mimic("jb", 1.5))),
    ],
)
def test_joints_are_where_the_engine_is_said_to_force_them(tmp_path, engine, parents, mimics):
    path = write_urdf(chain(parents, mimics), tmp_path)
    with closing(simulator(engine).open(path, CONFIG)) as world:
        world.weigh(False)
        span = world.span
        world.place(span.lower + 0.25 * span.travel)
        goal = span.lower + 0.6 * span.travel
        for _ in range(1200):
            pull = -20.0 * world.velocities()
            pull[0] += 300.0 * (goal[0] - world.positions()[0])
            world.step(pull)
        assert [joint.follows for joint in world.joints] == [None, "ja", "jb"]
        assert world.positions() == pytest.approx(goal, abs=2e-3)


@pytest.mark.parametrize("engine", ENGINES[1:])
def test_one_that_follows_at_no_rate_stops_nobody(tmp_path, engine):
    free = with_move(doors(Mimic("lead", 0.0, 0.3)), "led", lower=0.0, upper=OPEN)
    findings, motions = judged(write_urdf(free, tmp_path), engine)
    assert hard(findings) == set()
    assert motions["lead"].reached > 0.99


@pytest.mark.skipif(not installed("sapien"), reason="SAPIEN is not installed")
def test_what_sapien_leaves_free_is_not_held_to_be_coupled(tmp_path):
    path = write_urdf(chain(("post", "b"), (Mimic("ja"), Mimic("ja"))), tmp_path)
    findings, motions = judged(path, "sapien")
    assert [f.message for f in findings if f.code == "mimic_ignored"] == [
        "does not couple 'jc' to another joint as the file does: whoever simulates it must"
    ]
    assert set(motions) == {"ja", "jb", "jc"}


@given(
    rates=st.tuples(*[st.sampled_from([-2.0, -1.0, -0.3, 0.0, 0.7, 1.0, 3.0])] * 2),
    offsets=st.tuples(*[st.floats(-0.2, 0.2)] * 2),
    lower=st.floats(-0.3, 0.0),
)
def test_whoever_moves_together_begins_and_ends_together_within_all_limits(rates, offsets, lower):
    world = Sliders([1.0, 1.0, 1.0])
    free = [replace(joint, lower=lower) for joint in world.joints]
    mimics = [None, *(Mimic(f"j{i}", rates[i], offsets[i]) for i in (0, 1))]
    world.joints = tuple(replace(joint, mimic=mimics[i]) for i, joint in enumerate(free))
    span = world.span
    for end in (span.lower, span.upper):
        assert end[1] == pytest.approx(rates[0] * end[0] + offsets[0])
        assert end[2] == pytest.approx(rates[1] * end[1] + offsets[1])
        moving = [i for i in range(3) if span.size[i] > 0.0]
        assert all(lower - 1e-9 <= end[i] <= 0.3 + 1e-9 for i in moving)
    assert span.travel[0] >= 0.0


class Mirrored(Sliders):
    """A block that a second one mirrors: the second is at 0.3 m when the first is at 0."""

    def __init__(self, wall=np.inf):
        super().__init__([2.0, 2.0])
        one, two = self.joints
        self.joints = (one, replace(two, mimic=Mimic("j0", -1.0, 0.3)))
        self.wall = wall

    def step(self, forces):
        both = 0.5 * (forces[0] - forces[1])
        super().step(np.array([both, -both]))
        self._q[1] = 0.3 - self._q[0]
        self._v[1] = -self._v[0]


def test_a_joint_that_is_driven_backwards_is_measured_from_where_it_begins():
    lead, led = sweep(Mirrored(), CONFIG)
    for motion in (lead, led):
        assert motion.reached > 0.999
        assert motion.returned < 0.001
        assert motion.range == pytest.approx(0.3)
        assert motion.others_moved == 0.0
    assert led.opening_force == pytest.approx(lead.opening_force, rel=1e-3)
    lead, led = sweep(Mirrored(wall=0.12), CONFIG)
    assert lead.reached == led.reached == pytest.approx(0.4)
    assert (lead.stuck_at, led.stuck_at) == (pytest.approx(0.12), pytest.approx(0.18))
