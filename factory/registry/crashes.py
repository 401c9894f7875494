"""The report of an input whose process died, and whether it would die again."""

from __future__ import annotations

import re
from typing import Any

from asset_factory.sim_checks.processes.isolation import Failure, Outcome

from ..errors import RegistryError
from .product import Product
from .registry import Registry
from .report_file import read_report

#: Reason of a death that may have been bad luck, and of one that came twice.
ONCE = "build_crashed"
ALWAYS = "crashed"
#: Where a report has it, under ``measurements``.
_CRASH = "crash"
_FRAME = re.compile(r'^  File "(?P<file>[^"]+)", line (?P<line>\d+) in (?P<function>\S+)$', re.M)
#: Of a file's path: machines have it in different places.
_NAMES_KEPT = 3
_MOST_FRAMES = 30


def crash_stage(registry: Registry, asset_id: str, outcome: Outcome[Product]) -> str:
    """Return the stage in which an input died the last two times; empty if it did not."""
    if outcome.failure is not Failure.CRASHED or outcome.killed or not outcome.deaths:
        return ""
    stages = [_earlier_stage(registry, asset_id), *outcome.deaths]
    return stages[-1] if stages[-1] == stages[-2] else ""


def sentence(outcome: Outcome[Product], stage: str) -> str:
    """Tell how an input ended without a product, how often, and where it died each time."""
    times = f", {outcome.tries} times" if outcome.tries > 1 else ""
    lines = trace(outcome.output)[:1] if stage else ()
    where = f"; each time in stage {stage!r}" if stage else ""
    return f"{outcome.detail}{times}{where}{''.join(f', at {line}' for line in lines)}"


def crash_measurements(outcome: Outcome[Product]) -> dict[str, Any]:
    """Return what the report says of a death: its stage, and the lines that led there."""
    if not any(outcome.deaths):
        return {}
    return {_CRASH: {"stage": outcome.deaths[-1], "trace": list(trace(outcome.output))}}


def trace(output: str) -> tuple[str, ...]:
    """Return the lines of Python in which a process died, the innermost first, without paths."""
    return tuple(
        f"{'/'.join(found['file'].split('/')[-_NAMES_KEPT:])}:{found['line']} {found['function']}"
        for found in _FRAME.finditer(output)
    )[:_MOST_FRAMES]


def _earlier_stage(registry: Registry, asset_id: str) -> str:
    """Return where an earlier job's process died last; empty if it did not."""
    entry = registry.find(asset_id)
    if entry is None or entry.reason not in (ONCE, ALWAYS):
        return ""
    try:
        told = read_report(registry.folder(entry)).data["measurements"]
        return str(told[_CRASH]["stage"])
    except (RegistryError, KeyError, TypeError):
        return ""
