"""Numbers as text: short, and the same for the same value on every machine."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from xml.etree import ElementTree

from ..mesh import FloatArray
from ..runtime.numbers import DECIMALS, magnitude, rounded

#: Texture coordinates and unit normals.
DECIMALS_UNIT = 6


def number(value: float, decimals: int = DECIMALS) -> str:
    """Return the shortest text that reads back as ``value`` rounded to ``decimals``."""
    return repr(rounded(value, decimals)).removesuffix(".0")


def vector(values: Iterable[float], decimals: int = DECIMALS) -> str:
    """Return several :func:`number` with spaces between, as URDF and MJCF want them."""
    return " ".join(number(value, decimals) for value in values)


def vectors(word: str, rows: FloatArray, decimals: int = DECIMALS) -> list[str]:
    """Return a line for each row: a word and its :func:`number`, for tables of many rows."""
    values = rows.ravel().tolist()
    flat = [repr(round(value, decimals) + 0.0).removesuffix(".0") for value in values]
    columns = [flat[start :: rows.shape[1]] for start in range(rows.shape[1])]
    return [" ".join(line) for line in zip([word] * len(rows), *columns, strict=True)]


def scientific(values: Iterable[float]) -> str:
    """Return several :func:`magnitude` as text, with spaces between."""
    return " ".join(repr(magnitude(value)).removesuffix(".0") for value in values)


def write_text(file: Path, text: str) -> None:
    """Write a file of the same bytes on every system."""
    file.write_text(text, encoding="utf-8", newline="\n")


def xml_text(root: ElementTree.Element) -> str:
    """Return an indented XML document with a final newline."""
    ElementTree.indent(root)
    return f'<?xml version="1.0"?>\n{ElementTree.tostring(root, encoding="unicode")}\n'
