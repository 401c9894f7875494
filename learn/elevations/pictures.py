"""An object's sides as a generated mesh of it would show them, with the part of every pixel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import ndimage

from asset_factory.factory.articulate.seams.relief import BEHIND, Relief, lab_of
from asset_factory.factory.articulation import Articulation
from asset_factory.factory.geometry.posing import face_parts
from asset_factory.factory.geometry.triangles import doubled_normals
from asset_factory.factory.mesh import FloatArray, IntArray
from asset_factory.factory.views.raster import PIXELS, Raster, Side
from asset_factory.factory.views.view import View, view_through

from .decorations import Decorations

#: Gaps up to so many pixels are closed, as a skin closes them.
GAP = 5


@dataclass(frozen=True)
class Looks:
    """How one object was generated; drawn once, for all its sides.

    Attributes:
        deep: grooves at the borders of parts [pixels].
        wide: half their width [pixels].
        dark: brightness of the lines at the borders of parts.
        blurred: of shape and of colours, standard deviation [pixels].
        bumps: height of wide and of narrow bumps [pixels].
        grain: noise of the brightness.
        plain: one colour all over, sRGB; ``None``: those of the parts.
        decorations: lines on it that are no seams.
        sunken: share of the shade that grooves and corners have.
    """

    deep: float
    wide: float
    dark: float
    blurred: tuple[float, float]
    bumps: tuple[float, float]
    grain: float
    plain: tuple[float, float, float] | None
    decorations: Decorations
    sunken: float

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Looks:
        """Return some generator's hand."""
        gray = float(rng.uniform(0.2, 0.9))
        plain = (gray, gray, gray) if rng.random() < 0.5 else tuple(rng.uniform(0.1, 0.9, 3))
        return cls(
            deep=float(rng.uniform(0.2, 2.5)) if rng.random() < 0.8 else 0.0,
            wide=float(rng.uniform(0.5, 1.6)),
            dark=float(rng.uniform(0.3, 0.9)) if rng.random() < 0.7 else 1.0,
            blurred=(float(rng.uniform(0.3, 1.1)), float(rng.uniform(0.3, 1.5))),
            bumps=(float(rng.exponential(0.15)), float(rng.exponential(0.04))),
            grain=float(rng.exponential(0.02)),
            plain=plain if rng.random() < 0.5 else None,
            decorations=Decorations.drawn(rng),
            sunken=float(rng.uniform(0.0, 0.08)),
        )


@dataclass(frozen=True)
class Picture:
    """One side and what it shows.

    Attributes:
        relief: the side.
        part: of every pixel, -1 where nothing is seen, shape [rows, columns].
    """

    relief: Relief
    part: IntArray


def pictures_of(
    articulation: Articulation, rng: np.random.Generator, sides: Sequence[Side]
) -> dict[Side, Picture]:
    """Return some sides of an object at rest, as if it were one skin of some generator's."""
    looks = Looks.drawn(rng)
    return {side: _picture(articulation, side, looks, rng) for side in sides}


def _picture(
    articulation: Articulation, side: Side, looks: Looks, rng: np.random.Generator
) -> Picture:
    mesh = articulation.mesh
    shown = _shown(articulation, side)
    seen = np.asarray(
        ndimage.binary_closing(np.pad(shown.seen, 3), np.ones((3, 3), dtype=np.bool_))[3:-3, 3:-3]
    )
    seen |= shown.seen
    pixel = shown.raster.pixel
    raw = np.where(shown.seen, -shown.depth, -np.inf) / pixel
    lowest = float(raw[shown.seen].min())
    closed = ndimage.grey_closing(np.maximum(raw, lowest - BEHIND), size=(GAP, GAP))
    solid = shown.seen & (closed - np.maximum(raw, lowest - BEHIND) < 1.0)
    where = ndimage.distance_transform_edt(~solid, return_distances=False, return_indices=True)
    part = shown.part[tuple(where)]
    height = _smooth(closed[tuple(where)], looks.blurred[0])
    border = _border(part)
    height = height - _engraved(border, looks, rng) + _bumps(height.shape, looks, rng)
    decoration = looks.decorations.on(part, rng)
    height = height + _smooth(decoration.height, looks.blurred[0])
    lab = _painted(shown.color[tuple(where)], height, border, decoration.light, looks, rng)
    slope = np.gradient(height)
    facing = 1.0 / np.sqrt(1.0 + slope[0] ** 2 + slope[1] ** 2)
    relief = Relief(
        shown.raster,
        seen,
        np.where(seen, height, lowest - BEHIND),
        np.where(seen, facing, 0.0),
        lab,
        np.zeros(seen.shape, dtype=np.int64),
        float(np.abs(side.frame[2]) @ mesh.extents),
    )
    return Picture(relief, np.where(seen, part, -1))


def _shown(articulation: Articulation, side: Side) -> View:
    """Look from a side at the faces of an object's solids that face it."""
    mesh = articulation.mesh
    corners = mesh.vertices[mesh.faces]
    normals = doubled_normals(corners)
    toward = np.flatnonzero(normals @ side.frame[2] < 0.0)
    facing = replace(
        mesh,
        faces=mesh.faces[toward],
        corner_uv=None,
        corner_normals=None,
        face_material=mesh.face_material[toward],
    )
    return view_through(facing, Raster.around(mesh, side, PIXELS), face_parts(articulation)[toward])


def _smooth(values: FloatArray, sigma: float) -> FloatArray:
    return np.asarray(ndimage.gaussian_filter(values, sigma))


def _border(part: IntArray) -> FloatArray:
    """Return the distance to the next border between two parts [pixels]."""
    differs = np.zeros(part.shape, dtype=np.bool_)
    differs[1:] |= part[1:] != part[:-1]
    differs[:, 1:] |= part[:, 1:] != part[:, :-1]
    if not differs.any():
        return np.full(part.shape, np.inf)
    return np.asarray(ndimage.distance_transform_edt(~differs))


def _engraved(border: FloatArray, looks: Looks, rng: np.random.Generator) -> FloatArray:
    """Return the depth of the grooves; here and there they are shallow [pixels]."""
    patchy = _wavy(border.shape, 25.0, rng)
    groove = np.where(border <= looks.wide, looks.deep, 0.0) * np.clip(1.0 + patchy, 0.2, 1.5)
    return _smooth(groove, 0.5)


def _wavy(shape: tuple[int, ...], wide: float, rng: np.random.Generator) -> FloatArray:
    """Return a random field that varies over so many pixels, of standard deviation 1/2."""
    coarse = max(wide / 2.0, 1.0)
    knots = rng.normal(size=tuple(int(length / coarse) + 4 for length in shape))
    field = ndimage.zoom(ndimage.gaussian_filter(knots, wide / coarse), coarse, order=1)
    return np.asarray(0.5 * field[: shape[0], : shape[1]] / max(float(field.std()), 1e-9))


def _bumps(shape: tuple[int, ...], looks: Looks, rng: np.random.Generator) -> FloatArray:
    wide, narrow = looks.bumps
    return wide * _wavy(shape, 10.0, rng) + narrow * _wavy(shape, 1.0, rng)


def _painted(
    color: FloatArray,
    height: FloatArray,
    border: FloatArray,
    decorated: FloatArray,
    looks: Looks,
    rng: np.random.Generator,
) -> FloatArray:
    """Paint colours with baked shade and lines, CIE L*a*b*, shape [rows, columns, 3]."""
    if looks.plain is not None:
        color = np.broadcast_to(np.array(looks.plain), color.shape)
    dip = ndimage.grey_closing(height, size=(9, 9)) - height
    light = 1.0 - looks.sunken * np.clip(dip, 0.0, 5.0)
    light = light * np.where(border <= looks.wide, looks.dark, 1.0)
    light = light * decorated
    light = light * (1.0 + 0.15 * _wavy(height.shape, 40.0, rng))
    light = light * (1.0 + looks.grain * rng.normal(size=height.shape))
    shaded = np.clip(color * light[..., None], 0.0, 1.0)
    sigma = looks.blurred[1]
    return lab_of(np.asarray(ndimage.gaussian_filter(shaded, (sigma, sigma, 0.0))))
