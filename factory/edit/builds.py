"""One build at a time, as a child process that can be killed."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from contextlib import suppress
from tempfile import TemporaryFile
from threading import Lock, Thread
from typing import IO

#: What a build that failed said last is shown, so much of it [bytes].
TAIL_BYTES = 2000
#: For the end of what a killed build prints [s].
PATIENCE_S = 10.0


class BuildRun:
    """A build, under way or ended.

    Args:
        arguments: of the command line, after ``factory``; with ``--json``.

    Attributes:
        asset: id of what it registered, or rejected; empty as long as there is none.
        said: why there is none, once it has ended without.
    """

    def __init__(self, arguments: tuple[str, ...]) -> None:
        self.asset = ""
        self.said = ""
        self._stopped = False
        self._errors = TemporaryFile()  # noqa: SIM115 - closed by who follows the build
        # Leader of a group of its own.
        self._process = subprocess.Popen(  # noqa: S603 - our own program
            [sys.executable, "-m", "asset_factory.factory.cli", *arguments],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            text=True,
            start_new_session=True,
        )
        self._follower = Thread(target=self._follow, daemon=True)
        self._follower.start()

    def stop(self) -> None:
        """Kill it, if it runs; finished assets are registered."""
        if self._process.poll() is not None:
            return
        self._stopped = True
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()
        # Its pipe closes when the last of its own children has noticed.
        self._follower.join(PATIENCE_S)

    def _follow(self) -> None:
        """Read the summary as soon as it is printed, before its pages are drawn."""
        printed = ""
        assert self._process.stdout is not None, "it is a pipe"  # noqa: S101
        with self._process.stdout as lines:
            for line in lines:
                printed += line
                if line == "}\n":
                    self.asset = _built(printed)
        code = self._process.wait()
        if not self.asset:
            ended = f"It left with exit code {code}: {_tail(self._errors)}"
            self.said = "It was stopped." if self._stopped else ended
        self._errors.close()


class Builds:
    """Runs ``factory build`` with the flags that a page was opened with; arguments as there.

    Attributes:
        last: the last build; ``None`` before the first.
    """

    def __init__(self, arguments: tuple[str, ...]) -> None:
        self.last: BuildRun | None = None
        self._arguments = arguments
        self._lock = Lock()

    def start(self) -> None:
        """Begin a build; one that is under way is killed first."""
        with self._lock:
            if self.last is not None:
                self.last.stop()
            self.last = BuildRun(self._arguments)

    def stop(self) -> None:
        """Kill the running build; finished assets are registered."""
        with self._lock:
            if self.last is not None:
                self.last.stop()


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
