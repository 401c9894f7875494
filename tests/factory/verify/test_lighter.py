"""An asset of too many hulls gets fewer, as many times as cutting apart makes several of one."""

from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

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
    config = replace(BuildConfig(), hulls=HullsConfig(most=MOST))
    nothing = None
    stages = SimpleNamespace(config=config)
    draft = Rounds(nothing, nothing, Path(), nothing, stages).drafted()
    return draft, aims


def test_what_cutting_adds_is_asked_for_less(monkeypatch):
    draft, aims = drafted(monkeypatch, cut_off=30)
    assert aims == [None, MOST, MOST - 30]
    assert draft.asset.hull_count == MOST
    assert draft.before.hull_count == 180


def test_nothing_is_made_again_of_what_is_light(monkeypatch):
    assert drafted(monkeypatch, cut_off=-50)[1] == [None]


def test_what_passes_with_more_only_keeps_more(monkeypatch):
    draft, aims = drafted(monkeypatch, cut_off=30, refused_below=120)
    assert aims == [None, MOST, MOST - 30]
    assert draft.asset.hull_count == 130


def test_where_cutting_makes_more_than_may_be_the_least_is_kept(monkeypatch):
    draft, aims = drafted(monkeypatch, cut_off=120)
    assert aims == [None, MOST]
    assert draft.asset.hull_count == 220


def test_what_becomes_heavier_by_joining_stays_as_it_was(monkeypatch):
    draft, aims = drafted(monkeypatch, cut_off=30, fat=90)
    assert aims == [None, MOST]
    assert draft.asset.hull_count == 180
    assert draft.before is None
