"""An asset of too many hulls gets fewer, as many times as cutting apart makes several of one."""

from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from asset_factory.factory.config import BuildConfig, HullsConfig
from asset_factory.factory.manufacture.plan import Plan
from asset_factory.factory.verify import rounds
from asset_factory.factory.verify.rounds import Rounds

MOST = 100


@dataclass(frozen=True)
class Draft:
    plan: Plan
    asset: Any
    passes: bool = True
    before: Any = None
    inspected: Any = None
    work: int = 0


def drafted(monkeypatch, cut_off, refused_below=0, fat=0):
    """Made of 150 hulls before cutting, or what is asked for; cutting adds so many.

    Where hulls were joined it adds ``fat`` besides: what is coarser is more in the way.
    """
    aims = []

    def made(self, plan, folder, done=0):
        aims.append(plan.fewer)
        count = 150 if plan.fewer is None else min(150, plan.fewer) + fat
        count += cut_off
        return Draft(plan, SimpleNamespace(hull_count=count), count >= refused_below)

    monkeypatch.setattr(Rounds, "_made", made)
    monkeypatch.setattr(Rounds, "_next", lambda self, verdict, draft: None)
    monkeypatch.setattr(rounds, "dispensable_joints", lambda *asked: None)
    monkeypatch.setattr(rounds, "first_plan", lambda *asked: Plan())
    monkeypatch.setattr(rounds, "close_seen", lambda drawn: drawn)
    config = replace(BuildConfig(), hulls=HullsConfig(most=MOST))
    nothing = None
    stages = SimpleNamespace(config=config)
    draft = Rounds(nothing, nothing, Path(), nothing, stages).drafted()
    return draft, aims


@pytest.mark.parametrize(
    ("made", "asked", "count", "before"),
    [
        # What cutting adds is asked for less.
        ({"cut_off": 30}, [None, MOST, MOST - 30], MOST, 180),
        ({"cut_off": -50}, [None], MOST, None),
        # What passes with more only keeps more.
        ({"cut_off": 30, "refused_below": 120}, [None, MOST, MOST - 30], 130, 180),
        # Where cutting makes more than may be, the least is kept.
        ({"cut_off": 120}, [None, MOST], 220, 270),
        # What becomes heavier by joining stays as it was.
        ({"cut_off": 30, "fat": 90}, [None, MOST], 180, None),
    ],
)
def test_hulls_are_joined_to_as_many_as_may_be(monkeypatch, made, asked, count, before):
    draft, aims = drafted(monkeypatch, **made)
    assert aims == asked
    assert draft.asset.hull_count == count
    assert getattr(draft.before, "hull_count", None) == before
