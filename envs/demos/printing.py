"""What ``factory demos`` shows and sums up."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import asdict
from typing import Any

from rich.markup import escape
from rich.table import Column, Table

from asset_factory.factory.runtime.terminal import Terminal, complain

from .episodes import VERSION, Settings, Taken


def show_episode(count: int, total: int, taken: Taken, seconds: float) -> None:
    """Print a line to standard error."""
    episode = taken.episode
    how = f"{taken.steps} steps" if taken.success else f"{taken.reason}: {taken.message}"
    where = f"{episode.asset} {episode.joint} seed {episode.seed}"
    complain(f"[{count}/{total}] {where}: {how} ({seconds:.0f} s)")


def sum_up(taken: Iterable[Taken], settings: Settings) -> dict[str, Any]:
    """Return ``summary.json``: episodes, successes, and by joint why the others failed."""
    joints: dict[tuple[str, str], list[Taken]] = {}
    for each in taken:
        joints.setdefault((each.episode.asset, each.episode.joint), []).append(each)
    rows = [_row(asset, joint, each) for (asset, joint), each in joints.items()]
    return {
        "version": VERSION,
        "settings": asdict(settings),
        "episodes": sum(row["episodes"] for row in rows),
        "successes": sum(row["successes"] for row in rows),
        "trajectories": sum(row["trajectories"] for row in rows),
        "steps": sum(row["steps"] for row in rows),
        "joints": rows,
    }


def _row(asset: str, joint: str, taken: list[Taken]) -> dict[str, Any]:
    return {
        "asset": asset,
        "joint": joint,
        "episodes": len(taken),
        "successes": sum(each.success for each in taken),
        "trajectories": sum(each.info is not None for each in taken),
        "steps": sum(each.steps for each in taken if each.info is not None),
        "reasons": dict(sorted(Counter(each.reason for each in taken if each.reason).items())),
        "message": next((each.message for each in taken if each.reason), ""),
    }


def print_summary(summary: dict[str, Any]) -> None:
    """Print a row per joint."""
    named = [Column(name, overflow="fold") for name in ("asset", "joint")]
    table = Table(*named, "episodes", "successes", "steps", "why not")
    for row in summary["joints"]:
        colour = "yellow" if row["successes"] else "red"
        if row["successes"] == row["episodes"]:
            colour = "green"
        reasons = ", ".join(f"{reason} {count}" for reason, count in row["reasons"].items())
        why = f"{reasons}: {row['message']}" if reasons else ""
        table.add_row(
            escape(row["asset"]),
            escape(row["joint"]),
            str(row["episodes"]),
            f"[{colour}]{row['successes']}[/]",
            str(row["steps"]),
            escape(why),
        )
    Terminal().print(table)
