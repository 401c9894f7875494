"""The curves of a run: a table of numbers, and a picture of them."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.runtime.store import write_whole, writing


class Curve:
    """A table that grows by rows and starts with a step; texts, so equal runs give equal bytes.

    Rows after ``steps``, from before a run was cut off, are dropped.
    """

    def __init__(self, path: Path, columns: Sequence[str], steps: int) -> None:
        self._path = path
        header = ["step", *columns]
        before = (row for row in _read(path) if row[0].isdigit() and int(row[0]) <= steps)
        kept = [row for row in before if len(row) == len(header)]
        write_whole(path, _lines([header, *kept]))

    def add(self, rows: Iterable[tuple[int, Sequence[float]]]) -> None:
        """Append rows, each a step and its numbers, and make sure they are on the disk."""
        texts = [[str(step), *(f"{value:.9g}" for value in values)] for step, values in rows]
        with self._path.open("ab") as stream:
            stream.write(_lines(texts))
            stream.flush()
            os.fsync(stream.fileno())


def read_curve(path: Path) -> dict[str, list[float]]:
    """Return the columns of a table by name."""
    rows = _read(path)
    if not rows:
        return {}
    return {name: [float(row[at]) for row in rows[1:]] for at, name in enumerate(rows[0])}


def _read(path: Path) -> list[list[str]]:
    if not path.is_file():
        return []
    rows = [line.split(",") for line in path.read_text(encoding="utf-8").splitlines() if line]
    # A process that was killed may have left half a row.
    return [row for row in rows if len(row) == len(rows[0])]


def _lines(rows: Iterable[Sequence[str]]) -> bytes:
    return "".join(",".join(row) + "\n" for row in rows).encode()


def require_plotting() -> None:
    """Make sure curves can be drawn at the end, before hours are spent.

    Raises:
        ConfigError: says what to install.
    """
    try:
        import matplotlib  # noqa: F401
    except ImportError as error:
        wanted = "pip install 'asset-factory[train]'"
        raise ConfigError(f"curves are drawn with matplotlib: {wanted}") from error


def draw_curves(training: Path, validation: Path, target: Path) -> None:
    """Draw both tables as a PNG: losses on the left, held-out figures on the right."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12.0, 4.5), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2)
    curve = read_curve(training)
    for name in [name for name in curve if name not in ("step", "rate", "gradient")]:
        smooth = _smoothed(curve[name])
        if any(value > 0.0 for value in smooth):
            left.plot(curve["step"], smooth, label=name, linewidth=2.0 if name == "total" else 0.8)
    left.set(xlabel="step", ylabel="loss", yscale="log", title="training")
    held_out = read_curve(validation)
    for name in ("part_iou", "point_accuracy", "class_accuracy"):
        if held_out.get(name):
            right.plot(held_out["step"], held_out[name], marker=".", label=name)
    right.set(xlabel="step", ylim=(0.0, 1.0), title="held out")
    for axes in (left, right):
        axes.grid(alpha=0.3)
        if axes.get_legend_handles_labels()[0]:
            axes.legend(fontsize=7)
    with writing(target) as stream:
        figure.savefig(stream, dpi=110, format="png", metadata={"Software": None})


def _smoothed(values: Sequence[float], keep: float = 0.98) -> list[float]:
    """Return a running mean that starts at the first value."""
    found: list[float] = []
    for number, value in enumerate(values):
        share = min(keep, number / (number + 1.0))
        found.append(value if not found else share * found[-1] + (1.0 - share) * value)
    return found
