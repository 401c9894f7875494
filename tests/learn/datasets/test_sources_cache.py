"""Datasets are brought into the cache once; what is broken is passed over with its reason."""

import importlib.util
import json
import time
from dataclasses import replace
from pathlib import Path
from unittest.mock import Mock

import numpy as np
import pytest
from box_world import write_urdf
from registry_samples import BAD_REPORT, REPORT
from usda import CABINET, stage, write

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.registry import Entry, Registry
from asset_factory.learn.datasets import SourceSettings, cache, making, prepare
from asset_factory.learn.datasets.__main__ import _parser, main
from asset_factory.learn.datasets.description import find_descriptions
from asset_factory.learn.datasets.fronts import front_advice
from asset_factory.learn.datasets.making import sampled_item, turned_sampled
from asset_factory.learn.samples.sampled_object import read_sampled, write_sampled

SETTINGS = SourceSettings(points=64, wall_s=60.0)
HINGE = (
    '<joint name="hinge" type="{}"><parent link="base"/><child link="door"/>'
    '<origin xyz="-0.5 -0.31 0"/>'
    '<axis xyz="0 0 1"/><limit lower="-1.5" upper="0"/></joint>'
)


def cabinet(folder, kind="revolute", depth=0.6):
    folder.mkdir(parents=True, exist_ok=True)
    boxes = {"base": ((0, 0, 0), (1, depth, 0.8)), "door": ((0.5, 0, 0), (1, 0.02, 0.8))}
    return write_urdf(folder, boxes, HINGE.format(kind)).rename(folder / "cabinet.urdf")


def bring(tmp_path, kind="description", **changes):
    asked = {"settings": SETTINGS, "workers": 1, "cache": tmp_path / "cache", **changes}
    return prepare(kind, tmp_path / "data", **asked)


def files_of(report):
    return list(report.read.values())


@pytest.fixture
def dataset(tmp_path):
    data = tmp_path / "data"
    for name in ("cabinet_1", "cabinet_2"):
        cabinet(data / name)
    cabinet(data / "still_1", kind="fixed")
    (cabinet(data / "torn_1")).write_text("<robot name='x'><link")
    return tmp_path


@pytest.mark.parametrize("accident", [TimeoutError(), ChildProcessError()])
def test_an_accident_of_a_reader_is_no_refusal_to_keep(dataset, monkeypatch, accident):
    monkeypatch.setattr(making, "sampled_item", Mock(side_effect=accident))
    with pytest.raises(type(accident)):
        making.make_sampled("description", None, None, "key-0000000000000000", dataset / "x.npz")


def test_good_objects_are_read_and_bad_ones_counted(dataset):
    prepared = bring(dataset)
    assert list(prepared.read) == ["cabinet_1", "cabinet_2"]
    assert prepared.counts == {"no_movable_joint": 1, "unreadable": 1}
    assert prepared.made == 2
    sampled = read_sampled(files_of(prepared)[0])
    assert sampled.name == "cabinet_1"
    assert sampled.points.shape == (64, 3)
    said = json.loads((files_of(prepared)[0].parent / "data.json").read_text())
    assert said["read"] == ["cabinet_1", "cabinet_2"]
    assert list(said["skipped"]["unreadable"]) == ["torn_1"]
    assert "still_1" in "\n".join(prepared.lines())


def test_again_does_nothing_and_notices_what_changed(dataset):
    first = bring(dataset)
    stamps = [path.stat().st_mtime_ns for path in files_of(first)]
    again = bring(dataset)
    assert files_of(again) == files_of(first)
    assert again.made == 0
    assert [path.stat().st_mtime_ns for path in files_of(again)] == stamps
    cabinet(dataset / "data" / "cabinet_1", depth=0.4)
    altered = bring(dataset)
    assert altered.made == 1
    assert files_of(altered)[0] != files_of(first)[0]
    assert files_of(altered)[1] == files_of(first)[1]
    (dataset / "data" / "cabinet_2" / "cabinet.urdf").unlink()
    assert list(bring(dataset).read) == ["cabinet_1"]
    files_of(first)[1].unlink()
    cabinet(dataset / "data" / "cabinet_2")
    assert bring(dataset).made == 1


def test_same_object_same_bytes_anywhere(dataset, tmp_path):
    one = files_of(bring(dataset))
    other = files_of(bring(dataset, cache=tmp_path / "elsewhere", workers=2))
    assert [path.name for path in one] == [path.name for path in other]
    assert [path.read_bytes() for path in one] == [path.read_bytes() for path in other]


def sleeps(*_):
    time.sleep(60.0)


def test_object_that_takes_too_long_is_passed_over_and_tried_again(dataset, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(cache, "make_sampled", sleeps)
        slow = bring(dataset, settings=replace(SETTINGS, wall_s=0.1))
    assert slow.counts == {"timeout": 4}
    assert list(bring(dataset).read) == ["cabinet_1", "cabinet_2"]


def test_split_chooses_by_name(dataset):
    split = dataset / "train.txt"
    split.write_text("# for training\ncabinet_2   # a good one\n\nnot_there\n")
    assert list(bring(dataset, split=split).read) == ["cabinet_2"]
    split.write_text("# nothing\n")
    with pytest.raises(ConfigError, match="names no object"):
        bring(dataset, split=split)
    split.write_text("nobody\n")
    with pytest.raises(ConfigError, match="names none"):
        bring(dataset, split=split)


def test_what_cannot_be_asked_is_said(dataset):
    with pytest.raises(ConfigError, match="there are description"):
        bring(dataset, "nonsense")
    with pytest.raises(ConfigError, match="is no folder"):
        bring(dataset / "nowhere")
    with pytest.raises(ConfigError, match="holds no object"):
        bring(dataset, "partnet")
    with pytest.raises(ConfigError, match="factory build"):
        bring(dataset, "registry")


@pytest.mark.parametrize(
    ("front", "origin"),
    [("-y", (-0.5, -0.31)), ("x", (-0.31, 0.5)), ("y", (0.5, 0.31)), ("-x", (0.31, -0.5))],
)
def test_front_turns_to_minus_y_and_a_wrong_one_is_noticed(dataset, front, origin):
    item = find_descriptions(dataset / "data")[0]
    sampled = sampled_item("description", item, replace(SETTINGS, front=front), seed=1)
    np.testing.assert_allclose(sampled.origin[1, :2], origin, atol=1e-6)
    turned = turned_sampled(sampled, np.pi)
    np.testing.assert_allclose(turned.origin[1, :2], -np.asarray(origin), atol=1e-6)
    np.testing.assert_allclose(turned.points * [-1, -1, 1], sampled.points, atol=1e-6)
    write_sampled(dataset / "sampled.npz", sampled)
    advice = front_advice([dataset / "sampled.npz"], front)
    assert advice.endswith("as they should" if front == "-y" else "want -y: try --front -y")


def test_usd_is_read_in_a_process_of_its_own(tmp_path):
    pytest.importorskip("pxr")
    write(tmp_path / "data" / "cabinet_1", stage(CABINET))
    write(tmp_path / "data" / "cabinet_2", "PXR-USDC" + "\1" * 500, "asset.usdc")
    prepared = bring(tmp_path, "usd")
    assert list(prepared.read) == ["cabinet_1"]
    assert sum(prepared.counts.values()) == 1


def test_usd_without_its_library_says_what_to_install(dataset, monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(ConfigError, match=r"asset-factory\[train\]"):
        bring(dataset, "usd")


def test_registered_assets_are_objects(tmp_path):
    registry = Registry(tmp_path / "data", create=True)
    for name, status in (("cabinet-1", "passed"), ("cabinet-2", "rejected")):
        entry = Entry(name, name, "cabinet", status, "", 2, 1, 2)
        if status == "passed":
            with registry.staging_folder() as staging:
                cabinet(staging / name).rename(staging / name / "asset.urdf")
                registry.add(entry, REPORT, staging / name)
        else:
            registry.add(entry, BAD_REPORT)
    assert list(bring(tmp_path, "registry").read) == ["cabinet-1"]


def test_command_keeps_sampled_objects_where_the_docs_say():
    assert _parser().get_default("cache") == Path("out/.cache/sampled")


def test_command_prints_the_report_and_writes_splits(dataset, capsys):
    asked = ["--kind", "description", "--path", str(dataset / "data")]
    asked += ["--cache", str(dataset / "cache"), "--points", "64", "--workers", "1"]
    assert main(asked) == 0
    assert "2 of 4 objects read" in capsys.readouterr().out
    assert main([*asked, "--write-split", str(dataset / "lists"), "--held-out", "0.5"]) == 0
    lists = [(dataset / f"lists.{part}.txt").read_text().split() for part in ("train", "held_out")]
    assert sorted([*lists[0], *lists[1]]) == ["cabinet_1", "cabinet_2", "still_1", "torn_1"]
    assert main(["--kind", "description", "--path", str(dataset / "nowhere")]) == 2
