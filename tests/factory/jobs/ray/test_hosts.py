"""Builds over several hosts that share no disk: the registry of an undisturbed run.

The hosts are network namespaces with addresses and a /tmp of their own; inputs and weights reach
them over TCP, and assets come back through a real S3 server.
"""

import shutil
import subprocess
import tempfile
import threading
import time
from pathlib import Path

import pytest
from command_line import COMMAND
from hosts import hosts
from input_files import write_inputs
from registry_samples import require_same
from repository import MESHES
from s3_server import BUCKET, s3_server
from tiny_checkpoint import write_checkpoint

import asset_factory
from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.cleaning import collect_garbage

pytestmark = [
    pytest.mark.cluster,
    pytest.mark.filterwarnings("ignore:subprocess .* is still running:ResourceWarning"),
    pytest.mark.filterwarnings("ignore:unclosed:ResourceWarning"),
]
FLAGS = ("--articulator", "rigid", "--sim", "mujoco", "--no-report", "--quiet")
#: Where a host has its own temporary files.
OWN = Path("/tmp")  # noqa: S108 - of a host, not of this machine


@pytest.fixture(scope="module")
def hidden(tmp_path_factory):
    """What the head alone sees."""
    return tmp_path_factory.mktemp("hidden")


@pytest.fixture(scope="module")
def inputs(hidden):
    return write_inputs(hidden / "meshes")


@pytest.fixture(scope="module")
def undisturbed(inputs, tmp_path_factory):
    output = tmp_path_factory.mktemp("local") / "out"
    assert begun(inputs, output, "--workers", "1").wait() == 0
    return output


def begun(inputs, output, *more, said=None, flags=FLAGS):
    """The command, in a process of its own: Ray reads the environment once and for all."""
    command = [*COMMAND, "build", *flags, *more]
    command += ["--input", inputs, "--output", output]
    return subprocess.Popen(command, stderr=said)


@pytest.fixture(scope="module")
def started(hidden):
    # Ray's sockets lie in it, and their paths may not be long.
    with (
        tempfile.TemporaryDirectory(prefix="hosts-", dir="/tmp", ignore_cleanup_errors=True) as own,
        hosts(hidden, Path(own)) as made,
        s3_server(made.head),
    ):
        import fsspec

        fsspec.filesystem("s3", skip_instance_cache=True).mkdir(BUCKET)
        made.come_up(workers=3)
        yield made


@pytest.fixture
def cluster(started):
    """A head and three workers, whatever befell them before."""
    started.restore(workers=3)
    return started


def built(cluster, inputs, output, disturb=None, *, code=0, flags=FLAGS):
    """Build over the hosts; what disturbs it happens after the first two inputs.

    Returns:
        What the command said to whoever started it.
    """
    Registry(output, create=True)
    more = ["--executor", "ray", "--ray-address", cluster.address]
    more += ["--ray-exchange", f"s3://{BUCKET}/between"]
    with tempfile.TemporaryFile("w+") as said:
        process = begun(inputs, output, *more, said=said, flags=flags)
        if disturb is not None:
            while Registry(output).count() < 2 and process.poll() is None:
                time.sleep(0.05)
            assert process.poll() is None, "it was over before it was disturbed"
            disturb()
        ended = process.wait(300.0)
        said.seek(0)
        # The link among the inputs is told of each time.
        told = "".join(line for line in said if "passed over" not in line)
    assert ended == code, told
    return told


def test_the_registry_is_that_of_one_host(cluster, inputs, undisturbed, tmp_path):
    for number in (2, 3, 4):
        assert cluster.files_on(number, inputs.parent) == []
    built(cluster, inputs, tmp_path / "out")
    entries = {entry.name: entry for entry in Registry(undisturbed).entries()}
    assert {name: entry.reason for name, entry in entries.items() if entry.reason} == {
        "nothing": "empty",
        "leads_out": "external_reference",
    }
    require_same(tmp_path / "out", undisturbed)
    for number in (2, 3, 4):
        left = cluster.files_on(number, OWN)
        assert not [path for path in left if path.endswith((".stl", ".obj", ".urdf", ".tar"))]


def test_weights_reach_hosts_that_do_not_see_them(cluster, hidden, tmp_path):
    meshes = hidden / "furniture"
    meshes.mkdir()
    for path in MESHES.glob("fridge.*"):
        shutil.copy(path, meshes)
    (hidden / "weights").mkdir()
    checkpoint = write_checkpoint(hidden / "weights" / "tiny.safetensors", base=7)
    flags = ("--checkpoint", checkpoint, "--points", "1500", "--sim", "", "--no-report", "--quiet")
    assert begun(meshes, tmp_path / "here", "--workers", "1", flags=flags).wait() == 0
    built(cluster, meshes, tmp_path / "out", flags=flags)
    require_same(tmp_path / "out", tmp_path / "here")
    manifests = (tmp_path / "out").rglob("asset.json")
    assert any("tiny.safetensors" in path.read_text() for path in manifests)
    kept = [
        [path for path in cluster.files_on(number, OWN) if path.endswith(checkpoint.name)]
        for number in (2, 3, 4)
    ]
    assert any(kept)
    assert all(len(paths) <= 1 for paths in kept), "once on each node"


def test_a_host_that_is_cut_off_for_a_while(cluster, inputs, undisturbed, tmp_path):
    back = threading.Timer(60.0, lambda: cluster.cut_off(3, back=True))

    def disturb():
        cluster.cut_off(3)
        back.start()

    built(cluster, inputs, tmp_path / "out", disturb=disturb)
    back.join()
    require_same(tmp_path / "out", undisturbed)


def test_hosts_that_join_and_leave(cluster, inputs, undisturbed, tmp_path):
    def disturb():
        cluster.start(5)
        cluster.kill(4)

    cluster.kill(3)
    built(cluster, inputs, tmp_path / "out", disturb=disturb)
    require_same(tmp_path / "out", undisturbed)


def test_a_host_whose_disk_fills_up(cluster, inputs, undisturbed, tmp_path):
    # With one other host it cannot be that all is done before the full one is asked.
    for number in (2, 3):
        cluster.kill(number)
    cluster.start(7, room="400m")
    cluster.await_nodes(3)
    built(cluster, inputs, tmp_path / "out", disturb=lambda: cluster.fill_disk(7))
    require_same(tmp_path / "out", undisturbed)


def test_a_host_without_room_is_given_no_work(cluster, inputs, undisturbed, tmp_path):
    cluster.start(8, room="60m")
    cluster.await_nodes(5)
    said = built(cluster, inputs, tmp_path / "out")
    assert said.startswith(f"factory: a node is given no work; node {cluster.address_of(8)}: ")
    assert said.endswith(" MB are free for temporary files, want 67\n")
    require_same(tmp_path / "out", undisturbed)


@pytest.fixture
def other_version(tmp_path_factory):
    """The package as it was before some change."""
    folder = tmp_path_factory.mktemp("other")
    package = Path(asset_factory.__file__).parent
    shutil.copytree(package, folder / "asset_factory", ignore=shutil.ignore_patterns("__pycache__"))
    init = folder / "asset_factory" / "__init__.py"
    text = init.read_text()
    init.write_text(text.replace(asset_factory.__version__, "0.0.9"))
    yield folder
    shutil.rmtree(folder)


def test_a_host_with_another_version_is_given_no_work(
    cluster, inputs, undisturbed, tmp_path, other_version
):
    cluster.start(6, sources=other_version)
    cluster.await_nodes(5)
    said = built(cluster, inputs, tmp_path / "out")
    here = f"asset-factory 0.0.9, here {asset_factory.__version__}"
    assert said == (
        f"factory: a node is given no work; node {cluster.address_of(6)}: it has {here}; "
        "install the same versions everywhere\n"
    )
    require_same(tmp_path / "out", undisturbed)
    for number in (2, 3, 4):
        cluster.kill(number)
    cluster.await_nodes(2)
    said = built(cluster, inputs, tmp_path / "none", code=2)
    assert said.endswith(
        f"no node of the cluster can be given work: node {cluster.address_of(6)}: "
        f"it has {here}; install the same versions everywhere\n"
    )
    assert Registry(tmp_path / "none").count() == 0


def test_a_slow_line(cluster, inputs, undisturbed, tmp_path):
    kind = cluster.slow_down(4)
    if not kind:
        pytest.skip("neither netem nor tbf in this kernel")
    built(cluster, inputs, tmp_path / "out")
    require_same(tmp_path / "out", undisturbed)
    if kind != "netem":
        pytest.skip("no netem in this kernel: the line was narrow, but neither late nor lossy")


def test_a_head_that_starts_anew(cluster, inputs, undisturbed, tmp_path):
    """It takes the cluster with it; the same command goes on over the new one."""
    # What workers have already they finish without a head: they shall not have all of it.
    for number in (3, 4):
        cluster.kill(number)
    cluster.await_nodes(2)
    built(cluster, inputs, tmp_path / "out", disturb=lambda: cluster.kill(1), code=1)
    finished = Registry(tmp_path / "out").count()
    assert 2 <= finished < Registry(undisturbed).count()
    cluster.kill(2)
    cluster.come_up(workers=3)
    built(cluster, inputs, tmp_path / "out")
    # Ray ended the first command at once: what it left is cleared as after any that died.
    collect_garbage(tmp_path / "out")
    require_same(tmp_path / "out", undisturbed)
