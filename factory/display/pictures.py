"""The pictures of one asset: closed, open, its hulls, and moving."""

from __future__ import annotations

import colorsys
import io
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageDraw

from ..geometry.colors import linear_of
from .camera import Camera, Viewpoint
from .casting import Caster, Shot
from .scene import SceneGraph, SceneSurface
from .shading import PASSING, RAYS, Painted, paint, still

#: Of the pictures of a grid [pixels].
WIDTH = 256
HEIGHT = 192
#: Of the others.
SMALL_WIDTH = 192
SMALL_HEIGHT = 144
#: Of the animation: frames from closed to open, and how long each is shown [ms].
FRAMES = 5
FRAME_MS = 110
REST_MS = 500
#: Of the mark where something is wrong, and its radius [pixels].
RED = (214, 40, 40, 255)
MARK = 17.0

Pixels = npt.NDArray[np.uint8]
Tint = tuple[float, float, float]


@dataclass(frozen=True)
class Pictures:
    """WebP files of one asset, with transparent ground.

    Attributes:
        closed, opened, hulls: stills; hulls closed, a colour each.
        moving: animated; empty where nothing moves.
        fault: the pose in which it fails, the place marked in red; empty where there is none.
    """

    closed: bytes
    opened: bytes
    hulls: bytes
    moving: bytes
    fault: bytes = b""


@dataclass(frozen=True)
class Fault:
    """Where something is wrong.

    Attributes:
        values: joint values there [rad] or [m].
        point: root frame [m], shape [3]; ``None`` where only the pose is known.
    """

    values: Mapping[str, float]
    point: tuple[float, ...] | None = None


def pictures_of(scene: SceneGraph, fault: Fault | None = None) -> Pictures:
    """Return all pictures of a scene: the same scene gives the same bytes."""
    caster = Caster(scene, scene.visuals or scene.hulls)
    hulls = Caster(scene, tinted(scene.hulls))
    view = Viewpoint(scene)
    closed = scene.opened(0.0)
    small = view.camera(SMALL_WIDTH, SMALL_HEIGHT)
    seen = frames(caster, small, FRAMES if scene.movable else 1)
    return Pictures(
        webp(still(Shot(caster, view.camera(WIDTH, HEIGHT, closed), closed))),
        webp(seen[-1]),
        webp(still(Shot(hulls, small, closed))),
        animated(seen) if scene.movable else b"",
        b"" if fault is None else webp(_pointed(caster, view, fault)),
    )


def _pointed(caster: Caster, view: Viewpoint, fault: Fault) -> Pixels:
    """Return the pose in which something is wrong, the place marked."""
    values = {**caster.scene.opened(0.0), **fault.values}
    camera = view.camera(WIDTH, HEIGHT, values)
    seen = still(Shot(caster, camera, values))
    return seen if fault.point is None else marked(seen, camera, fault.point)


def marked(pixels: Pixels, camera: Camera, point: tuple[float, ...]) -> Pixels:
    """Return the picture with a red ring around a place, whatever lies before it."""
    column, row, _ = camera.places(np.array([point]))[0]
    fine = 4
    size = fine * camera.width, fine * camera.height
    over = Image.new("RGBA", size, (*RED[:3], 0))
    draw = ImageDraw.Draw(over)
    for radius, width in ((MARK, 3), (2.5, 3)):
        corners = [fine * (at + side * radius) for side in (-1, 1) for at in (column, row)]
        draw.ellipse(corners, outline=RED, width=fine * width)
    over = over.resize((camera.width, camera.height), Image.Resampling.BOX)
    return np.asarray(Image.alpha_composite(Image.fromarray(pixels), over))


def frames(caster: Caster, camera: Camera, count: int) -> list[Pixels]:
    """Return the object from closed to open; what does not move is cast and coloured once."""
    scene = caster.scene
    moving = _moving(scene)
    closed = scene.opened(0.0)
    under = paint_still(Shot(caster, camera, closed), moving)
    made = []
    for amount in np.linspace(0.0, 1.0, count):
        values = scene.opened(float(amount))
        rays = PASSING if 0.0 < amount < 1.0 else RAYS
        made.append(still(Shot(caster, camera, values), under, rays))
    return made


def paint_still(shot: Shot, moving: frozenset[int]) -> Painted:
    """Return the picture of a pose as if the links that move were not there."""
    shown = [each for link in shot.caster.links.values() for each in link.surfaces]
    # At the border of a shape more rays are cast, which must not meet what moves either.
    rest = Caster(shot.caster.scene, [each for each in shown if each.link not in moving])
    return replace(paint(replace(shot, caster=rest)), without=moving)


def tinted(surfaces: Iterable[SceneSurface], tint: Tint | None = None) -> list[SceneSurface]:
    """Return surfaces in plain colours, by link; neighbours in the list get colours far apart.

    Args:
        surfaces: of a scene.
        tint: linear RGB of all of them instead.
    """
    shown = sorted((each for each in surfaces if len(each.faces)), key=lambda each: each.link)
    found = []
    for number, surface in enumerate(shown):
        hue = (number * 0.618034) % 1.0
        color = linear_of(colorsys.hls_to_rgb(hue, 0.72, 0.42)) if tint is None else tint
        red, green, blue = (float(each) for each in color)
        found.append(replace(surface, normals=None, image=None, color=(red, green, blue, 1.0)))
    return found


def webp(pixels: Pixels) -> bytes:
    """Return a still as a WebP file."""
    buffer = io.BytesIO()
    Image.fromarray(pixels).save(buffer, format="WEBP", quality=84, method=0)
    return buffer.getvalue()


def animated(pixels: list[Pixels]) -> bytes:
    """Return the frames there and back as an animated WebP file."""
    there = [Image.fromarray(each) for each in pixels]
    loop = [*there, *there[-2:0:-1]]
    times = [FRAME_MS] * len(loop)
    times[0] = times[len(there) - 1] = REST_MS
    buffer = io.BytesIO()
    loop[0].save(
        buffer,
        format="WEBP",
        save_all=True,
        append_images=loop[1:],
        duration=times,
        loop=0,
        quality=70,
        method=0,
        minimize_size=False,
        allow_mixed=False,
    )
    return buffer.getvalue()


def _moving(scene: SceneGraph) -> frozenset[int]:
    """Return the links that some joint moves."""
    found: set[int] = set()
    for joint in scene.joints:
        if joint.moves or joint.parent in found:
            found.add(joint.child)
    return frozenset(found)
