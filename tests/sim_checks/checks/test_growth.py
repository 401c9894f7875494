"""What the static checks do grows with the pairs that can meet, not with all pairs."""

import pytest
from many_joints import chain, keyboard

from asset_factory.sim_checks.checks.penetration import check_penetration
from asset_factory.sim_checks.checks.standing import check_standing
from asset_factory.sim_checks.config import PenetrationConfig, StandingConfig
from asset_factory.sim_checks.geometry import kinematics
from asset_factory.sim_checks.geometry.collision import Collider
from asset_factory.sim_checks.geometry.path import Orbit


def counted(monkeypatch, owner, name, work):
    calls = 0
    original = getattr(owner, name)

    def call(*args, **named):
        nonlocal calls
        calls += 1
        return original(*args, **named)

    with monkeypatch.context() as patch:
        patch.setattr(owner, name, call)
        work()
    return calls


@pytest.mark.parametrize("make", [chain, keyboard])
@pytest.mark.parametrize(
    ("owner", "name"), [(Collider, "stand"), (Orbit, "swept_bounds"), (kinematics, "joint_motion")]
)
def test_twice_the_links_take_twice_the_work(make, owner, name, monkeypatch):
    config = PenetrationConfig(combinations=0)

    def work(description):
        return counted(monkeypatch, owner, name, lambda: check_penetration(description, config))

    small = work(make(12))
    assert small > 0
    assert work(make(24)) <= 2.5 * small


def test_standing_poses_only_what_a_joint_moves(monkeypatch):
    def work(description):
        return counted(
            monkeypatch,
            kinematics,
            "joint_motion",
            lambda: check_standing(description, StandingConfig()),
        )

    assert work(keyboard(24)) <= 2.5 * work(keyboard(12))
