"""The process that holds the network for a job, and its socket: bounded in all that it takes."""

from __future__ import annotations

import os
import shutil
import socket
import tempfile
import threading
import time
from contextlib import suppress
from functools import partial
from pathlib import Path

from asset_factory.sim_checks.processes.isolation import Failure, Limits, WarmChild, processors
from asset_factory.sim_checks.processes.scratch import sockets

from ...config import ParticulateConfig
from ...runtime.store import digest_file
from ..particulate.device import device_for
from ..particulate.loading import load_network, weight_files
from ..weights.sources import fetch
from .answering import Answer, Answering, LoadedNetwork, identity_of
from .asking import Address
from .wire import WireError, receive, send

#: Askers at a time; the next one is turned away, and asks its own network.
MOST_ASKERS = 256
#: Longest that a question may take to arrive, and an answer to be taken [s].
PATIENCE_S = 30.0
#: Longest life [s]; a week is as good as for ever, and a number that every kernel can wait for.
LIFE_S = 7 * 86400.0
#: Deaths within a minute of the start, in a row, after which it is given up.
MOST_DEATHS = 3
YOUNG_S = 60.0


def listening_socket(path: str) -> socket.socket:
    """Return a socket that accepts askers on return, of this user only; replaces a dead one's."""
    with suppress(FileNotFoundError):
        os.unlink(path)
    listening = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    mask = os.umask(0o177)
    try:
        listening.bind(path)
    finally:
        os.umask(mask)
    listening.listen(MOST_ASKERS)
    return listening


def answer_all(listening: socket.socket, answer: Answer, most_askers: int = MOST_ASKERS) -> None:
    """Answer one question per asker, each in its own thread, until the socket is closed."""
    places = threading.BoundedSemaphore(most_askers)
    while True:
        try:
            asker, _ = listening.accept()
        except OSError:
            return
        if not places.acquire(blocking=False):
            asker.close()
            continue
        threading.Thread(target=_answer_one, args=(asker, answer, places), daemon=True).start()


def _answer_one(asker: socket.socket, answer: Answer, places: threading.BoundedSemaphore) -> None:
    try:
        with asker, suppress(OSError, WireError):
            reply = answer(receive(asker, time.monotonic() + PATIENCE_S))
            send(asker, reply, time.monotonic() + PATIENCE_S)
    finally:
        places.release()


class ModelService:
    """One network for all workers of a job; a context manager.

    Whoever asks while it is dead waits for the next one, and asks a network of its own once it is
    given up.
    """

    def __init__(self, config: ParticulateConfig) -> None:
        self._config = config
        self._folder = Path(tempfile.mkdtemp(prefix="model-", dir=sockets()))
        self._stopping = threading.Event()
        self._child = WarmChild()
        self._keeper = threading.Thread(target=self._keep, name="model-service", daemon=True)

    def __enter__(self) -> ModelService:
        self._keeper.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stopping.set()
        self._child.abandon()
        self._keeper.join()
        shutil.rmtree(self._folder, ignore_errors=True)

    @property
    def address(self) -> Address:
        """Return where it is asked; good from the start, also before it listens."""
        return Address(str(self._folder / "socket"))

    @property
    def pid(self) -> int | None:
        """Return the number of its process; ``None`` while there is none."""
        return self._child.pid

    def _keep(self) -> None:
        deaths = 0
        while not self._stopping.is_set() and deaths < MOST_DEATHS:
            started = time.monotonic()
            limits = Limits(wall_s=LIFE_S)
            outcome = self._child.call(serve, self._config, self.address.path, limits=limits)
            self._child.close()
            if outcome.failure is Failure.RAISED:
                break
            deaths = deaths + 1 if time.monotonic() - started < YOUNG_S else 1
        # Without its folder nobody waits for it any more.
        shutil.rmtree(self._folder, ignore_errors=True)


def serve(config: ParticulateConfig, path: str) -> None:
    """Answer at a socket for ever; the main of the service's process."""
    answer_all(listening_socket(path), Answering(partial(load_named, config)))


def load_named(config: ParticulateConfig) -> LoadedNetwork:
    """Return the network that a configuration names, ready for questions.

    It works on as many clouds at the same time as there are processors, on another device on one.

    Raises:
        ConfigError: it cannot be loaded.
    """
    at_once = processors() if device_for(config.device) == "cpu" else 1
    digests = tuple(digest_file(fetch(file)) for file in weight_files(config))
    places = threading.BoundedSemaphore(at_once)
    return LoadedNetwork(load_network(config), identity_of(config, digests), places)
