"""README's pictures: generated meshes, closed, open and as convex hulls; a robot opens a cabinet.

make demo
factory solve cabinet --joint door_1_hinge --robot panda --video
factory build --input examples/generated --output generated/
python docs/picture.py generated/ out/     writes docs/pictures/made.png and robot.webp
"""

from __future__ import annotations

import sys
from pathlib import Path

import imageio.v2 as imageio
from PIL import Image, ImageDraw, ImageFont

from asset_factory.factory.display.camera import Viewpoint
from asset_factory.factory.display.casting import Caster, Shot
from asset_factory.factory.display.described import scene_of_file
from asset_factory.factory.display.glb import read_model, scene_from
from asset_factory.factory.display.pictures import Pixels, tinted
from asset_factory.factory.display.scene import SceneGraph
from asset_factory.factory.display.shading import still

DOCS = Path(__file__).resolve().parent
OBJECTS = ("chest", "fridge", "filing_cabinet")
CAPTIONS = ("as generated: one piece", "parts and joints, closed", "open", "convex hulls")
CELL = (250, 210)
CAPTION = 34
CLAY = (0.5, 0.5, 0.48)
FILM = "cabinet-*-door_1_hinge-panda.mp4"
#: Of its pictures, one is kept; size and time of each [pixels], [ms].
KEPT = 2
FILM_SIZE = (480, 360)
FILM_MS = 200
GROUND = (255, 255, 255)
INK = (60, 62, 66)


def main() -> int:
    """Draw it; returns the exit code."""
    generated, demo = sys.argv[1:]
    width = CELL[0] * len(CAPTIONS)
    sheet = Image.new("RGB", (width, CAPTION + CELL[1] * len(OBJECTS)), GROUND)
    draw = ImageDraw.Draw(sheet)
    for column, words in enumerate(CAPTIONS):
        middle = (CELL[0] * (column + 0.5), CAPTION / 2)
        draw.text(middle, words, fill=INK, anchor="mm", font=ImageFont.load_default(15))
    for row, name in enumerate(OBJECTS):
        (made,) = Path(generated, "assets").glob(f"{name}-*/view.glb")
        mesh = scene_of_file(DOCS.parent / "examples" / "generated" / f"{name}.glb")
        for column, pixels in enumerate(stages(mesh, scene_from(read_model(made)))):
            picture = Image.fromarray(pixels)
            place = (CELL[0] * column, CAPTION + CELL[1] * row)
            sheet.paste(picture, place, picture)
    sheet.quantize(192, dither=Image.Dither.NONE).save(
        DOCS / "pictures" / "made.png", optimize=True
    )
    (film,) = Path(demo, "solving").glob(FILM)
    pictures = [Image.fromarray(each).resize(FILM_SIZE) for each in imageio.get_reader(film)]
    write_film(pictures[::KEPT])
    return 0


def write_film(pictures: list[Image.Image]) -> None:
    """Write an animated picture that rests at its end."""
    times = [FILM_MS] * (len(pictures) - 1) + [1500]
    pictures[0].save(
        DOCS / "pictures" / "robot.webp",
        save_all=True,
        append_images=pictures[1:],
        duration=times,
        loop=0,
        quality=60,
        method=6,
    )


def stages(mesh: SceneGraph, made: SceneGraph) -> list[Pixels]:
    """The four pictures of an object, all from one place."""
    closed = made.opened(0.0)
    opened = made.opened(1.0)
    camera = Viewpoint(made).camera(*CELL, closed, opened)
    own = Caster(made, made.visuals)
    return [
        still(Shot(Caster(mesh, tinted(mesh.visuals, CLAY)), camera, {})),
        still(Shot(own, camera, closed)),
        still(Shot(own, camera, opened)),
        still(Shot(Caster(made, tinted(made.hulls)), camera, opened)),
    ]


if __name__ == "__main__":
    sys.exit(main())
