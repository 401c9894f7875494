"""The same inputs built on a Ray cluster and by local workers: the same registry, byte for byte."""

from pathlib import Path

import pytest
from input_files import write_inputs
from registry_samples import require_same

from asset_factory.factory.config import BuildConfig
from asset_factory.factory.jobs import LocalExecutor
from asset_factory.factory.jobs.job import Job
from asset_factory.factory.jobs.ray.builds import ray_executor

pytestmark = [
    pytest.mark.full,
    pytest.mark.filterwarnings("ignore:subprocess .* is still running:ResourceWarning"),
    pytest.mark.filterwarnings("ignore:unclosed:ResourceWarning"),
]
CONFIG = BuildConfig(articulator="rigid", simulators=())


@pytest.fixture(scope="module")
def inputs(tmp_path_factory):
    folder = write_inputs(tmp_path_factory.mktemp("here") / "meshes")
    return tuple(sorted(folder.glob("*.stl")))


@pytest.fixture(scope="module")
def local(inputs, tmp_path_factory):
    output = tmp_path_factory.mktemp("local")
    results = list(Job(inputs, output, CONFIG, LocalExecutor(1)).run())
    assert sorted(result.entry.status for result in results) == ["passed"] * 3 + ["rejected"]
    return output


@pytest.mark.parametrize("through", ["folder", "url"])
def test_a_registry_built_on_ray_is_the_one_built_locally(inputs, local, tmp_path, through):
    between = tmp_path / "between"
    between.mkdir()
    url = "" if through == "folder" else between.as_uri()
    executor = ray_executor(CONFIG, workers=1, exchange=url)
    output = tmp_path / "out"
    results = list(Job(inputs, output, CONFIG, executor).run())
    assert sorted(Path(result.input).name for result in results) == [path.name for path in inputs]
    assert all(result.attempts == 1 for result in results)
    require_same(output, local)
    assert not list(between.iterdir())
    again = list(Job(inputs, output, CONFIG, executor).run())
    assert all(result.known for result in again)
