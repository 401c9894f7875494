"""A warm worker's assets are those of a new one, whatever it built before."""

from pathlib import Path

import trimesh
from job_samples import PLAIN, job
from laid import laid

from asset_factory.factory.jobs import local, worker
from asset_factory.factory.jobs.local import LocalExecutor
from asset_factory.factory.registry import Registry
from asset_factory.factory.runtime.store import folder_digests


def test_the_order_of_builds_changes_no_byte(tmp_path):
    folder = laid(tmp_path / "in" / "broken.glb", "glTF but not really").parent
    for number, size in enumerate(((0.5, 0.4, 0.3), (0.2, 0.3, 0.4))):
        trimesh.creation.box(size).export(folder / f"box_{number}.stl")
    inputs = sorted(folder.iterdir())
    digests = []
    for number, order in enumerate((inputs, inputs[::-1])):
        output = tmp_path / f"out_{number}"
        results = {Path(r.input).name: r.entry.status for r in job(tuple(order), output).run()}
        assert results == {"box_0.stl": "passed", "box_1.stl": "passed", "broken.glb": "rejected"}
        digests.append(folder_digests(output / "assets") | folder_digests(output / "rejected"))
        assert {entry.key != "" for entry in Registry(output).entries()} == {True}
        # Real products are known again, be they good or bad.
        assert all(result.known for result in job(tuple(order), output).run())
    assert digests[0] == digests[1]


def test_one_judge_is_kept_for_one_configuration():
    first = worker._judge(PLAIN.checks, 1)
    assert worker._judge(PLAIN.checks, 1) is first
    assert worker._judge(PLAIN.checks, 2) is not first
    assert len(worker._JUDGES) == 1


def test_simulators_share_what_processors_the_workers_leave(monkeypatch):
    monkeypatch.setattr(local, "processors", lambda: 8)
    assert [LocalExecutor(workers).engines for workers in (1, 3, 8, 9)] == [8, 2, 1, 1]
