"""A stage's settings redo it and those after it, none before; what is kept equals a new run."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
import trimesh

from asset_factory.factory.build import make_asset
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.runtime.stages import Stages
from asset_factory.factory.runtime.store import Store, folder_digests
from asset_factory.sim_checks.judge import Judge

BASE = BuildConfig(simulators=())


@pytest.fixture(scope="module")
def cabinet(tmp_path_factory):
    """A board and a door, with the door's hinge."""
    folder = tmp_path_factory.mktemp("cabinet")
    for name, size, center in (
        ("base", (0.6, 0.4, 0.8), (0, 0, 0.4)),
        ("door", (0.6, 0.02, 0.8), (0, -0.22, 0.4)),
    ):
        box = trimesh.creation.box(size)
        box.apply_translation(center)
        (folder / f"{name}.obj").write_text(
            trimesh.exchange.obj.export_obj(box, include_normals=False)
        )
    (folder / "cabinet.urdf").write_text(
        '<robot name="cabinet"><link name="base"><visual>'
        '<geometry><mesh filename="base.obj"/></geometry></visual></link>'
        '<link name="door"><visual><geometry><mesh filename="door.obj"/></geometry></visual></link>'
        '<joint name="hinge" type="revolute"><origin xyz="-0.3 -0.24 0"/>'
        '<parent link="base"/><child link="door"/>'
        '<axis xyz="0 0 -1"/><limit lower="0" upper="1.5" effort="1" velocity="1"/></joint></robot>'
    )
    # The door's mesh is written in the root's frame.
    text = (folder / "cabinet.urdf").read_text()
    moved = text.replace(
        '<link name="door"><visual>', '<link name="door"><visual><origin xyz="0.3 0.24 0"/>'
    )
    (folder / "cabinet.urdf").write_text(moved)
    return folder / "cabinet.urdf"


@pytest.fixture(scope="module")
def judge():
    with Judge(BASE.checks) as judge:
        yield judge


@pytest.fixture(scope="module")
def first(cabinet, judge, tmp_path_factory):
    """The first build of it, its cache and its staging folder."""
    cache = tmp_path_factory.mktemp("cache")
    staging = tmp_path_factory.mktemp("first")
    return make_asset(cabinet, staging, BASE, cache, judge), cache, staging


def test_the_first_build_does_everything(first):
    product, _, _ = first
    assert product.entry.status == "passed", product.told.report.findings
    assert product.done == ("articulate", "finish", "inspect", "validate")
    assert product.result.reused == ()
    assert {"cabinet.urdf", "base.obj", "door.obj"} <= set(product.reads)


CHANGES = {
    "nothing": (BASE, ()),
    "simulators": (replace(BASE, simulators=("mujoco",)), ("validate",)),
    "checks": (
        replace(BASE, checks=replace(BASE.checks, lint=replace(BASE.checks.lint, hand_m=0.05))),
        ("inspect", "validate"),
    ),
    "inertia": (
        replace(BASE, inertia=replace(BASE.inertia, density=700.0)),
        ("finish", "inspect", "validate"),
    ),
    # The boxes' hulls are exact whatever the error, and from equal hulls equal things follow.
    "decompose, the same hulls": (
        replace(BASE, decompose=replace(BASE.decompose, error_m=0.004)),
        (),
    ),
    "decompose, limits": (replace(BASE, decompose=replace(BASE.decompose, wall_s=1.0)), ()),
    "articulator": (replace(BASE, articulator="annotated"), ("articulate",)),
    "intake": (
        replace(BASE, intake=replace(BASE.intake, height=1.0)),
        ("articulate", "finish", "inspect", "validate"),
    ),
}


@pytest.mark.parametrize("what", CHANGES)
def test_a_change_redoes_its_stage_and_what_follows(what, first, cabinet, tmp_path):
    _, cache, _ = first
    config, redone = CHANGES[what]
    with Judge(config.checks) as judge:
        product = make_asset(cabinet, tmp_path / "staging", config, cache, judge)
    assert product.entry.status == "passed", product.told.report.findings
    assert product.done == redone
    assert set(product.result.reused) == {"articulate", "finish", "inspect", "validate"} - set(
        redone
    )


def test_what_is_kept_is_what_would_be_made(first, cabinet, judge, tmp_path):
    product, cache, _ = first
    again = make_asset(cabinet, tmp_path / "kept", BASE, cache, judge)
    anew = make_asset(cabinet, tmp_path / "anew", BASE, None, judge)
    assert again.done == anew.result.reused == ()
    assert again.bundle is not None
    assert anew.bundle is not None
    assert folder_digests(again.bundle) == folder_digests(anew.bundle)
    assert again.entry == anew.entry == product.entry
    # Kept findings are lists where new ones were tuples; as JSON both are the same.
    assert _said(again) == _said(anew) == _said(product)


def _said(product):
    return _normal(product.told.report.to_dict()), product.told.repairs


def _normal(data):
    if isinstance(data, dict):
        return {name: _normal(value) for name, value in data.items()}
    return [_normal(value) for value in data] if isinstance(data, list | tuple) else data


def test_a_pose_outside_the_range_is_built_and_kept(cabinet, judge, tmp_path):
    """The articulator moves the mesh to the nearest limit, so it differs from the loaded one."""
    ajar = cabinet.with_name("ajar.urdf")
    ajar.write_text(cabinet.read_text().replace('lower="0" upper="1.5"', 'lower="0.2" upper="1.5"'))
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
    assert json.loads((first.bundle / "asset.json").read_text())["bounds"][0][
        1
    ] < -0.2 - 0.6 * math.sin(0.2)


def test_a_damaged_cache_is_done_again(cabinet, judge, tmp_path):
    make_asset(cabinet, tmp_path / "one", BASE, tmp_path / "cache", judge)
    for path in (tmp_path / "cache").rglob("*.npz"):
        path.write_bytes(path.read_bytes()[:100])
    product = make_asset(cabinet, tmp_path / "two", BASE, tmp_path / "cache", judge)
    assert product.entry.status == "passed"
    assert product.result.reused == ()


def test_a_rejection_is_remembered_with_its_number(tmp_path):
    asked = []

    def refuse():
        asked.append(1)
        raise InputRejected(
            "no_movable_joint", "nothing moves", value=0.0, unit="joints", limit=1.0
        )

    for _ in range(2):
        stages = Stages(BASE, Store(tmp_path))
        with pytest.raises(InputRejected) as rejection:
            stages.recall("articulate", int, "articulate-00", refuse)
        wanted = ("no_movable_joint", 0.0, 1.0)
        assert (rejection.value.code, rejection.value.value, rejection.value.limit) == wanted
    assert len(asked) == 1
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
