"""Builds over several hosts that share no disk but the inputs: the registry of an undisturbed run.

The hosts are network namespaces with addresses and a /tmp of their own; assets come back through a
real S3 server, over TCP.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import pytest
import trimesh
from hosts import hosts
from s3_server import BUCKET, s3_server

from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.verify import verify
from asset_factory.factory.runtime.store import folder_digests

pytest.importorskip("ray")
pytestmark = [
    pytest.mark.cluster,
    pytest.mark.filterwarnings("ignore:subprocess .* is still running:ResourceWarning"),
    pytest.mark.filterwarnings("ignore:unclosed:ResourceWarning"),
]
FLAGS = ("--articulator", "rigid", "--sim", "mujoco", "--no-report", "--quiet")
COUNT = 10


@pytest.fixture(scope="module")
def inputs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("meshes")
    for number in range(COUNT):
        trimesh.creation.box((0.3 + 0.05 * number, 0.4, 0.5)).export(folder / f"box_{number}.stl")
    (folder / "nothing.stl").write_bytes(b"solid nothing\nendsolid nothing\n")
    return folder


@pytest.fixture(scope="module")
def undisturbed(inputs, tmp_path_factory):
    output = tmp_path_factory.mktemp("local") / "out"
    assert begun(inputs, output, "--workers", "1").wait() == 0
    return output


def begun(inputs, output, *more):
    """The command, in a process of its own: Ray reads the environment once and for all."""
    command = [sys.executable, "-m", "asset_factory.factory.cli", "build", *FLAGS, *more]
    command += ["--input", inputs, "--output", output]
    return subprocess.Popen(command)


@pytest.fixture(scope="module")
def cluster(inputs):
    # Ray's sockets lie in it, and their paths may not be long.
    with (
        tempfile.TemporaryDirectory(prefix="hosts-", dir="/tmp", ignore_cleanup_errors=True) as own,
        hosts(inputs, Path(own)) as made,
        s3_server(made.head),
    ):
        import fsspec

        fsspec.filesystem("s3", skip_instance_cache=True).mkdir(BUCKET)
        made.come_up(workers=3)
        yield made


def built(cluster, inputs, output, disturb=None):
    """Build over the hosts; what disturbs it happens after the first two inputs."""
    Registry(output, create=True)
    more = ["--executor", "ray", "--ray-address", cluster.address]
    process = begun(inputs, output, *more, "--ray-exchange", f"s3://{BUCKET}/between")
    if disturb is not None:
        while Registry(output).count() < 2 and process.poll() is None:
            time.sleep(0.05)
        assert process.poll() is None, "it was over before it was disturbed"
        disturb()
    assert process.wait(300.0) == 0


def require_same(output, undisturbed):
    for folder in ("assets", "rejected"):
        assert folder_digests(output / folder) == folder_digests(undisturbed / folder)
    assert tuple(Registry(output).entries()) == tuple(Registry(undisturbed).entries())
    assert verify(Registry(output)) == ()
    assert not list((output / ".staging").iterdir())
    assert not list((output / ".claims").iterdir())


def test_the_registry_is_that_of_one_host(cluster, inputs, undisturbed, tmp_path):
    built(cluster, inputs, tmp_path / "out")
    assert Registry(undisturbed).count() == COUNT + 1
    require_same(tmp_path / "out", undisturbed)


def test_a_host_that_dies_in_the_middle(cluster, inputs, undisturbed, tmp_path):
    built(cluster, inputs, tmp_path / "out", disturb=lambda: cluster.kill(2))
    require_same(tmp_path / "out", undisturbed)
    cluster.start(2)
    cluster.await_nodes(4)


def test_a_host_that_is_cut_off_for_a_while(cluster, inputs, undisturbed, tmp_path):
    back = threading.Timer(30.0, lambda: cluster.cut_off(3, back=True))

    def disturb():
        cluster.cut_off(3)
        back.start()

    built(cluster, inputs, tmp_path / "out", disturb=disturb)
    back.join()
    require_same(tmp_path / "out", undisturbed)


def test_hosts_that_join_and_leave(cluster, inputs, undisturbed, tmp_path):
    cluster.start(5)

    def disturb():
        cluster.kill(4)

    built(cluster, inputs, tmp_path / "out", disturb=disturb)
    require_same(tmp_path / "out", undisturbed)
