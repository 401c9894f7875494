"""Builds that die in a stage: the input's name says how."""

import ctypes
import os
from pathlib import Path

from job_samples import note

from asset_factory.factory.runtime.clock import Stopwatch


def dying(source: Path, **rest: object) -> None:
    """In place of a build."""
    note(source)
    clock = Stopwatch()
    with clock.stage("load"):
        pass
    stage = f"stage_{os.getpid()}" if "wanders" in source.name else "decompose"
    with clock.stage(stage), clock.stage("hulls"):
        pass
    with clock.stage(stage):
        if "ended" in source.name:
            os.kill(os.getpid(), 15)
        if "leaves" in source.name:
            os._exit(3)
        in_native_code()


def in_native_code() -> None:
    """Read where nothing is."""
    ctypes.string_at(0)
