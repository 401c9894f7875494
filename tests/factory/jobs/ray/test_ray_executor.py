"""A real cluster on this machine: every call has one answer, whatever happens to its processes.

Children and nodes may die. A cluster of one's own is this machine's affair: loopback ports, a token
that no file holds.
"""

import json
import os
import signal
import sys
import threading
import time
from pathlib import Path

import pytest
import ray  # noqa: TID253
import ray_calls
from command_line import ran
from repository import SAMPLES
from waiting import until

import asset_factory
from asset_factory.factory.config import ParticulateConfig
from asset_factory.factory.errors import ConfigError
from asset_factory.factory.jobs.executor import AHEAD, Call
from asset_factory.factory.jobs.ray.cluster import SETTINGS
from asset_factory.factory.jobs.ray.executor import RayExecutor
from asset_factory.sim_checks.processes.isolation import Limits

LIMITS = Limits(wall_s=60.0)
pytestmark = [
    # Ray starts its processes and never waits for them; its own sockets are left to the collector.
    pytest.mark.filterwarnings("ignore:subprocess .* is still running:ResourceWarning"),
    pytest.mark.filterwarnings("ignore:unclosed:ResourceWarning"),
]


@pytest.fixture(scope="module", autouse=True)
def _nodes_find_the_calls():
    with pytest.MonkeyPatch.context() as patch:
        folders = (SAMPLES, Path(asset_factory.__file__).parent.parent)
        patch.setenv("PYTHONPATH", os.pathsep.join(map(str, folders)))
        for name, value in SETTINGS.items():
            patch.setenv(name, value)
        yield


def alive(*names):
    """Processes of Ray's on this machine, by name."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            words = (folder / "cmdline").read_bytes().decode().split("\0")
        except OSError:
            continue
        if any(name in words[0] for name in names):
            found.append(int(folder.name))
    return found


def test_calls_on_a_cluster_of_its_own_are_answered_as_locally():
    before = set(alive("raylet", "gcs_server"))
    taken = []

    def calls():
        for name in ("raise", "crash", *"abcdef"):
            taken.append(name)
            yield Call(name, {"how": name})

    outcomes = {}
    ahead = 0
    told_to_end = signal.getsignal(signal.SIGTERM)
    for call, outcome in RayExecutor(workers=1).run(ray_calls.behave, calls(), LIMITS):
        assert call.name not in outcomes
        outcomes[call.name] = outcome
        ahead = max(ahead, len(taken) - len(outcomes))
        assert signal.getsignal(signal.SIGTERM) is told_to_end
    assert [outcomes.pop(name).value for name in "abcdef"] == list("abcdef")
    assert outcomes["raise"].detail == "LookupError: nothing there"
    assert (outcomes["crash"].failure, outcomes["crash"].detail) == ("crashed", "killed by SIGSEGV")
    assert outcomes["crash"].tries == 2
    assert ahead <= AHEAD
    assert not ray.is_initialized()
    until(lambda: set(alive("raylet", "gcs_server")) <= before)


def test_calls_that_nobody_wants_any_more_never_begin_and_running_ones_end(tmp_path):
    log = str(tmp_path)

    def wanted():
        return not any(tmp_path.iterdir())

    asked = {"seconds": 4.0, "log": log}
    calls = [Call(str(number), {"number": number, **asked}, wanted=wanted) for number in (2, 3)]
    made = RayExecutor(workers=1).run(ray_calls.slow_square, calls, LIMITS)
    outcomes = {call.name: (outcome.value, outcome.failure) for call, outcome in made}
    assert outcomes == {"2": (4, None), "3": (None, None)}
    assert [path.name[0] for path in tmp_path.iterdir()] == ["2"]


def test_no_cluster_at_an_address_is_said():
    with pytest.raises(ConfigError, match="no Ray cluster at 'nowhere"):
        list(RayExecutor(address="nowhere:1").run(ray_calls.square, [], LIMITS))


@pytest.fixture(scope="module")
def cluster():
    """Two nodes, with a processor each; one has what it calls a GPU."""
    from ray.cluster_utils import Cluster

    small = {"num_cpus": 1, "object_store_memory": 80 * 1024**2}
    made = Cluster(
        initialize_head=True, head_node_args={**small, "num_gpus": 1, "include_dashboard": False}
    )
    made.second = made.add_node(**small)
    made.wait_for_nodes()
    yield made
    ray.shutdown()
    made.shutdown()


@pytest.mark.full
def test_a_node_that_dies_costs_no_call_and_no_answer_comes_twice(cluster, tmp_path):
    killed = threading.Event()

    def kill_once_both_work():
        while len({path.name.split("-")[1] for path in tmp_path.iterdir()}) < 2:
            time.sleep(0.05)
        cluster.remove_node(cluster.second, allow_graceful=False)
        killed.set()

    killer = threading.Thread(target=kill_once_both_work, daemon=True)
    killer.start()
    asked = {"seconds": 1.0, "log": str(tmp_path)}
    calls = [Call(str(number), {"number": number, **asked}) for number in range(12)]
    ran = RayExecutor(address=cluster.address).run(ray_calls.slow_square, calls, LIMITS)
    answers = {call.name: outcome.value for call, outcome in ran}
    assert killed.is_set()
    assert answers == {str(number): number * number for number in range(12)}
    begun = [path.name.split("-")[0] for path in tmp_path.iterdir()]
    assert len(begun) > len(set(begun)), "something was under way on the node that died"


@pytest.mark.full
@pytest.mark.parametrize("device", ["cpu", "cpu:0"])
def test_calls_ask_the_network_of_their_node_or_that_of_the_gpu(cluster, device):
    # The second name is the same device, and one that has to be placed.
    config = ParticulateConfig(device=device)
    own = ray_calls.answer(config, "nobody is asked")
    executor = RayExecutor(address=cluster.address, network=config)
    calls = [Call(str(number), {"config": config, "address": None}) for number in range(4)]
    for _, outcome in executor.run(ray_calls.answer, calls, LIMITS):
        said, at_home, path = outcome.unwrap()
        assert said == own[0]
        assert not at_home, "the node's network was asked"
    assert not Path(path).parent.exists()


@pytest.mark.full
def test_closing_the_stream_kills_what_is_under_way(cluster, tmp_path):
    calls = [
        Call(
            str(number),
            {"number": number, "seconds": 300.0 if number else 0.0, "log": str(tmp_path)},
        )
        for number in range(4)
    ]
    stream = RayExecutor(address=cluster.address).run(ray_calls.slow_square, calls, LIMITS)
    next(stream)
    until(lambda: any(path.name.startswith("1-") for path in tmp_path.iterdir()))
    pids = [int(path.name.split("-")[1]) for path in tmp_path.iterdir()]
    stream.close()
    until(lambda: not any(Path(f"/proc/{pid}").exists() for pid in pids))


SCRIPT = """
import json, os
from asset_factory.factory.jobs.ray.cluster import LOCAL, connected

with connected(LOCAL, 1) as ray:
    import psutil

    def answered():
        return os.environ["RAY_AUTH_MODE"], len(os.environ["RAY_AUTH_TOKEN"])

    told = ray.get(ray.remote(answered).remote())
    family = [psutil.Process(), *psutil.Process().children(recursive=True)]
    addresses = {
        connection.laddr.ip.removeprefix("::ffff:")
        for process in family
        for connection in process.net_connections("inet")
        if connection.status == psutil.CONN_LISTEN
    }
    print(json.dumps({"told": told, "addresses": sorted(addresses)}))
"""


def test_a_cluster_of_ones_own_listens_to_this_machine_and_this_job_only(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    for name in ("RAY_AUTH_MODE", "RAY_AUTH_TOKEN", "RAY_AUTH_TOKEN_PATH"):
        monkeypatch.delenv(name, raising=False)
    told = json.loads(ran(sys.executable, "-c", SCRIPT))
    assert told == {"told": ["token", 64], "addresses": ["127.0.0.1"]}
    assert not (tmp_path / ".ray").exists()
