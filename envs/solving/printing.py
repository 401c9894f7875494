"""What ``factory solve`` shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rich.markup import escape
from rich.table import Column, Table

from asset_factory.factory.runtime.terminal import Terminal, complain

from .attempt import Attempt


def show_attempt(number: int, total: int, attempt: Attempt) -> None:
    """Print a line to standard error on one of so many joints that a robot tried."""
    said = f"{attempt.reason}: {attempt.message}"
    if attempt.solved:
        said = f"solved in {attempt.steps} steps, with up to {attempt.peak_force:.0f} N"
    what = f"[{attempt.robot} {number}/{total}] {attempt.asset} {attempt.joint}"
    complain(f"{what}: {said} ({attempt.seconds:.0f} s)")


def print_table(attempts: Mapping[str, Sequence[Mapping[str, Any]]]) -> None:
    """Print all attempts, by asset."""
    console = Terminal()
    for asset, rows in attempts.items():
        # An id stands alone in its line, whole however narrow the terminal is.
        console.print(escape(asset), style="bold", soft_wrap=True)
        joint = Column("joint", overflow="fold")
        table = Table(joint, "robot", "opened", "how", "steps", "peak N", "mean N", "why not")
        for row in rows:
            colour = "green" if row["solved"] else "red"
            table.add_row(
                escape(row["joint"]),
                row["robot"],
                f"[{colour}]{row['open_fraction']:.0%}[/]",
                " ".join(row["kinds"]),
                str(row["steps"]),
                f"{row['peak_force_n']:.0f}",
                f"{row['mean_force_n']:.1f}",
                "" if row["solved"] else escape(f"{row['reason']}: {row['message']}"),
            )
        console.print(table)
