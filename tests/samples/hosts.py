"""Hosts on this machine: network namespaces with addresses of their own, that share no /tmp."""

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

_PORT = 26379
_TOKEN = "0123456789abcdef0123456789abcdef"  # noqa: S105 - of a cluster that lives for one test
#: Ray's own of a node; small, for only small answers go through it [bytes].
_STORE = "--object-store-memory=80000000"
_COMES_UP_S = 90.0
#: A worker that starts under the address of one that died just now may be refused.
_TRIES = 8
#: A node that does not answer for so long is dead to the others.
_IMPATIENT = {
    "RAY_health_check_initial_delay_ms": "2000",
    "RAY_health_check_period_ms": "1000",
    "RAY_health_check_timeout_ms": "2000",
    "RAY_health_check_failure_threshold": "4",
}
_PROJECT = Path(__file__).resolve().parents[2]
#: A host's own /tmp; what the head has of its own is empty there, whether it lies in /tmp or not.
#: A package of its own, and this project if it lies in /tmp, are kept, for reading.
_OWN_FILES = """
set -e
mount -t tmpfs none /mnt
keep() {
    mkdir "/mnt/$1"
    mount --bind "$2" "/mnt/$1"
}
give_back() {
    mkdir -p "$2"
    mount --bind "/mnt/$1" "$2"
    mount -o remount,ro,bind "$2"
    umount "/mnt/$1"
}
if [ -n "$SOURCES" ]; then keep sources "$SOURCES"; fi
case "$PROJECT" in /tmp/*) keep project "$PROJECT" ;; esac
mount -t tmpfs -o "size=$ROOM" none /tmp
case "$PROJECT" in /tmp/*) give_back project "$PROJECT" ;; esac
mkdir -p "$HIDDEN"
mount -t tmpfs -o size=1m none "$HIDDEN"
if [ -n "$SOURCES" ]; then give_back sources "$SOURCES"; fi
umount /mnt
exec "$@"
"""


class Hosts:
    """A head and workers, joined by a bridge.

    Args:
        hidden: a folder that no worker sees.
        folder: for the head's own files; its path is short.

    Attributes:
        head: the head's address.
        address: of the Ray cluster.
    """

    def __init__(self, hidden: Path, folder: Path) -> None:
        # Another one in every process, so that two test runs do not meet.
        number = os.getpid() % 250
        self.head = f"10.77.{number}.1"
        self.address = f"{self.head}:{_PORT}"
        self._hidden = hidden
        self._folder = folder
        self._tag = f"af{number}"
        self._hosts: dict[int, subprocess.Popen[bytes]] = {}
        self._networks: set[int] = set()
        _run("ip", "link", "add", self._tag, "type", "bridge")
        _run("ip", "address", "add", f"{self.head}/24", "dev", self._tag)
        _run("ip", "link", "set", self._tag, "up")

    def start_head(self) -> None:
        """Ray's head, which does no work itself."""
        more = ["--head", f"--port={_PORT}", f"--node-ip-address={self.head}", "--num-cpus=0"]
        more += [f"--temp-dir={self._folder}", "--include-dashboard=false"]
        self._hosts[1] = self._started(more, (), {})

    def start(self, number: int, *, room: str = "50%", sources: Path | None = None) -> None:
        """A worker of one processor, from 2 on; one that died comes back under its address.

        Args:
            number: the last one of its address.
            room: of its /tmp, as tmpfs is told.
            sources: of another version of the package.
        """
        name = self._name(number)
        if number not in self._networks:
            self._networks.add(number)
            self._connect(number, name)
        own = ("ip", "netns", "exec", name, "unshare", "--mount", "sh", "-c", _OWN_FILES, "own")
        more = [f"--address={self.address}", f"--node-ip-address={self.address_of(number)}"]
        told = {"ROOM": room, "SOURCES": str(sources or "")}
        told |= {} if sources is None else {"PYTHONPATH": str(sources)}
        self._hosts[number] = self._started([*more, "--num-cpus=1"], own, told)

    def come_up(self, workers: int) -> None:
        """The head and so many workers, with the environment as it is now."""
        self.start_head()
        self.await_nodes(1)
        for number in range(2, 2 + workers):
            self.start(number)
        self.await_nodes(1 + workers)

    def address_of(self, number: int) -> str:
        """A worker's own."""
        return f"{self.head.rpartition('.')[0]}.{number}"

    def await_nodes(self, count: int, seconds: float = _COMES_UP_S) -> None:
        """Until so many nodes are in the cluster, the head counted."""
        asked = (
            "import ray, sys; ray.init(sys.argv[1], log_to_driver=False, logging_level='error'); "
        )
        asked += "print(sum(node['Alive'] for node in ray.nodes()))"
        until = time.monotonic() + seconds
        told = ""
        while time.monotonic() < until:
            command = [sys.executable, "-c", asked, self.address]
            try:
                done = subprocess.run(
                    command, capture_output=True, text=True, check=False, timeout=_COMES_UP_S
                )
            except subprocess.TimeoutExpired:
                continue
            told = done.stdout.strip() or done.stderr[-300:]
            if told == str(count):
                return
            time.sleep(1.0)
        raise AssertionError(f"{count} nodes did not come up: {told}")

    def restore(self, workers: int) -> None:
        """Start what died, end what is too much, until there are the head and so many workers."""
        wanted = range(2, 2 + workers)
        for number in set(self._hosts) - {1, *wanted}:
            self.kill(number)
        for _ in range(_TRIES):
            for number in wanted:
                if number in self._hosts and self._hosts[number].poll() is not None:
                    self.kill(number)
                if number not in self._hosts:
                    self.start(number)
            with suppress(AssertionError):
                return self.await_nodes(1 + workers, seconds=10.0)
        raise AssertionError(f"{workers} workers did not come up")

    def kill(self, number: int) -> None:
        """As if somebody pulled the plug."""
        process = self._hosts.pop(number)
        for pid in _pids_in(self._name(number)) if number > 1 else _below(process.pid):
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()

    def files_on(self, number: int, folder: Path) -> list[str]:
        """What a worker sees in a folder, beside this project."""
        pid = _pids_in(self._name(number))[0]
        listing = ["nsenter", f"--target={pid}", "--mount", "find", folder]
        listing += ["-path", str(_PROJECT), "-prune", "-o", "-type", "f", "-print"]
        told = subprocess.run(listing, capture_output=True, text=True, check=True)
        return told.stdout.split()

    def confine(self, number: int, group: Path) -> None:
        """Put all of a worker's processes into a control group; what they start is in it too."""
        for pid in _pids_in(self._name(number)):
            with suppress(ProcessLookupError):
                (group / "cgroup.procs").write_text(str(pid))

    def fill_disk(self, number: int) -> None:
        """Write to a worker's /tmp until there is no room left."""
        pid = _pids_in(self._name(number))[0]
        write = ["dd", "if=/dev/zero", "of=/tmp/filler", "bs=1M"]
        inside = ["nsenter", f"--target={pid}", "--mount", *write]
        subprocess.run(inside, check=False, capture_output=True)

    def slow_down(self, number: int) -> str:
        """Give a worker a slow line, both ways; says what kind."""
        late = ["netem", "delay", "100ms", "20ms", "loss", "1%", "rate", "8mbit"]
        narrow = ["tbf", "rate", "8mbit", "burst", "16kbit", "latency", "500ms"]
        here = ["tc", "qdisc", "add", "dev", f"{self._tag}v{number}", "root"]
        there = ["ip", "netns", "exec", self._name(number), "tc", "qdisc", "add", "dev", "eth0"]
        for kind in (late, narrow):
            try:
                _run(*here, *kind)
            except subprocess.CalledProcessError:
                continue
            _run(*there, "root", *kind)
            return kind[0]
        return ""

    def cut_off(self, number: int, *, back: bool = False) -> None:
        """Pull a worker's network cable, or put it back in."""
        _run("ip", "link", "set", f"{self._tag}v{number}", "up" if back else "down")

    def close(self) -> None:
        """Nothing of it is left."""
        for number in sorted(self._hosts, reverse=True):
            self.kill(number)
        for number in self._networks:
            _run("ip", "netns", "delete", self._name(number))
        _run("ip", "link", "delete", self._tag)

    def _name(self, number: int) -> str:
        return f"{self._tag}n{number}"

    def _connect(self, number: int, name: str) -> None:
        here = f"{self._tag}v{number}"
        address = f"{self.address_of(number)}/24"
        _run("ip", "netns", "add", name)
        _run("ip", "link", "add", here, "type", "veth", "peer", "name", "eth0", "netns", name)
        _run("ip", "link", "set", here, "master", self._tag, "up")
        _run("ip", "-n", name, "address", "add", address, "dev", "eth0")
        _run("ip", "-n", name, "link", "set", "eth0", "up")
        _run("ip", "-n", name, "link", "set", "lo", "up")

    def _started(
        self, more: list[str], own: tuple[str, ...], told: dict[str, str]
    ) -> subprocess.Popen[bytes]:
        ray = str(Path(sys.executable).with_name("ray"))
        command = [*own, ray, "start", *more, _STORE, "--block", "--disable-usage-stats"]
        environment = {**os.environ, **_IMPATIENT, "HIDDEN": str(self._hidden), **told}
        environment["PROJECT"] = str(_PROJECT)
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        return subprocess.Popen(command, env=environment, start_new_session=True, **quiet)


@contextmanager
def hosts(hidden: Path, folder: Path) -> Iterator[Hosts]:
    """Joined, and none of them up yet. Skips, with a word, where the kernel says no."""
    for program in ("ip", "nsenter", "tc", "unshare"):
        if shutil.which(program) is None:
            pytest.skip(f"no {program} here: apt-get install iproute2 util-linux")
    try:
        made = Hosts(hidden, folder)
    except subprocess.CalledProcessError as refused:
        pytest.skip(f"no network namespaces here: {refused.stderr.strip()}")
    with pytest.MonkeyPatch.context() as environment:
        environment.setenv("RAY_AUTH_MODE", "token")
        environment.setenv("RAY_AUTH_TOKEN", _TOKEN)
        environment.setenv("RAY_USAGE_STATS_ENABLED", "0")
        environment.setenv("RAY_worker_niceness", "0")
        try:
            yield made
        finally:
            made.close()


def _pids_in(namespace: str) -> list[int]:
    command = ["ip", "netns", "pids", namespace]
    told = subprocess.run(command, capture_output=True, text=True, check=False)
    return [int(pid) for pid in told.stdout.split()]


def _below(pid: int) -> list[int]:
    """All that a process started, and what that started."""
    parents: dict[int, list[int]] = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            parent = int(stat.read_text().rpartition(")")[2].split()[1])
            parents.setdefault(parent, []).append(int(stat.parent.name))
    found = [pid]
    for each in found:
        found += parents.get(each, [])
    return found[1:]


def _run(*command: str) -> None:
    subprocess.run(command, check=True, capture_output=True, text=True)
