"""What the static checks do grows with the pairs that can meet, not with all pairs, and has bounds.

A file beyond them is not judged, says what was not looked at, and never passes.
"""

from dataclasses import replace
from unittest.mock import patch

import pytest
from box_world import cabinet, chain, keyboard, write_drawer

from asset_factory.sim_checks import run_checks
from asset_factory.sim_checks.checks.extent import oversized, undriven
from asset_factory.sim_checks.checks.in_simulator import judge_in_simulator
from asset_factory.sim_checks.checks.penetration import check_penetration
from asset_factory.sim_checks.checks.standing import check_standing
from asset_factory.sim_checks.config import (
    CheckConfig,
    PenetrationConfig,
    StandingConfig,
    WorkConfig,
)
from asset_factory.sim_checks.geometry import kinematics
from asset_factory.sim_checks.geometry.collision import Collider
from asset_factory.sim_checks.geometry.path import Orbit
from asset_factory.sim_checks.judge import examine_here
from asset_factory.sim_checks.report import Report, Status

PLENTY = WorkConfig()


@pytest.mark.parametrize(
    ("bounds", "counted"),
    [({"hulls": 24}, "25 collision shapes"), ({"moved_links": 23}, "move 24 links")],
)
def test_a_file_beyond_a_bound_is_not_looked_at(bounds, counted):
    keys = keyboard(24)
    assert oversized(keys, PLENTY) is None
    found = oversized(keys, replace(PLENTY, **bounds))
    assert (found.code, counted in found.message) == ("too_large_to_judge", True)
    assert Report("keys.urdf", findings=(found,)).status is Status.UNJUDGED


def test_a_chain_moves_half_the_square_of_its_links():
    links = 20
    moved = links * (links - 1) // 2
    assert oversized(chain(links), replace(PLENTY, moved_links=moved)) is None
    assert oversized(chain(links), replace(PLENTY, moved_links=moved - 1)) is not None


def test_too_many_looks_are_no_verdict():
    description = cabinet()
    assert not check_penetration(description, PenetrationConfig()).findings
    (found,) = check_penetration(description, PenetrationConfig(), most_looks=3).findings
    assert found.code == "too_large_to_judge"
    assert (found.value, found.limit) == (4, 3)


def test_a_simulator_is_not_asked_for_more_than_it_can_drive():
    description = keyboard(24)
    work = 24 * 25
    assert undriven(description, "mujoco", replace(PLENTY, driven_links=work)) is None
    config = replace(CheckConfig(), work=replace(PLENTY, driven_links=work - 1))
    (found,) = judge_in_simulator(description, "mujoco", config, None).findings
    assert (found.code, found.simulator) == ("too_large_to_judge", "mujoco")


def test_what_is_too_large_never_passes(tmp_path):
    path = write_drawer(tmp_path / "drawer.urdf", 0.004)
    assert examine_here(path, CheckConfig()).description is not None
    report = run_checks(path, ("mujoco",), replace(CheckConfig(), work=replace(PLENTY, hulls=1)))
    assert [finding.code for finding in report.findings] == ["too_large_to_judge"]
    assert report.status is Status.UNJUDGED


POSING = (kinematics, "joint_motion")


def counted(owner, name, check, description, config):
    with patch.object(owner, name, autospec=True, side_effect=getattr(owner, name)) as call:
        check(description, config)
    return call.call_count


@pytest.mark.parametrize(
    ("owner", "name", "check", "config", "make"),
    [
        *(
            (*counting, check_penetration, PenetrationConfig(combinations=0), make)
            for make in (chain, keyboard)
            for counting in ((Collider, "stand"), (Orbit, "swept_bounds"), POSING)
        ),
        (*POSING, check_standing, StandingConfig(), keyboard),
    ],
)
def test_twice_the_links_take_twice_the_work(owner, name, check, config, make):
    small, large = (counted(owner, name, check, make(count), config) for count in (12, 24))
    assert 0 < large <= 2.5 * small
