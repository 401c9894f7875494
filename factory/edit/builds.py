"""One build at a time, as a child process that can be killed."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from contextlib import suppress
from dataclasses import dataclass
from tempfile import TemporaryFile
from threading import Lock, Thread
from typing import IO

#: What a build that failed said last is shown, so much of it [bytes].
TAIL_BYTES = 2000
#: For the end of what a killed build prints [s].
PATIENCE_S = 10.0


@dataclass
class BuildRun:
    """A build, under way or ended.

    Attributes:
        process: of ``factory build``, leader of a group of its own.
        errors: what it complains of.
        asset: id of what it registered, or rejected; empty as long as there is none.
        said: why there is none, once it has ended without.
        stopped: whether it was killed.
        follower: reads what it prints.
    """

    process: subprocess.Popen[str]
    errors: IO[bytes]
    asset: str = ""
    said: str = ""
    stopped: bool = False
    follower: Thread | None = None


class Builds:
    """Runs ``factory build`` with the flags that a page was opened with.

    Args:
        arguments: of the command line, after ``factory``; with ``--json``.
    """

    def __init__(self, arguments: tuple[str, ...]) -> None:
        self._arguments = arguments
        self._lock = Lock()
        self._run: BuildRun | None = None

    @property
    def running(self) -> bool:
        """Tell whether the last build has no verdict yet."""
        run = self._run
        return run is not None and not (run.asset or run.said)

    @property
    def asset(self) -> str:
        """Return the id of what the last build gave; empty if there is none."""
        return self._run.asset if self._run is not None else ""

    @property
    def said(self) -> str:
        """Return why the last build gave nothing; empty if it did."""
        return self._run.said if self._run is not None else ""

    def start(self) -> None:
        """Begin a build; one that is under way is killed first."""
        with self._lock:
            self._kill()
            errors = TemporaryFile()  # noqa: SIM115 - closed by who follows the build
            process = subprocess.Popen(  # noqa: S603 - our own program
                [sys.executable, "-m", "asset_factory.factory.cli", *self._arguments],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=errors,
                text=True,
                start_new_session=True,
            )
            self._run = BuildRun(process, errors)
            self._run.follower = Thread(target=_follow, args=(self._run,), daemon=True)
            self._run.follower.start()

    def stop(self) -> None:
        """Kill the running build; finished assets are registered."""
        with self._lock:
            self._kill()

    def _kill(self) -> None:
        run = self._run
        if run is None or run.process.poll() is not None:
            return
        run.stopped = True
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(run.process.pid, signal.SIGKILL)
        run.process.wait()
        if run.follower is not None:
            # Its pipe closes when the last of its own children has noticed.
            run.follower.join(PATIENCE_S)


def _follow(run: BuildRun) -> None:
    """Read the summary of a build as soon as it is printed, before its pages are drawn."""
    printed = ""
    if run.process.stdout is not None:
        with run.process.stdout as lines:
            for line in lines:
                printed += line
                if line == "}\n":
                    run.asset = _built(printed)
    code = run.process.wait()
    if not run.asset:
        ended = f"It left with exit code {code}: {_tail(run.errors)}"
        run.said = "It was stopped." if run.stopped else ended
    run.errors.close()


def _built(printed: str) -> str:
    """Return the id of the one input of a summary; empty if it has none."""
    try:
        return str(json.loads(printed)["assets"][0]["id"])
    except (ValueError, LookupError, TypeError):
        return ""


def _tail(errors: IO[bytes]) -> str:
    size = errors.seek(0, os.SEEK_END)
    errors.seek(max(0, size - TAIL_BYTES))
    return errors.read().decode("utf-8", "replace").strip()
