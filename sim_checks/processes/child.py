"""The child's side of isolation: answer questions within limits until the caller is gone."""

from __future__ import annotations

import ctypes
import faulthandler
import math
import multiprocessing
import os
import resource
import signal
import sys
import tempfile
import threading
import time
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.reduction import ForkingPickler
from pathlib import Path
from typing import Any

from .place import keep_place, leave_places
from .threads import use_one_thread

PR_SET_PDEATHSIG = 1
LOG_NAME = "output.log"


@dataclass(frozen=True)
class Answer:
    """What a call gave: its value, or the exception that it raised."""

    value: Any = None
    error: Exception | None = None


def serve(connection: Connection, folder: str) -> None:
    """Answer ``(function, args, named, limits)`` with an :class:`Answer` until the caller is gone.

    Args:
        connection: to the caller.
        folder: the child's own, removed by the caller: its output goes to a log there, its
            temporary files too.
    """
    os.setsid()
    _die_with_parents()
    _write_to(Path(folder) / LOG_NAME)
    keep_place(Path(folder))
    # What native code dies of is told with the lines of Python that led there.
    faulthandler.enable(all_threads=False)
    os.environ["TMPDIR"] = tempfile.tempdir = folder
    # For what is not loaded yet, should the fork server be one that somebody else started.
    use_one_thread()
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with suppress(EOFError, OSError):
        while True:
            _answer(connection)
    os.killpg(os.getpid(), signal.SIGKILL)


def _answer(connection: Connection) -> None:
    """Answer one question; raise EOFError or OSError when the caller is gone."""
    question = connection.recv_bytes()
    leave_places()
    try:
        function, args, named, limits = ForkingPickler.loads(question)
        _limit(limits.cpu_s, limits.memory_bytes)
        answer = Answer(function(*args, **named))
    except Exception as error:  # noqa: BLE001 - whatever it was, the caller is told
        answer = Answer(error=error)
    _limit(None, None)
    # What this call wrote must not turn up in the next one's output.
    sys.stdout.flush()
    sys.stderr.flush()
    ctypes.CDLL(None).fflush(None)
    try:
        packed = ForkingPickler.dumps(answer)
    except Exception as error:  # noqa: BLE001 - an answer that does not pickle is told as a sentence
        detail = f"the answer does not pickle: {error}"
        packed = ForkingPickler.dumps(Answer(error=RuntimeError(detail)))
    connection.send_bytes(packed)


def _limit(cpu_s: float | None, memory_bytes: int | None) -> None:
    """Set soft limits only: a hard one could not be lifted again for the next call."""
    used = math.ceil(time.process_time())
    _soft_limit(resource.RLIMIT_CPU, None if cpu_s is None else used + max(1, int(cpu_s)))
    _soft_limit(resource.RLIMIT_AS, memory_bytes)


def _soft_limit(kind: int, value: int | None) -> None:
    _, hard = resource.getrlimit(kind)
    wanted = hard if value is None else value
    soft = wanted if hard == resource.RLIM_INFINITY else min(wanted, hard)
    resource.setrlimit(kind, (soft, hard))


def _write_to(log: Path) -> None:
    descriptor = os.open(log, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o600)
    os.dup2(descriptor, 1)
    os.dup2(descriptor, 2)
    os.close(descriptor)


def _die_with_parents() -> None:
    """Leave no simulator running when the job, or the worker that asked, is killed."""
    # The kernel's parent is the fork server, which ends with the whole job; Linux only, harmless
    # elsewhere.
    with suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    threading.Thread(target=_follow_caller, daemon=True).start()


def _follow_caller() -> None:
    caller = multiprocessing.parent_process()
    if caller is not None:
        wait([caller.sentinel])
        os.killpg(os.getpid(), signal.SIGKILL)
