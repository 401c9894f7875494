"""The sheet that somebody is shown: an object's sides, with a grid to read boxes off."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

from ...mesh import Mesh
from ...views.raster import Side
from .drawing import Picture, count_lines, drawn_oblique, drawn_side

if TYPE_CHECKING:
    from PIL import Image, ImageDraw

#: Free cells of the sheet [pixels]: of the front, and of the other sides.
LARGE = 470
SMALL = 330
#: Around each picture, for its name and the numbers of its grid.
EDGE = 36
#: From so many pixels on there is room for a number at each tenth.
ROOMY = 220
INK = (25, 25, 25)
#: Of the grid: no seam has this colour.
GRID = (0, 150, 255, 140)
UPRIGHT = (Side.FRONT, Side.LEFT, Side.RIGHT, Side.BACK)
#: Another side than the front is shown large if it has so many times its lines.
TELLS_MORE = 1.5


def sheet_of(mesh: Mesh) -> bytes:
    """Return a PNG of a mesh whose front is -Y; the same mesh gives the same bytes.

    Above the upright side that shows most, coloured and shaded, and an oblique view of it; below
    the other sides and the top, coloured and shaded. A grid of tenths lies over each side.
    """
    from PIL import Image, ImageDraw

    width = 4 * (SMALL + 2 * EDGE)
    sheet = Image.new("RGB", (width, LARGE + 2 * SMALL + 6 * EDGE), "white")
    draw = ImageDraw.Draw(sheet, "RGBA")
    third = width // 3
    main = largest_side(mesh)
    colored, shaded = drawn_side(mesh, main, LARGE, LARGE)
    _put(sheet, draw, colored, f"{main.upper()}, coloured", EDGE, 0)
    _put(sheet, draw, shaded, f"{main.upper()}, shaded", third + EDGE, 0)
    oblique = drawn_oblique(mesh, main, LARGE, LARGE)
    _put(sheet, draw, oblique, "oblique, from above", 2 * third + EDGE, 0, grid=False)
    others = [side for side in UPRIGHT if side is not main]
    for number, side in enumerate((*others, Side.TOP)):
        left = number * (SMALL + 2 * EDGE) + EDGE
        for row, picture in enumerate(drawn_side(mesh, side, SMALL, SMALL)):
            top = LARGE + 2 * EDGE + row * (SMALL + 2 * EDGE)
            how = "shaded" if row else "coloured"
            back_up = ", back is up" if side is Side.TOP else ""
            _put(sheet, draw, picture, f"{side.upper()}, {how}{back_up}", left, top)
    buffer = io.BytesIO()
    sheet.save(buffer, format="PNG", compress_level=6)
    return buffer.getvalue()


def largest_side(mesh: Mesh) -> Side:
    """Return the upright side that is shown large: the front, unless another has far more on it."""
    lines = {side: count_lines(mesh, side, SMALL) for side in UPRIGHT}
    most = max(UPRIGHT, key=lambda side: lines[side])
    return most if lines[most] > TELLS_MORE * lines[Side.FRONT] else Side.FRONT


def _put(
    sheet: Image.Image,
    draw: ImageDraw.ImageDraw,
    picture: Picture,
    name: str,
    left: int,
    top: int,
    *,
    grid: bool = True,
) -> None:
    """Put a picture with its name above, and a grid of tenths over it."""
    from PIL import Image, ImageFont

    top += EDGE // 2 + 4
    rows, columns = picture.shape[:2]
    sheet.paste(Image.fromarray(picture), (left, top))
    draw.text((left, top - 3), name, INK, ImageFont.load_default(14), anchor="ld")
    if not grid:
        return
    small = ImageFont.load_default(11)
    for tenth in range(11):
        column = left + round(tenth * (columns - 1) / 10)
        row = top + rows - 1 - round(tenth * (rows - 1) / 10)
        draw.line((column, top, column, top + rows - 1), GRID)
        draw.line((left, row, left + columns - 1, row), GRID)
        number = f"{tenth / 10:g}"
        if columns >= ROOMY or tenth % 2 == 0:
            draw.text((column, top + rows + 2), number, INK, small, anchor="ma")
        if rows >= ROOMY / 2 or tenth % 2 == 0:
            draw.text((left - 4, row), number, INK, small, anchor="rm")
