"""What people see of an evaluation: progress, and a table per grouping."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from rich.markup import escape
from rich.progress import track
from rich.table import Table

from asset_factory.factory.runtime.terminal import Terminal

from ..evaluate.files import CSV_NAME, JSON_NAME
from ..evaluate.trial import Row

Column = tuple[str, str, str, str, int]
#: Characters of the columns that say which row it is, of a number, and of a column's frame.
ROW_WIDTH = 52
NUMBER_WIDTH = 5
COLUMN_FRAME = 3
#: Heading, where the number is, its name, which statistic, decimals.
COLUMNS: dict[str, tuple[Column, ...]] = {
    "physical": (
        ("part mIoU", "values", "part_miou", "", 3),
        ("moved IoU", "values", "articulated_iou", "", 3),
        ("at 2 %", "values", "articulated_iou_strict", "", 3),
        ("recall", "parts", "recall", "of_objects", 2),
        ("precision", "parts", "precision", "of_objects", 2),
        ("joint right", "parts", "joint_right", "of_objects", 2),
        ("type", "parts", "type_of_all", "of_objects", 2),
        ("axis 5°", "parts", "axis_of_all", "of_objects", 2),
        ("place 5 %", "parts", "place_of_all", "of_objects", 2),
        ("2 %", "parts", "place_of_all_strict", "of_objects", 2),
        ("found: type", "parts", "type_accuracy", "of_objects", 2),
        ("axis [deg] mean", "parts", "axis_angle_deg", "mean", 1),
        ("median", "parts", "axis_angle_deg", "median", 1),
        ("offset median", "parts", "axis_offset", "median", 3),
        ("right way", "parts", "opens_right_way", "of_objects", 2),
        ("range [rad] median", "parts", "range_error_rad", "median", 2),
        ("[size] median", "parts", "range_error_size", "median", 3),
        ("left fixed", "parts", "left_fixed", "of_objects", 2),
        ("still moved", "parts", "still_moved", "of_objects", 2),
    ),
    "published": tuple(
        (
            name.replace("articulated_", "moved ").replace("_matched", " matched"),
            "values", name, "", 4,
        )
        for name in (
            "giou", "miou", "pc", "oc", "giou_matched", "pc_matched",
            "articulated_giou", "articulated_miou", "articulated_pc", "articulated_oc",
            "articulated_giou_matched", "articulated_pc_matched",
        )
    ),
}  # fmt: skip


def followed(rows: Iterable[Row], total: int) -> list[Row]:
    """Collect rows as they come, with a progress bar on a terminal; failures are told at once."""
    console = Terminal(stderr=True)
    if console.is_terminal:
        rows = track(rows, "evaluating", total=total, console=console)
    collected = []
    for row in rows:
        collected.append(row)
        if row.failure:
            told = f"{row.trial.method.name}: {row.trial.request.name}: {row.failure}"
            console.print(told, markup=False, soft_wrap=True)
    return collected


def print_summary(data: dict[str, Any], output: Path) -> None:
    """Print tables of what :func:`~asset_factory.learn.evaluate.files.write_results` wrote."""
    console = Terminal()
    # A pipe or a log file has no width; a table squeezed into 80 columns there could not be read.
    console = console if console.is_terminal else Terminal(width=240)
    known = COLUMNS["physical" if data["settings"]["convention"] == "physical" else "published"]
    columns = _fitting(known, console.width)
    for by in dict.fromkeys(entry["by"] for entry in data["summary"]):
        entries = [entry for entry in data["summary"] if entry["by"] == by]
        table = Table(by, "method", "cases", "failed", *(escape(column[0]) for column in columns))
        for entry in entries:
            numbers = [_shown(entry, column) for column in columns]
            counts = str(entry["objects"]), str(entry["failures"])
            table.add_row(escape(entry["group"]), entry["method"], *counts, *numbers)
        console.print(table)
    if data["paired"]:
        console.print(_paired(data["paired"]))
    if len(columns) < len(known):
        more = f"{len(known) - len(columns)} more columns in {JSON_NAME}, or in a wider terminal"
        console.print(more, markup=False)
    console.print(f"{output / JSON_NAME}   {output / CSV_NAME}", soft_wrap=True, markup=False)


def _fitting(columns: tuple[Column, ...], width: int) -> tuple[Column, ...]:
    """Return the first of the columns that fit beside those that say what a row is about."""
    taken = ROW_WIDTH
    for count, (heading, *_) in enumerate(columns):
        taken += max(NUMBER_WIDTH, *(len(word) for word in heading.split())) + COLUMN_FRAME
        if taken > width:
            return columns[:count]
    return columns


def _paired(entries: list[dict[str, Any]]) -> Table:
    table = Table("where both found joints", "cases", "method", "mean", "method", "mean")
    for entry in entries:
        one, other = (f"{entry[f'{who}_mean']:.3f}" for who in ("one", "other"))
        cases = str(entry["objects"])
        table.add_row(entry["figure"], cases, entry["one"], one, entry["other"], other)
    return table


def _shown(entry: dict[str, Any], column: tuple[str, str, str, str, int]) -> str:
    _, where, name, statistic, digits = column
    number = entry[where].get(name)
    if statistic and number is not None:
        number = number[statistic]
    if number is None:
        return "-"
    spread = entry.get("spread", {}).get(name) if statistic in ("", "of_objects") else None
    return f"{number:.{digits}f}" + ("" if spread is None else f" ±{spread:.{digits}f}")
