"""Run native code where it can be killed: one child process, one answer, or a named failure."""

from __future__ import annotations

import ctypes
import multiprocessing
import os
import resource
import signal
import tempfile
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import Any, Generic, TypeVar

T = TypeVar("T")

OUTPUT_TAIL_BYTES = 4000
#: How long a child that closed its pipe may take to be gone, so that its true exit code is read [s].
GOODBYE_S = 2.0
PR_SET_PDEATHSIG = 1


@dataclass(frozen=True)
class Limits:
    """What a child may use.

    Attributes:
        wall_s: wall-clock time [s].
        cpu_s: processor time [s]; ``None`` for no limit of its own.
        memory_bytes: address space [bytes]; ``None`` for no limit. Renderers reserve far more than they use.
    """

    wall_s: float
    cpu_s: float | None = None
    memory_bytes: int | None = None


@dataclass(frozen=True)
class Outcome(Generic[T]):
    """What came of it.

    Attributes:
        value: the function's return value, when ``failure`` is ``None``.
        failure: ``None``, ``crashed`` (died of a signal or left without an answer), ``timeout`` or ``raised``.
        detail: a sentence for a report: the signal, the limit, or the exception.
        output: the end of what the child wrote to stdout and stderr, native code included.
        seconds: wall-clock time taken [s].
        error: the exception itself when ``failure`` is ``raised``.
    """

    value: T | None
    failure: str | None
    detail: str
    output: str
    seconds: float
    error: Exception | None = None

    def unwrap(self) -> T:
        """The value.

        Raises:
            Exception: what the function raised; RuntimeError with ``detail`` when the child died.
        """
        if self.error is not None:
            raise self.error
        if self.failure is not None:
            raise RuntimeError(f"{self.failure}: {self.detail}\n{self.output}".rstrip())
        return self.value  # type: ignore[return-value]


def preload(modules: tuple[str, ...]) -> None:
    """Have the fork server import some modules once, so that no child has to.

    Only effective before the first child is started; modules that are not installed are passed over.
    """
    multiprocessing.set_forkserver_preload(list(modules))


def run_isolated(function: Callable[..., T], *args: Any, limits: Limits) -> Outcome[T]:
    """Call ``function(*args)`` in a child process that may crash, hang or run out of memory.

    Args:
        function: importable by name (module level); its result and exceptions must pickle.
        *args: its arguments; they must pickle.
        limits: enforced by the kernel (CPU, memory) and by killing the child's process group (wall).

    Returns:
        An :class:`Outcome`; nothing that the child does raises here.
    """
    context = multiprocessing.get_context("forkserver")
    started = time.monotonic()
    with tempfile.NamedTemporaryFile(prefix="isolated-", suffix=".log") as log:
        receiver, sender = context.Pipe(duplex=False)
        process = context.Process(target=_child, args=(sender, log.name, function, args, limits))
        process.start()
        sender.close()
        answer, failure = _receive(receiver, limits.wall_s)
        receiver.close()
        if failure == "crashed":
            process.join(GOODBYE_S)
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid or 0, signal.SIGKILL)
        process.kill()
        process.join()
        exit_code = process.exitcode
        process.close()
        output = _tail(Path(log.name))
    seconds = time.monotonic() - started
    if failure is not None:
        return Outcome(None, failure, _failure_sentence(failure, exit_code, limits), output, seconds)
    kind, value = answer
    if kind == "value":
        return Outcome(value, None, "", output, seconds)
    return Outcome(None, "raised", f"{type(value).__name__}: {value}", output, seconds, error=value)


def _child(sender: Connection, log: str, function: Callable[..., Any], args: tuple[Any, ...], limits: Limits) -> None:
    os.setsid()
    _die_with_parents()
    descriptor = os.open(log, os.O_WRONLY | os.O_APPEND)
    os.dup2(descriptor, 1)
    os.dup2(descriptor, 2)
    os.close(descriptor)
    # OpenMP pools in many children would fight for the same few cores.
    os.environ["OMP_NUM_THREADS"] = "1"
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if limits.cpu_s is not None:
        seconds = max(1, int(limits.cpu_s))
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))
    if limits.memory_bytes is not None:
        resource.setrlimit(resource.RLIMIT_AS, (limits.memory_bytes, limits.memory_bytes))
    try:
        answer: tuple[str, Any] = ("value", function(*args))
    except Exception as error:  # noqa: BLE001 - whatever it was, the parent is told
        answer = ("error", error)
    try:
        sender.send(answer)
    except Exception as error:  # noqa: BLE001 - an answer that does not pickle is told as a sentence
        sender.send(("error", RuntimeError(f"{function.__name__}: {type(error).__name__}: {error}")))
    sender.close()


def _die_with_parents() -> None:
    """Leave no simulator running when the job, or the worker that asked for this child, is killed."""
    # The kernel's parent is the fork server, which ends with the whole job; Linux only, harmless elsewhere.
    with suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    threading.Thread(target=_follow_caller, daemon=True).start()


def _follow_caller() -> None:
    caller = multiprocessing.parent_process()
    if caller is not None:
        wait([caller.sentinel])
        os.killpg(os.getpid(), signal.SIGKILL)


def _receive(receiver: Connection, wall_s: float) -> tuple[Any, str | None]:
    if not receiver.poll(wall_s):
        return None, "timeout"
    try:
        return receiver.recv(), None
    except (EOFError, OSError):
        return None, "crashed"


def _failure_sentence(failure: str, exit_code: int | None, limits: Limits) -> str:
    if failure == "timeout":
        return f"no answer within {limits.wall_s:g} s"
    if exit_code is not None and exit_code < 0:
        name = signal.Signals(-exit_code).name
        if name in ("SIGXCPU", "SIGKILL") and limits.cpu_s is not None:
            return f"killed by {name}, as at its limit of {limits.cpu_s:g} s of processor time"
        return f"killed by {name}"
    return f"left with exit code {exit_code} and no answer"


def _tail(path: Path) -> str:
    size = path.stat().st_size
    with path.open("rb") as file:
        file.seek(max(0, size - OUTPUT_TAIL_BYTES))
        return file.read().decode("utf-8", "replace").strip()
