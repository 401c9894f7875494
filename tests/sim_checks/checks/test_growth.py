"""What the static checks do grows with the pairs that can meet, not with all pairs."""

import pytest
from box_world import chain, keyboard

from asset_factory.sim_checks.checks.penetration import check_penetration
from asset_factory.sim_checks.checks.standing import check_standing
from asset_factory.sim_checks.config import PenetrationConfig, StandingConfig
from asset_factory.sim_checks.geometry import kinematics
from asset_factory.sim_checks.geometry.collision import Collider
from asset_factory.sim_checks.geometry.path import Orbit

POSING = (kinematics, "joint_motion")


def counted(monkeypatch, owner, name, check, description, config):
    calls = 0
    original = getattr(owner, name)

    def call(*args, **named):
        nonlocal calls
        calls += 1
        return original(*args, **named)

    with monkeypatch.context() as patch:
        patch.setattr(owner, name, call)
        check(description, config)
    return calls


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
def test_twice_the_links_take_twice_the_work(owner, name, check, config, make, monkeypatch):
    small, large = (
        counted(monkeypatch, owner, name, check, make(count), config) for count in (12, 24)
    )
    assert 0 < large <= 2.5 * small
