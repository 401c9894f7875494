"""A stage's settings redo it and those after it, none before."""

import json
import math
from dataclasses import replace
from unittest.mock import Mock

import numpy as np
import pytest
from fault_corpus.things import Body, Move, Thing, at, box, write_urdf

from asset_factory.factory.build import make_asset
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.runtime.stages import Stages
from asset_factory.factory.runtime.store import Store, folder_digests
from asset_factory.sim_checks.judge import Judge

BASE = BuildConfig(simulators=())


def write_cabinet(folder, name="cabinet", lower=0.0):
    """A block and a door, with the door's hinge."""
    block = Body("base", (box((0.0, 0.0, 0.4), (0.6, 0.4, 0.8)),), at(0.0, 0.0, 0.0), 1.0)
    door = Body("door", (box((0.0, -0.22, 0.4), (0.6, 0.02, 0.8)),), at(-0.3, -0.24, 0.0), 1.0)
    hinge = Move("hinge", "revolute", "base", "door", (0.0, 0.0, -1.0), lower, 1.5)
    return write_urdf(Thing(name, (block, door), (hinge,)), folder)


@pytest.fixture(scope="module")
def cabinet(tmp_path_factory):
    return write_cabinet(tmp_path_factory.mktemp("cabinet"))


@pytest.fixture(scope="module")
def judge():
    with Judge(BASE.checks) as judge:
        yield judge


@pytest.fixture(scope="module")
def first(cabinet, judge, tmp_path_factory):
    """The first build of it, and its cache."""
    cache = tmp_path_factory.mktemp("cache")
    return make_asset(cabinet, tmp_path_factory.mktemp("first"), BASE, cache, judge), cache


def test_the_first_build_does_everything(first):
    product, _ = first
    assert product.entry.status == "passed", product.told.report.findings
    assert product.done == ("articulate", "decompose", "finish", "inspect", "validate")
    assert product.result.reused == ()
    assert "cabinet.urdf" in product.reads


CHANGES = {
    "nothing": (BASE, ()),
    "simulators": (replace(BASE, simulators=("mujoco",)), ("validate",)),
    "inertia": (
        replace(BASE, inertia=replace(BASE.inertia, density=700.0)),
        ("finish", "inspect", "validate"),
    ),
    # The boxes' hulls are exact whatever the error, and from equal hulls equal things follow.
    "decompose, the same hulls": (
        replace(BASE, decompose=replace(BASE.decompose, error_m=0.004)),
        ("decompose",),
    ),
    "articulator": (replace(BASE, articulator="annotated"), ("articulate",)),
    "intake": (
        replace(BASE, intake=replace(BASE.intake, height=1.0)),
        ("articulate", "decompose", "finish", "inspect", "validate"),
    ),
}


@pytest.mark.parametrize("what", CHANGES)
def test_a_change_redoes_its_stage_and_what_follows(what, first, cabinet, tmp_path):
    _, cache = first
    config, redone = CHANGES[what]
    with Judge(config.checks) as judge:
        product = make_asset(cabinet, tmp_path / "staging", config, cache, judge)
    assert product.entry.status == "passed", product.told.report.findings
    assert product.done == redone
    stages = {"articulate", "decompose", "finish", "inspect", "validate"}
    assert set(product.result.reused) == stages - set(redone)


def test_a_pose_outside_the_range_is_built_and_kept(judge, tmp_path):
    """The articulator moves the mesh to the nearest limit, so it differs from the loaded one."""
    ajar = write_cabinet(tmp_path, "ajar", lower=0.2)
    first = make_asset(ajar, tmp_path / "first", BASE, tmp_path / "cache", judge)
    again = make_asset(ajar, tmp_path / "again", BASE, tmp_path / "cache", judge)
    assert first.entry.status == "passed", first.told.report.findings
    assert (first.done[0], again.done) == ("articulate", ())
    assert first.bundle is not None
    assert again.bundle is not None
    assert folder_digests(first.bundle) == folder_digests(again.bundle)
    (hinge,) = json.loads((first.bundle / "asset.json").read_text())["joints"]
    assert (hinge["lower"], hinge["upper"]) == pytest.approx((0.0, 1.3))
    # The door's free edge swung 0.6 m x sin(0.2) out of the carcass, whose front is at -0.2 m.
    low, _ = json.loads((first.bundle / "asset.json").read_text())["bounds"]
    assert low[1] < -0.2 - 0.6 * math.sin(0.2)


def test_a_rejection_is_remembered_with_its_number(tmp_path):
    told = {"value": 0.0, "unit": "joints", "limit": 1.0}
    refuse = Mock(side_effect=InputRejected("no_movable_joint", "nothing moves", **told))
    for _ in range(2):
        stages = Stages(BASE, Store(tmp_path))
        with pytest.raises(InputRejected) as rejection:
            stages.recall("articulate", int, "articulate-00", refuse)
        found = rejection.value.finding
        assert (found.code, found.value, found.limit) == ("no_movable_joint", 0.0, 1.0)
    assert refuse.call_count == 1
    assert stages.reused == ["articulate"]


def test_what_another_try_might_better_is_not_kept(tmp_path):
    values = iter((1.0, 2.0))
    for expected in (1.0, 2.0):
        stages = Stages(BASE, Store(tmp_path))
        value = stages.recall(
            "inspect", float, "inspect-00", lambda: next(values), lambda value: value > 1.0
        )
        assert value == expected
        assert stages.done == ["inspect"]
    assert Stages(BASE, Store(tmp_path)).recall("inspect", float, "inspect-00", lambda: 3.0) == 2.0


def test_stage_times_add_up_to_the_whole():
    stages = Stages(BASE)
    with stages.clock.stage("outer"):
        sum(np.arange(100_000).tolist())
        with stages.clock.stage("inner"):
            sum(np.arange(100_000).tolist())
    assert sum(stages.clock.stages.values()) <= stages.clock.seconds
    assert set(stages.clock.stages) == {"outer", "inner"}
    assert stages.clock.stages["outer"] > 0.0
