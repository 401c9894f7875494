"""A Ray cluster: one that is running, or one of this machine's processors while needed."""

from __future__ import annotations

import os
import secrets
import shutil
import signal
import socket
import tempfile
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Any

from ...errors import AssetFactoryError, ConfigError

LOCAL = "local"
#: Shared memory of a cluster of one's own [bytes]: only small answers go through it.
OBJECT_STORE_BYTES = 80 * 1024**2
#: How long to wait for a cluster's address to answer at all [s].
CONNECT_S = 10.0
#: Nothing is told to anybody, no environment is rebuilt on nodes that have one, and in a cluster of
#: one's own work is no less urgent than without Ray, which would give way to everything else on the
#: machine.
SETTINGS = {
    "RAY_USAGE_STATS_ENABLED": "0",
    "RAY_ENABLE_UV_RUN_RUNTIME_ENV": "0",
    "RAY_worker_niceness": "0",
}
#: How Ray is told that a cluster is of this machine alone, and listens on its loopback address. It
#: reads this when it is imported.
LOOPBACK = {"RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER": "0"}


class ClusterLost(AssetFactoryError):
    """The cluster as a whole does not answer any more; a job begun again goes on where it was."""


@contextmanager
def connected(address: str, processors: int | None) -> Iterator[Any]:
    """Yield Ray, connected; disconnect afterwards, and end an own cluster.

    Args:
        address: ``local`` for a cluster of one's own; ``auto`` for the one that this machine
            belongs to, or ``host:port``.
        processors: of a cluster of one's own; all of them by default.

    Raises:
        ConfigError: Ray is not installed, or there is no cluster at that address.
    """
    if find_spec("ray") is None:
        raise ConfigError("Ray is not installed; `pip install 'asset-factory[ray]'` brings it")
    os.environ.update({name: value for name, value in SETTINGS.items() if name not in os.environ})
    own = address == LOCAL
    with _environment(LOOPBACK if own else {}):
        import ray
    if ray.is_initialized():
        yield ray
        return
    # Ray's sockets lie in here, and their paths may not be long.
    folder = tempfile.mkdtemp(prefix="ray-", dir="/tmp") if own else None
    settings: dict[str, Any] = {"log_to_driver": False, "logging_level": "error"}
    if own:
        settings |= {
            "num_cpus": processors,
            "include_dashboard": False,
            "object_store_memory": OBJECT_STORE_BYTES,
            "_temp_dir": folder,
        }
    _require_somebody(address)
    try:
        try:
            with _own_signals(), _environment({} if folder is None else _private(folder)):
                ray.init(address=address, **settings)
        except (ConnectionError, ValueError, RuntimeError) as error:
            raise ConfigError(f"no Ray cluster at {address!r}: {error}") from error
        yield ray
    finally:
        ray.shutdown()
        if folder is not None:
            shutil.rmtree(folder, ignore_errors=True)


@contextmanager
def _own_signals() -> Iterator[None]:
    """Keep Ray from having the job exit when it is told to end; how it ends is the job's affair."""
    before = signal.getsignal(signal.SIGTERM)
    yield
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, before)


def _private(folder: str) -> dict[str, str]:
    """Return the environment that a cluster of one's own is started in.

    Its processes keep temporary files in ``folder``: killed in the end, they remove none. They
    listen on the loopback address only, and to nobody but who knows a token that is written into no
    file; Ray's own would be readable by everybody. A token that the user gives stays.
    """
    if "RAY_AUTH_TOKEN_PATH" not in os.environ:
        # Kept, as Ray keeps the first token that a process tells it.
        os.environ.setdefault("RAY_AUTH_TOKEN", secrets.token_hex(32))
    return {**LOOPBACK, "TMPDIR": folder}


@contextmanager
def _environment(values: Mapping[str, str]) -> Iterator[None]:
    """Set environment variables of processes and imports within this."""
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def _require_somebody(address: str) -> None:
    """Refuse an address at which nobody listens; Ray would wait for minutes."""
    host, _, port = address.removeprefix("ray://").rpartition(":")
    if not (host and port.isdecimal()):
        return
    try:
        socket.create_connection((host, int(port)), CONNECT_S).close()
    except OSError as error:
        raise ConfigError(f"no Ray cluster at {address!r}: {error.strerror or error}") from error
