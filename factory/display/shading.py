"""Shading of ray hits: plain daylight, darker in corners, with fine lines where shapes end."""

from __future__ import annotations

import io
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt
from PIL import Image
from scipy.ndimage import binary_dilation, uniform_filter

from ..geometry.colors import linear_of, srgb_of
from ..mesh import FloatArray
from .camera import Camera
from .casting import Hits, Shot, lengths
from .scene import SceneSurface

FloatRows = npt.NDArray[np.float32]
#: Directions of light in the camera's axes (right, up, backward), and how strong [of 1].
KEY = np.array([-0.45, 0.75, 0.5])
KEY_LIGHT = 0.62
SKY_LIGHT = 0.42
GROUND_LIGHT = 0.22
#: How dark corners become at most, and how deep they are, a share of the object's depth.
CORNER_SHADE = 0.45
CORNER_DEPTH = 0.035
#: Darkening of the lines between shapes.
LINE = 0.55
#: Rays per pixel where shapes end: a rotated grid.
_WITHIN = np.array([[0.375, 0.125], [0.625, 0.875], [0.875, 0.375], [0.125, 0.625]])
RAYS = len(_WITHIN)
#: Of a picture that is seen for a moment only.
PASSING = 2
_BANDS = 4096
_UP = np.array([0.0, 0.0, 1.0], dtype=np.float32)
#: Linear light as it is shown.
_SHOWN = np.round(255.0 * srgb_of(np.linspace(0.0, 1.0, _BANDS))).astype(np.uint8)


@dataclass(frozen=True)
class Painted:
    """A picture before its corners are darkened.

    Attributes:
        hits: of the middles of all pixels.
        color: linear RGB multiplied by alpha, and alpha, shape [pixels, 4].
        ends: pixels where a link ends before another, shape [pixels].
        without: links that are left out.
    """

    hits: Hits
    color: FloatRows
    ends: npt.NDArray[np.bool_]
    without: frozenset[int] = frozenset()


def still(shot: Shot, under: Painted | None = None, rays: int = RAYS) -> npt.NDArray[np.uint8]:
    """Return one picture of a pose, sRGB with alpha, shape [height, width, 4].

    ``under`` is the same picture without the links that move; so many ``rays`` are cast per pixel
    where shapes end.
    """
    camera = shot.camera
    painted = paint(shot, under, rays)
    factor = _corners(painted.hits, (camera.height, camera.width)).reshape(-1)
    factor *= np.where(painted.ends, 1.0 - LINE * 0.6, 1.0).astype(np.float32)
    # Colours are kept multiplied by alpha while they are averaged.
    alpha = painted.color[:, 3:]
    plain = painted.color[:, :3] * (factor[:, None] / np.maximum(alpha, 1e-6))
    shown = _SHOWN[(np.clip(plain, 0.0, 1.0) * (_BANDS - 1)).astype(np.int32)]
    opaque = np.round(255.0 * np.clip(alpha, 0.0, 1.0)).astype(np.uint8)
    return np.concatenate([shown, opaque], axis=1).reshape(camera.height, camera.width, 4)


def paint(shot: Shot, under: Painted | None = None, rays: int = RAYS) -> Painted:
    """Return the colours of all pixels; arguments as :func:`still` has them."""
    shape = (shot.camera.height, shot.camera.width)
    if under is None:
        hits = shot.see()
        color = np.zeros((len(hits.link), 4), dtype=np.float32)
        fresh = np.ones(len(hits.link), dtype=bool)
    else:
        hits = shot.see(under.hits, under.without)
        color = under.color.copy()
        # A pixel whose neighbours are as they were has the colour that it had.
        differs = (hits.depth != under.hits.depth) | (hits.link != under.hits.link)
        fresh = binary_dilation(differs.reshape(shape), np.ones((3, 3), dtype=bool)).reshape(-1)
    ends, bends = (each.reshape(-1) for each in _borders(hits, shape))
    edge = np.flatnonzero(fresh & (ends | bends))
    inner = np.flatnonzero(fresh & ~(ends | bends))
    seen = inner[hits.link[inner] >= 0]
    color[inner] = 0.0
    color[seen, :3] = _lit(shot, hits, seen)
    color[seen, 3] = 1.0
    if len(edge):
        color[edge] = _smooth(shot, edge, rays)
    return Painted(hits, color, ends)


def _lit(shot: Shot, hits: Hits, rays: npt.NDArray[np.int64]) -> FloatRows:
    """Return the linear RGB of rays that met something."""
    color = np.empty((len(rays), 3), dtype=np.float32)
    normal = hits.normal[rays]
    links = hits.link[rays]
    for index, link in shot.caster.links.items():
        own = np.flatnonzero(links == index)
        owners = link.owner[hits.face[rays[own]]]
        for number, surface in enumerate(link.surfaces):
            mine = own[owners == number]
            if not len(mine):
                continue
            rows = rays[mine]
            faces = surface.faces[hits.face[rows] - link.starts[number]]
            weights = np.stack(
                [1.0 - hits.u[rows] - hits.v[rows], hits.u[rows], hits.v[rows]], axis=1
            )
            color[mine] = _albedo(surface, faces, weights)
            if surface.normals is not None:
                smooth = np.einsum("ij,ijk->ik", weights, surface.normals[faces])
                normal[mine] = smooth @ shot.poses[index][:3, :3].T.astype(np.float32)
    return color * _light(shot.camera, normal)[:, None]


def light_direction(camera: Camera) -> FloatArray:
    """Return the direction towards the strongest light, unit, root frame, shape [3]."""
    return np.asarray((KEY / np.linalg.norm(KEY)) @ camera.axes)


def _light(camera: Camera, normal: FloatRows) -> FloatRows:
    """Return how much light surfaces of those normals throw back; both sides alike."""
    key = light_direction(camera).astype(np.float32)
    backward, direct, height = np.stack([camera.axes[2].astype(np.float32), key, _UP]) @ normal.T
    scale = np.where(backward < 0.0, -1.0, 1.0) / lengths(normal)
    backward *= scale
    direct = np.maximum(direct * scale, 0.0)
    sky = 0.5 + 0.5 * height * scale
    thrown = KEY_LIGHT * direct + GROUND_LIGHT + (SKY_LIGHT - GROUND_LIGHT) * sky
    return np.asarray(thrown + 0.12 * np.abs(backward), dtype=np.float32)


def _albedo(surface: SceneSurface, faces: npt.NDArray[np.int32], weights: FloatRows) -> FloatRows:
    plain = np.array(surface.color[:3], dtype=np.float32)
    texels = None if surface.image is None else _texels(surface.image)
    if texels is None or surface.uv is None:
        return np.broadcast_to(plain, (len(faces), 3))
    uv = np.einsum("ij,ijk->ik", weights, surface.uv[faces])
    height, width = texels.shape[:2]
    column = np.floor((uv[:, 0] % 1.0) * width).astype(np.int32).clip(0, width - 1)
    row = np.floor((1.0 - uv[:, 1] % 1.0) * height).astype(np.int32).clip(0, height - 1)
    return np.asarray(texels[row, column] * plain, dtype=np.float32)


@lru_cache(maxsize=16)
def _texels(image: bytes) -> FloatRows | None:
    """Return the linear RGB of an image, shape [height, width, 3]; ``None``: it is broken."""
    try:
        with Image.open(io.BytesIO(image), formats=("PNG", "JPEG")) as opened:
            opened.draft("RGB", (512, 512))
            small = opened.convert("RGB")
            small.thumbnail((512, 512), Image.Resampling.BILINEAR)
            shown = np.asarray(small)
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        return None
    return np.asarray(linear_of(np.arange(256) / 255.0).astype(np.float32)[shown])


def _borders(hits: Hits, shape: tuple[int, int]) -> npt.NDArray[np.bool_]:
    """Find pixels where a link ends, and where a surface bends; shape [2, height, width]."""
    link = hits.link.reshape(shape)
    depth = np.where(np.isfinite(hits.depth), hits.depth, 0.0).reshape(shape)
    normal = hits.normal.reshape(*shape, 3)
    ends = np.zeros(shape, dtype=bool)
    bends = np.zeros(shape, dtype=bool)
    for first, second in ((np.s_[:-1], np.s_[1:]), (np.s_[:, :-1], np.s_[:, 1:])):
        both = (link[first] >= 0) & (link[second] >= 0)
        other = link[first] != link[second]
        turn = np.einsum("ijk,ijk->ij", normal[first], normal[second]) < 0.85
        step = np.abs(depth[first] - depth[second]) > 0.02 * np.maximum(depth[first], depth[second])
        bent = other | (both & (turn | step))
        nearer = depth[first] <= depth[second]
        ends[first] |= both & other & nearer
        ends[second] |= both & other & ~nearer
        bends[first] |= bent
        bends[second] |= bent
    return np.stack([ends, bends])


def _smooth(shot: Shot, edge: npt.NDArray[np.int64], rays: int) -> FloatRows:
    """Return colour with alpha of pixels where shapes end, several rays each."""
    within = _WITHIN[:rays]
    rows, columns = np.divmod(edge, shot.camera.width)
    starts = np.stack([columns, rows], axis=1).astype(np.float64)
    pixels = (starts[:, None] + within[None]).reshape(-1, 2)
    hits = shot.cast(pixels)
    seen = np.flatnonzero(hits.link >= 0)
    color = np.zeros((len(pixels), 4), dtype=np.float32)
    color[seen, :3] = _lit(shot, hits, seen)
    color[seen, 3] = 1.0
    return np.asarray(color.reshape(len(edge), rays, 4).mean(axis=1), dtype=np.float32)


def _corners(hits: Hits, shape: tuple[int, int]) -> FloatArray:
    """Return factors that darken pixels deeper than their surroundings, shape [height, width]."""
    depth = hits.depth.reshape(shape)
    seen = np.isfinite(depth)
    if not seen.any():
        return np.ones(shape, dtype=np.float32)
    far = float(depth[seen].max())
    size = max(3, shape[0] // 10) | 1
    reach = CORNER_DEPTH * far
    # Only what is seen counts: beside nothing, a surface is as deep as itself.
    weight = uniform_filter(seen.astype(np.float32), size)
    mean = uniform_filter(np.where(seen, depth, 0.0).astype(np.float32), size)
    around = mean / np.maximum(weight, 1e-6)
    deeper = np.where(seen, np.clip((depth - around) / reach, 0.0, 1.0), 0.0)
    return np.asarray(1.0 - CORNER_SHADE * deeper, dtype=np.float32)
