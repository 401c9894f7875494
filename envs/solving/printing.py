"""What ``factory solve`` shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rich.markup import escape
from rich.table import Column, Table

from asset_factory.factory.runtime.terminal import Terminal, complain

from .attempt import Attempt


class Progress:
    """A line on stderr for every joint that was tried."""

    def __init__(self) -> None:
        self._robot = ""
        self._total = 0
        self._number = 0

    def expect(self, robot: str, total: int) -> None:
        """Note that so many joints come next, for one robot."""
        self._robot = robot
        self._total = total
        self._number = 0

    def show(self, attempt: Attempt) -> None:
        """Tell of one."""
        self._number += 1
        count = f"[{self._robot} {self._number}/{self._total}]"
        complain(f"{count} {attempt.asset} {attempt.joint}: {_said(attempt)}")


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


def _said(attempt: Attempt) -> str:
    said = f"{attempt.reason}: {attempt.message}"
    if attempt.solved:
        said = f"solved in {attempt.steps} steps, with up to {attempt.peak_force:.0f} N"
    return f"{said} ({attempt.seconds:.0f} s)"
