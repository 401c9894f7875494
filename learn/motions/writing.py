"""What was fitted, as the configuration file that the evidence reads."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from asset_factory.factory.articulate.evidence.numbers import NAMES
from asset_factory.factory.articulate.evidence.rating import Rating
from asset_factory.factory.articulate.evidence.setting import SLIDE_SETTING, TURN_SETTING
from asset_factory.factory.articulate.evidence.usual import Usual
from asset_factory.factory.mesh import FloatArray

from .fitting import Fitted

HEAD = """\
# How the evidence for a part's motion weighs, and how far parts go: see rating.py and usual.py in
# factory/articulate/evidence/. In ratings each number of the evidence has a row: its weights into
# the hidden units, then its direct weight. "guided" is for parts whose motion somebody guessed,
# "blind" for parts of which only the faces are known. Ranges are shares of belief over values, in
# radians, and in lengths of what slides. Made by python -m asset_factory.learn.motions;
# nothing here is set by hand.
"""


def motions_text(fitted: Fitted) -> str:
    """Return the file, TOML; the same for the same weights."""
    blocks = [
        HEAD,
        _rating("guided", fitted.guided),
        _rating("blind", fitted.blind),
        _usual("turn_range", fitted.turn_range, TURN_SETTING),
        _usual("slide_range", fitted.slide_range, SLIDE_SETTING),
    ]
    return "\n".join(blocks)


def _rating(name: str, rating: Rating) -> str:
    rows = np.column_stack([rating.inner, rating.direct])
    lines = [
        f"[{name}]",
        f"sure = {_row(np.array(rating.sure))}",
        f"offset = {_row(rating.offset)}",
        f"outer = {_row(rating.outer)}",
    ]
    return "\n".join([*lines, *_named(name, NAMES, rows)])


def _usual(name: str, usual: Usual, names: Sequence[str]) -> str:
    lines = [
        f"[{name}]",
        f"values = {_row(usual.values, 4)}",
        f"offset = {_row(usual.offset)}",
        f"base = {_row(usual.base)}",
        "outer = [",
        *(f"    {_row(column)}," for column in usual.outer.T),
        "]",
    ]
    return "\n".join([*lines, *_named(name, names, usual.inner)])


def _named(table: str, names: Sequence[str], rows: FloatArray) -> list[str]:
    return [
        "",
        f"[{table}.numbers]",
        *(f"{name} = {_row(row)}" for name, row in zip(names, rows, strict=True)),
        "",
    ]


def _row(values: FloatArray, digits: int = 3) -> str:
    """Return the rounded; never a minus nothing."""
    return (
        "["
        + ", ".join(
            "inf" if np.isinf(v) else f"{round(float(v), digits) + 0.0:.{digits}f}" for v in values
        )
        + "]"
    )
