"""A contact sheet: many assets on one PNG, each with its name and its verdict."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass

from PIL import Image, ImageDraw, ImageFont

COLUMNS = 6
CELL_WIDTH = 220
CELL_HEIGHT = 165
CAPTION = 34
GAP = 12
#: Assets on one sheet: what a picture can show.
MOST = 240
GROUND = (250, 250, 249)
INK = (32, 34, 38)
DIM = (112, 116, 122)
VERDICTS = {"passed": (34, 120, 74), "rejected": (190, 46, 40), "unjudged": (160, 108, 12)}


@dataclass(frozen=True)
class SheetCell:
    """One asset on the sheet: its picture (a file's bytes, empty for none), name and verdict."""

    picture: bytes
    name: str
    verdict: str
    told: str = ""


def contact_sheet(cells: Sequence[SheetCell]) -> bytes:
    """Return a PNG of up to :data:`MOST` assets, in order: the same cells give the same bytes."""
    shown = cells[:MOST]
    columns = max(1, min(COLUMNS, len(shown)))
    rows = max(1, -(-len(shown) // columns))
    size = (GAP + columns * (CELL_WIDTH + GAP), GAP + rows * (CELL_HEIGHT + CAPTION + GAP))
    sheet = Image.new("RGB", size, GROUND)
    draw = ImageDraw.Draw(sheet)
    for number, cell in enumerate(shown):
        left = GAP + (number % columns) * (CELL_WIDTH + GAP)
        top = GAP + (number // columns) * (CELL_HEIGHT + CAPTION + GAP)
        _draw(sheet, draw, cell, left, top)
    buffer = io.BytesIO()
    sheet.save(buffer, format="PNG", compress_level=6)
    return buffer.getvalue()


def _draw(
    sheet: Image.Image, draw: ImageDraw.ImageDraw, cell: SheetCell, left: int, top: int
) -> None:
    if cell.picture:
        with Image.open(io.BytesIO(cell.picture), formats=("WEBP",)) as opened:
            picture = opened.convert("RGBA")
        picture.thumbnail((CELL_WIDTH, CELL_HEIGHT), Image.Resampling.BOX)
        across = left + (CELL_WIDTH - picture.width) // 2
        down = top + (CELL_HEIGHT - picture.height) // 2
        sheet.paste(picture, (across, down), picture)
    color = VERDICTS.get(cell.verdict, DIM)
    middle = top + CELL_HEIGHT + 9
    draw.ellipse((left + 2, middle - 4, left + 10, middle + 4), fill=color)
    draw.text((left + 16, middle), _fitting(cell.name, 13), INK, _font(13), anchor="lm")
    draw.text((left + 16, middle + 15), _fitting(cell.told, 11), DIM, _font(11), anchor="lm")


def _font(size: int) -> ImageFont.ImageFont | ImageFont.FreeTypeFont:
    """Return the font that comes with Pillow: the same letters everywhere."""
    return ImageFont.load_default(size)


def _fitting(text: str, size: int) -> str:
    """Return as much of the text as fits into a cell."""
    font = _font(size)
    shown = "".join(letter if letter.isprintable() else " " for letter in text[:80])
    while font.getlength(shown) > CELL_WIDTH - 16:
        shown = shown.removesuffix("…")[:-1] + "…"
    return shown
