"""Run native code in a child process that can be killed: an answer or a named failure per call."""

from __future__ import annotations

import math
import multiprocessing
import os
import resource
import shutil
import signal
import tempfile
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from enum import StrEnum
from multiprocessing.context import ForkServerProcess
from multiprocessing.reduction import ForkingPickler
from pathlib import Path
from typing import Any, Generic, TypeVar

from .child import LOG_NAME, Answer, serve
from .place import place_in
from .scratch import scratch
from .threads import one_thread

T = TypeVar("T")

OUTPUT_TAIL_BYTES = 4000
#: How long a child that closed its pipe may take to be gone, so that its true exit code is read
#: [s].
GOODBYE_S = 2.0

#: The usual reason is a script that asks while it is imported: every child imports the script that
#: asks.
UNBORN = (
    "its process did not start; work that asks belongs under if __name__ == '__main__' in a script"
)
#: What a child has for an exit code whose fork server is gone, and with it everybody it had
#: started.
ORPHANED = 255
#: What a process dies of by itself; of others, somebody asked it to end.
FAULTS = (signal.SIGSEGV, signal.SIGABRT, signal.SIGBUS, signal.SIGFPE, signal.SIGILL)


@dataclass(frozen=True)
class Limits:
    """What a child may use.

    Attributes:
        wall_s: wall-clock time [s].
        cpu_s: processor time [s]; ``None`` for no limit of its own.
        memory_bytes: address space [bytes]; ``None`` for no limit. Renderers reserve far more than
            they use.
        until: when it ends, however little of ``wall_s`` is over [s since 1970].
    """

    wall_s: float
    cpu_s: float | None = None
    memory_bytes: int | None = None
    until: float = math.inf


class Failure(StrEnum):
    """How a call failed."""

    CRASHED = "crashed"
    """Its process died of a signal, or left without an answer."""
    TIMEOUT = "timeout"
    RAISED = "raised"


@dataclass(frozen=True)
class Outcome(Generic[T]):
    """What came of it.

    Attributes:
        value: the function's return value, when ``failure`` is ``None``.
        failure: how there is no value.
        detail: a sentence for a report: the signal, the limit, or the exception.
        output: the end of what the child wrote to stdout and stderr, native code included.
        seconds: wall-clock time taken [s].
        error: the exception itself when ``failure`` is ``raised``.
        tries: how often it was asked before this was believed.
        killed: whether somebody else made an end of the child, which says nothing of the function.
        exited: whether the child left by itself without an answer: the program is at fault.
        deaths: where it was each time that its process died of what it did; see :func:`~.place.at`.
    """

    value: T | None
    failure: Failure | None
    detail: str
    output: str
    seconds: float
    error: Exception | None = None
    tries: int = 1
    killed: bool = False
    exited: bool = False
    deaths: tuple[str, ...] = ()

    def unwrap(self) -> T:
        """Return the value.

        Raises:
            Exception: what the function raised; RuntimeError with ``detail`` when the child died.
        """
        if self.error is not None:
            raise self.error
        if self.failure is not None:
            raise RuntimeError(f"{self.failure}: {self.detail}\n{self.output}".rstrip())
        return self.value  # type: ignore[return-value]


def processors() -> int:
    """Return how many this process may use: as many children are worth running at once."""
    return max(1, len(os.sched_getaffinity(0)))


def preload(modules: tuple[str, ...]) -> None:
    """Have the fork server import some modules once, so that no child has to.

    Only effective before the first child is started; modules that are not installed are passed
    over.
    """
    multiprocessing.set_forkserver_preload(list(modules))


def run_isolated(function: Callable[..., T], *args: Any, limits: Limits) -> Outcome[T]:
    """Call ``function(*args)`` in a child process that may crash, hang or run out of memory.

    Args:
        function: importable by name (module level); its result and exceptions must pickle.
        *args: its arguments; they must pickle.
        limits: enforced by the kernel (CPU, memory) and by killing the child's process group
            (wall).

    Returns:
        An :class:`Outcome`; nothing that the child does raises here.
    """
    with WarmChild() as child:
        return child.call(function, *args, limits=limits)


class WarmChild:
    """A child process that is asked again and again, so that what it imported is paid for once.

    A verdict must not depend on earlier questions, nor on somebody who kills processes: a call
    that fails in a child that has answered others, or whose child was killed, is made once more, in
    a new child, and only that outcome counts. A ValueError is no failure but an answer: the
    subject is bad. Not for several threads at once, but for :meth:`abandon`.
    """

    def __init__(self, calls: int | None = None, resident_bytes: int | None = None) -> None:
        """Keep the settings; the process starts with the first call.

        Args:
            calls: a new child is started after so many; ``None`` for never.
            resident_bytes: and when one holds more memory than this after a call [bytes].
        """
        self._calls = calls
        self._resident_bytes = resident_bytes
        self._process: _Process | None = None
        self._abandoned = False

    def __enter__(self) -> WarmChild:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def pid(self) -> int | None:
        """Return the process that the next call would ask; ``None`` if that would be a new one."""
        return self._process.pid if self._process is not None else None

    @property
    def place(self) -> str:
        """Return where its work is now; empty if it has none, or none that is named."""
        process = self._process
        return "" if process is None else place_in(process.folder)

    def close(self) -> None:
        """Kill the child and whatever it started; the next call would start a new one."""
        # Forgotten before it ends: once it has, its number may be another process's.
        process = self._process
        self._process = None
        if process is not None:
            process.end()

    def abandon(self) -> None:
        """Kill the child, from any thread; a call in progress ends as ``crashed``, no retry."""
        self._abandoned = True
        process = self._process
        if process is not None:
            process.kill()

    def call(
        self, function: Callable[..., T], /, *args: Any, limits: Limits, **named: Any
    ) -> Outcome[T]:
        """Call like :func:`run_isolated`, in this child; the limits are this call's own."""
        used = self._process is not None
        question = (function, args, named, limits)
        outcome: Outcome[T] = self._ask(question, limits)
        failed = outcome.failure is not None and not isinstance(outcome.error, ValueError)
        if failed and (used or outcome.killed) and not self._abandoned:
            self.close()
            again = self._ask(question, limits)
            outcome = replace(again, tries=2, deaths=(*outcome.deaths, *again.deaths))
        if self._process is not None and self._is_spent(self._process):
            self.close()
        return outcome

    def _ask(self, asked: object, limits: Limits) -> Outcome[Any]:
        started = time.monotonic()
        question = ForkingPickler.dumps(asked)
        if self._process is None:
            self._process = _born()
        process = self._process
        if self._abandoned:
            process.kill()
        answer = process.ask(question, max(0.0, min(limits.wall_s, limits.until - time.time())))
        if isinstance(answer, Failure):
            self._process = None
            return self._lost(process, answer, limits, started)
        output = process.output()
        seconds = time.monotonic() - started
        if answer.error is None:
            return Outcome(answer.value, None, "", output, seconds)
        detail = _exception_sentence(answer.error, limits)
        return Outcome(None, Failure.RAISED, detail, output, seconds, error=answer.error)

    def _lost(
        self, process: _Process, failure: Failure, limits: Limits, started: float
    ) -> Outcome[Any]:
        """Return the outcome of a child that gave no answer."""
        crashed = failure is Failure.CRASHED
        unborn = crashed and not process.has_started
        exit_code, output, place = process.end(GOODBYE_S if crashed else 0.0)
        killed = crashed and exit_code in (-signal.SIGKILL, ORPHANED)
        left = crashed and exit_code is not None and 0 <= exit_code < ORPHANED
        faulted = crashed and exit_code is not None and -exit_code in FAULTS
        detail = UNBORN if unborn and not killed else _failure_sentence(failure, exit_code, limits)
        return Outcome(
            value=None,
            failure=failure,
            detail=detail,
            output=output,
            seconds=time.monotonic() - started,
            killed=killed,
            exited=left,
            deaths=(place,) if left or faulted else (),
        )

    def _is_spent(self, process: _Process) -> bool:
        most = self._resident_bytes
        asked_enough = self._calls is not None and process.answered >= self._calls
        return asked_enough or (most is not None and _resident_bytes(process.pid) > most)


def _born() -> _Process:
    try:
        return _Process()
    except (EOFError, ConnectionError):
        # The fork server was killed just now; with the next process comes the next server.
        return _Process()


class _Process:
    """One life of a child: its process, its pipe and its folder."""

    def __init__(self) -> None:
        context = multiprocessing.get_context("forkserver")
        self.folder = Path(tempfile.mkdtemp(prefix="isolated-", dir=scratch()))
        self._log = self.folder / LOG_NAME
        self._connection, theirs = context.Pipe()
        ends = (theirs, str(self.folder))
        self._process: ForkServerProcess = context.Process(target=serve, args=ends)
        try:
            # The fork server, which starts with the first child, is where libraries are loaded.
            with one_thread():
                self._process.start()
        except BaseException:
            self._connection.close()
            shutil.rmtree(self.folder, ignore_errors=True)
            raise
        finally:
            theirs.close()
        self.pid = self._process.pid or 0
        self.answered = 0

    def ask(self, question: bytes | memoryview, wall_s: float) -> Answer | Failure:
        """Return its answer, or how there is none."""
        if self.answered:
            os.truncate(self._log, 0)
        self.answered += 1
        try:
            self._connection.send_bytes(question)
            if not self._connection.poll(wall_s):
                return Failure.TIMEOUT
            answer: Answer = self._connection.recv()
        except (EOFError, OSError):
            return Failure.CRASHED
        except Exception as error:  # noqa: BLE001 - some exceptions pickle and do not unpickle
            detail = f"its answer cannot be read: {type(error).__name__}: {error}"
            return Answer(error=RuntimeError(detail))
        return answer

    def kill(self) -> None:
        """Kill it and all that it started; whoever waits for its answer hears that it crashed."""
        # Before it has made a group of its own there is only itself.
        for kill in (os.killpg, os.kill):
            with suppress(ProcessLookupError, PermissionError):
                kill(self.pid, signal.SIGKILL)

    @property
    def has_started(self) -> bool:
        """Return whether it came so far as to listen to questions."""
        return self._log.exists()

    def output(self) -> str:
        """Return the end of the output during the last question."""
        if not self.has_started:
            return ""
        with self._log.open("rb") as file:
            file.seek(max(0, self._log.stat().st_size - OUTPUT_TAIL_BYTES))
            return file.read().decode("utf-8", "replace").strip()

    def end(self, patience_s: float = 0.0) -> tuple[int | None, str, str]:
        """Kill it and all that it started; leave nothing behind.

        Args:
            patience_s: for a child that is dying anyway, whose own exit code is wanted [s].

        Returns:
            Its exit code, the end of its output, and where it was in its work.
        """
        self._connection.close()
        if patience_s:
            self._process.join(patience_s)
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(self.pid, signal.SIGKILL)
        self._process.kill()
        self._process.join()
        told = self._process.exitcode, self.output(), place_in(self.folder)
        self._process.close()
        shutil.rmtree(self.folder, ignore_errors=True)
        return told


def _failure_sentence(failure: Failure, exit_code: int | None, limits: Limits) -> str:
    if failure is Failure.TIMEOUT:
        return f"no answer within {limits.wall_s:g} s"
    if exit_code == ORPHANED:
        return "killed by SIGKILL, or what had started it was"
    if exit_code is not None and exit_code < 0:
        name = signal.Signals(-exit_code).name
        if name in ("SIGXCPU", "SIGKILL") and limits.cpu_s is not None:
            return f"killed by {name}, as at its limit of {limits.cpu_s:g} s of processor time"
        return f"killed by {name}"
    return f"left with exit code {exit_code} and no answer"


def _exception_sentence(error: Exception, limits: Limits) -> str:
    if isinstance(error, MemoryError) and limits.memory_bytes is not None:
        space = f"{limits.memory_bytes / 2**30:.3g} GiB of address space"
        return f"ran out of memory, with {space} to use"
    return f"{type(error).__name__}: {error}"


def _resident_bytes(pid: int) -> int:
    """Return the memory held now [bytes]; 0 where the kernel does not say."""
    try:
        return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * resource.getpagesize()
    except OSError:
        return 0
