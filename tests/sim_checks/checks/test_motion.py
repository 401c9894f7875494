"""One drive for every engine; here it moves a world whose mechanics are known in closed form."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sliders import CONFIG, Sliders

from asset_factory.sim_checks.checks.motion import check_motion
from asset_factory.sim_checks.config import CheckConfig
from asset_factory.sim_checks.description import Description, Mimic
from asset_factory.sim_checks.simulators.drive import sweep
from asset_factory.sim_checks.simulators.rest import fall, let_go, rest
from asset_factory.sim_checks.simulators.simulator import (
    Fall,
    FallMotion,
    JointMotion,
    Observation,
    RestMotion,
)
from asset_factory.sim_checks.simulators.world import LoadedModel, Touch

NOTHING = LoadedModel((), ())


def faults(observation):
    """What the check says of an engine that saw this, of a file that says nothing."""
    nothing = Description(Path("nothing.urdf"), "urdf", (), ())
    return check_motion(nothing, observation, CheckConfig()).findings


def only(world):
    (motion,) = sweep(world, CONFIG)
    return motion


@pytest.mark.parametrize("mass", [0.001, 0.1, 5.0, 80.0])
@pytest.mark.parametrize("weight", [0.0, 1.0])
def test_a_free_slider_of_any_mass_goes_all_the_way_and_back(mass, weight):
    motion = only(Sliders([mass], weight=weight * 9.81 * mass))
    assert motion.reached > 0.999
    assert motion.returned < 0.001
    # The ramp is half a cosine: its steepest slope is pi/2 times the mean speed.
    assert motion.peak_speed == pytest.approx(0.5 * np.pi * 0.3 / CONFIG.ramp_s, rel=0.01)


@pytest.mark.parametrize("friction", [0.5, 5.0, 50.0])
def test_the_file_s_own_friction_never_jams(friction):
    motion = only(Sliders([2.0], friction=friction))
    assert (motion.reached > 0.98, motion.returned < 0.02) == (True, True)


def walled(*masses):
    """Blocks, the first of which meets a wall at 0.12 m."""
    world = Sliders(list(masses))
    world.wall = 0.12
    return world


def test_a_jam_says_where_and_between_whom():
    world = walled(2.0)
    motion = only(world)
    assert motion.reached == pytest.approx(0.4, abs=1e-6)
    assert (motion.blocked_by, motion.stuck_at) == (("block0", "post"), 0.12)
    assert motion.opening_force == motion.force_bound
    assert motion.weight_open is None
    (finding,) = faults(Observation(world.model, motions=(motion,)))
    assert finding.code == "jammed"
    assert "(at 0.12)" in finding.message
    assert "'block0' presses on 'post'" in finding.message
    assert {"block0", "post"} <= set(finding.parts)


def test_a_joint_that_opens_is_blocked_by_nobody_and_tells_the_force_it_took():
    motion = only(Sliders([2.0], weight=6.0))
    assert (motion.blocked_by, motion.stuck_at) == (None, None)
    # Along half a cosine, acceleration is greatest at its start; the drive's drag adds the lag of
    # one step.
    inertial = 2.0 * 0.5 * 0.3 * (np.pi / CONFIG.ramp_s) ** 2
    lag = 2.1 * CONFIG.drive_frequency * CONFIG.time_step_s
    assert 1.0 < motion.opening_force / inertial < 1.0 + lag
    assert (motion.weight_closed, motion.weight_open) == (6.0, 6.0)


def test_the_hand_never_pulls_harder_than_its_bound():
    world = walled(2.0)
    only(world)
    inertial = CONFIG.inertia_margin * 2.0 * 0.5 * 0.3 * (np.pi / CONFIG.ramp_s) ** 2
    assert world.strongest <= CONFIG.hand_force_n + inertial + 1e-9


class Barred(Sliders):
    """Each block stops at 5 cm unless all ``until`` are open and all ``unless`` are shut."""

    def __init__(self, until, unless=None):
        super().__init__([2.0] * len(until))
        self._until = until
        self._unless = unless or {}
        self._met = {}

    def step(self, forces):
        before = self._q.copy()
        super().step(forces)
        opened = {i for i, q in enumerate(before) if q > 0.2}
        self._met = {}
        for i in range(len(before)):
            bars = sorted((self._until[i] - opened) | (self._unless.get(i, set()) & opened))
            if bars and self._q[i] > 0.05 and before[i] <= 0.05:
                self._q[i] = 0.05
                self._v[i] = 0.0
                self._met[f"block{i}", f"block{bars[0]}"] = Touch(20.0, 0.0)

    def contacts(self):
        return self._met


def opening(world):
    return {item.joint: (item.reached > 0.99, item.needs_open) for item in sweep(world, CONFIG)}


SHUT = (False, ())
ALONE = (True, ())


@pytest.mark.parametrize(
    ("until", "unless", "found"),
    [
        ({0: {1}, 1: {0}, 2: set()}, {}, [SHUT, SHUT, ALONE]),
        ({0: {1}, 1: {2}, 2: set()}, {}, [(True, ("j1", "j2")), (True, ("j2",)), ALONE]),
        ({0: {1}, 1: set(), 2: set()}, {0: {2}}, [(True, ("j1",)), ALONE, ALONE]),
        (
            {0: {1, 2}, 1: set(), 2: set(), 3: set()},
            {0: {3}},
            [(True, ("j1", "j2")), ALONE, ALONE, ALONE],
        ),
    ],
    ids=["two that bar each other never open", "a chain opens from its outer end",
         "who would only be in the way stays shut", "what stands behind makes way too"],
)  # fmt: skip
def test_each_opens_with_those_open_that_it_needs(until, unless, found):
    assert list(opening(Barred(until, unless)).values()) == found


class Latched(Barred):
    """Its last block stays open: once at 25 cm, a latch holds it at 20."""

    caught = False

    def place(self, positions):
        super().place(positions)
        self.caught = False

    def step(self, forces):
        super().step(forces)
        self.caught = self.caught or self._q[-1] > 0.25
        if self.caught and self._q[-1] < 0.2:
            self._q[-1] = 0.2
            self._v[-1] = 0.0


def test_a_joint_that_does_not_come_back_is_refused_and_makes_no_way_for_another():
    world = Latched({0: {1}, 1: set()})
    barred, latched = sweep(world, CONFIG)
    assert (latched.reached, latched.returned) == pytest.approx((1.0, 2.0 / 3.0), abs=1e-3)
    assert latched.stuck_at == pytest.approx(0.2)
    assert (barred.reached, barred.needs_open) == (pytest.approx(0.05 / 0.3, abs=1e-3), ())
    observation = Observation(world.model, motions=(barred, latched))
    found = {each.joint: (each.code, str(each.severity)) for each in faults(observation)}
    assert found == {"j0": ("jammed", "error"), "j1": ("not_returned", "error")}


@pytest.mark.parametrize(("lid_waits_for", "opens"), [(set(), True), ({0}, False)])
def test_a_flap_opens_with_its_lid_alone_where_the_unfolded_side_would_stop_it(
    lid_waits_for, opens
):
    """The side carries the lid; a lid that itself waits for the flap lets neither open."""
    world = Barred({0: {1}, 1: lid_waits_for, 2: set()}, unless={0: {2}})
    world.carried = (*world.carried[:2], frozenset({"block1", "block2"}))
    found = opening(world)
    assert found["j0"] == (opens, ("j1",) if opens else ())
    assert found["j1"] == (opens, ())


@pytest.mark.parametrize(
    ("gives_way", "needs", "code"), [(True, ("j1",), []), (False, (), ["others_moved"])]
)
def test_a_drawer_that_can_push_its_door_open_needs_it_open_if_it_opens_alone(
    gives_way, needs, code
):
    class Pushed(Sliders):
        def step(self, forces):
            super().step(forces)
            if not gives_way and self._q[1] > self._q[0]:
                self._q[0] = self._q[1]
                self._v[0] = self._v[1]
            if self._q[0] > self._q[1]:
                self._q[1] = self._q[0]
                self._v[1] = self._v[0]

    world = Pushed([2.0, 2.0])
    motions = {item.joint: item for item in sweep(world, CONFIG)}
    assert (motions["j0"].reached > 0.99, motions["j0"].needs_open) == (True, needs)
    found = faults(Observation(world.model, motions=(motions["j0"],)))
    assert [item.code for item in found if item.joint == "j0"] == code


def test_of_joints_that_move_together_one_that_opens_speaks_for_all():
    class Coupled(Sliders):
        def step(self, forces):
            super().step(np.full(2, forces[1]))

    world = Coupled([2.0, 2.0])
    world.joints = (world.joints[0], replace(world.joints[1], mimic=Mimic("j0")))
    motion = only(world)
    assert (motion.joint, motion.reached > 0.99, motion.others_moved) == ("j1", True, 0.0)
    assert rest(world, CONFIG) == ()


def test_what_only_contact_moves_is_seen_at_rest():
    assert rest(Sliders([2.0], weight=20.0), CONFIG)[0].drift == 0.0
    pushed = Sliders([2.0])
    pushed.push = 0.05
    # 0.5 a t^2, and the work of the push
    moved = rest(pushed, CONFIG)[0]
    assert moved.drift == pytest.approx(0.0125 * CONFIG.rest_s**2, rel=0.02)
    assert moved.energy == pytest.approx(0.05 * moved.drift, rel=0.02)
    assert moved.energy_height == pytest.approx(moved.energy / (2.0 * 9.81))


@settings(max_examples=40, deadline=None)
@given(push=st.floats(1e-8, 1e-2), mass=st.floats(0.01, 50.0))
def test_stopping_early_hides_no_drift_that_would_be_reported(push, mass):
    world = Sliders([mass])
    world.push = push
    whole = min(0.5 * push / mass * CONFIG.rest_s**2, 0.3) / 0.3
    seen = rest(world, CONFIG)[0].share
    assert seen == pytest.approx(whole, rel=0.02, abs=0.1 * CONFIG.drift_soft)


def test_what_stands_still_is_not_watched_for_long():
    world = Sliders([2.0], weight=20.0)
    rest(world, CONFIG)
    assert world.steps * world.time_step == pytest.approx(CONFIG.still_s)


def test_a_block_that_starts_to_roll_off_a_hilltop_is_watched_to_the_end():
    class Hilltop(Sliders):
        def step(self, forces):
            # Thirty times further every second: a crawl for two seconds, and open after three.
            self.push = 11.5 * self._q[0] + 1e-6
            super().step(forces)

    assert rest(Hilltop([1.0]), CONFIG)[0].drift > 1e-3


@pytest.mark.parametrize(
    ("weight", "opened"), [(20.0, 0.0), (0.0, 0.0), (-0.04, 0.5 * 0.02 * CONFIG.rest_s**2)]
)
def test_a_block_opens_by_itself_where_its_weight_opens_it(weight, opened):
    fallen = fall(Sliders([2.0], weight=weight), CONFIG)
    assert fallen.joints[0].moved == pytest.approx(opened, rel=0.02)
    assert fallen.energy == pytest.approx(0.0, abs=1e-12)


def test_energy_from_nowhere_is_seen_in_a_fall_and_after_letting_go():
    world = Sliders([2.0], weight=0.5)
    world.push = 1.0
    assert fall(world, CONFIG).energy == pytest.approx(1.0 * 0.3, rel=0.05)
    world.place(np.zeros(1))
    gain = let_go(world, CONFIG)
    # 0.5 m (a t)^2
    assert gain.energy == pytest.approx(0.5 * 2.0 * (0.5 * CONFIG.release_s) ** 2, rel=0.02)


GOOD = JointMotion("j", 1.0, 0.0, 0.0, 0.0, 1.0, finite=True, range=0.3, pushed="k")
HELD = RestMotion("j", 0.0, 0.0, finite=True)
FALLEN = Fall((FallMotion("j", 0.12, 0.4), FallMotion("k", 0.01, 0.04)))


def moved(**changes):
    return {"motions": (replace(GOOD, **changes),)}


def rested(share=0.0, **changes):
    return {"rest": (replace(HELD, drift=0.3 * share, share=share, **changes),)}


@pytest.mark.parametrize(
    ("observed", "expected"),
    [
        (moved(), []),
        (moved(reached=0.5), [("jammed", "error", 0.5)]),
        (moved(returned=0.2), [("not_returned", "error", 0.2)]),
        (moved(overshoot=0.009), [("limit_overshoot", "warning", 0.03)]),
        (moved(overshoot=0.09), [("limit_overshoot", "error", 0.3)]),
        (moved(others_moved=0.06), [("others_moved", "warning", 0.06)]),
        (moved(others_moved=0.6), [("others_moved", "error", 0.6)]),
        (moved(finite=False), [("not_finite", "error", None)]),
        (moved(energy=3.0, energy_height=0.3), [("energy_grows", "error", 3.0)]),
        (moved(energy=3.0, energy_height=0.06), [("energy_grows", "warning", 3.0)]),
        (moved(energy=3.0, energy_height=0.04), []),
        (moved(energy=0.009, energy_height=9.0), []),
        (rested(0.01), []),
        (rested(0.05), [("pushed_at_rest", "warning", 0.05)]),
        (rested(0.5), [("pushed_at_rest", "error", 0.5)]),
        ({"fall": Fall(finite=False)}, [("not_finite", "error", None)]),
        # Only what weight moves opens by its weight.
        (rested() | {"fall": FALLEN}, [("opens_by_itself", "warning", 0.4)]),
        (rested(0.03) | {"fall": FALLEN}, [("pushed_at_rest", "warning", 0.03)]),
    ],
)
def test_each_fault_of_a_motion_is_named_with_its_number(observed, expected):
    findings = faults(Observation(NOTHING, **observed))
    assert [(f.code, str(f.severity), f.value) for f in findings] == expected


def test_who_pushes_at_rest_is_named():
    (finding,) = faults(Observation(NOTHING, **rested(0.03, pushed_by=("door", "shelf"))))
    assert "'door' and 'shelf'" in finding.message


@pytest.mark.parametrize(
    ("resting", "joint", "value", "limit"),
    [(rested(energy=2.0, energy_height=0.1), "j", 2.0, 1.0), ({}, None, 4.0, 0.5)],
)
def test_made_up_energy_is_a_number_in_joules_against_what_is_allowed(resting, joint, value, limit):
    falling = Fall(energy=4.0, energy_height=0.4)
    (finding,) = faults(Observation(NOTHING, fall=falling, **resting))
    assert (finding.code, finding.joint, finding.unit) == ("energy_grows", joint, "J")
    assert (finding.value, finding.limit) == (value, limit)


def test_joints_that_cannot_meet_are_driven_at_the_same_time_and_to_the_same_end():
    together, one_by_one = Sliders([1.0, 2.0, 40.0]), Sliders([1.0, 2.0, 40.0])
    assert sweep(together, CONFIG, (("j0", "j1", "j2"),)) == sweep(one_by_one, CONFIG)
    assert together.steps < 0.5 * one_by_one.steps


def test_of_joints_driven_together_one_that_jams_is_driven_again_alone():
    assert sweep(walled(1.0, 2.0), CONFIG, (("j0", "j1"),)) == sweep(walled(1.0, 2.0), CONFIG)
