"""What the static checks do grows with the pairs that can meet, not with all pairs."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from box_world import body, described, joint

from asset_factory.sim_checks.checks.penetration import check_penetration
from asset_factory.sim_checks.checks.standing import check_standing
from asset_factory.sim_checks.config import PenetrationConfig, StandingConfig
from asset_factory.sim_checks.description import Description
from asset_factory.sim_checks.geometry import kinematics
from asset_factory.sim_checks.geometry.collision import Collider
from asset_factory.sim_checks.geometry.path import Orbit


def chain(links: int) -> Description:
    """Boxes in a row, each on a hinge at the end of the one before, 2 mm apart."""
    pitch = 0.102
    bodies = [
        body(f"l{i}", [((pitch * i + 0.05, 0.0, 0.0), (0.1, 0.05, 0.05))], (pitch * i, 0.0, 0.0))
        for i in range(links)
    ]
    hinges = [
        joint(
            f"j{i}", "revolute", f"l{i - 1}", f"l{i}", (pitch, 0, 0), (0.0, 0.0, 1.0), (0.0, 0.02)
        )
        for i in range(1, links)
    ]
    return described(bodies, hinges)


def keyboard(keys: int) -> Description:
    """Keys in a row, 2 mm apart, that go down into nothing."""
    bodies = [body("base", [((0.0, 0.0, -1.0), (1.0, 1.0, 0.1))])]
    slides = []
    for i in range(keys):
        at = (0.02 * i, 0.0, 0.0)
        bodies.append(body(f"k{i}", [(at, (0.018, 0.018, 0.01))], at))
        slides.append(
            joint(f"j{i}", "prismatic", "base", f"k{i}", at, (0.0, 0.0, -1.0), (0.0, 0.004))
        )
    return described(bodies, slides)


def counted(
    monkeypatch: pytest.MonkeyPatch, owner: object, name: str, work: Callable[[], object]
) -> int:
    calls = 0
    original = getattr(owner, name)

    def call(*args: object, **named: object) -> object:
        nonlocal calls
        calls += 1
        return original(*args, **named)

    with monkeypatch.context() as patch:
        patch.setattr(owner, name, call)
        work()
    return calls


@pytest.mark.parametrize("make", [chain, keyboard])
@pytest.mark.parametrize(
    ("owner", "name"),
    [(Collider, "stand"), (Orbit, "swept_bounds"), (kinematics, "joint_motion")],
)
def test_twice_the_links_take_twice_the_work(
    make: Callable[[int], Description],
    owner: object,
    name: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    config = PenetrationConfig(combinations=0)

    def work(description: Description) -> int:
        return counted(monkeypatch, owner, name, lambda: check_penetration(description, config))

    small = work(make(12))
    assert small > 0
    assert work(make(24)) <= 2.5 * small


def test_standing_poses_only_what_a_joint_moves(monkeypatch: pytest.MonkeyPatch) -> None:
    def work(description: Description) -> int:
        return counted(
            monkeypatch,
            kinematics,
            "joint_motion",
            lambda: check_standing(description, StandingConfig()),
        )

    assert work(keyboard(24)) <= 2.5 * work(keyboard(12))
