"""Space in cells between planes along the axes, and which of them a one-piece mesh encloses."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from ...mesh import BoolArray, FloatArray, Mesh
from ...views.crossings import crossings
from ...views.raster import Raster, Side
from .box import Box

#: Even lines nearer to a wanted one than this share of their distance are left out.
CROWDED = 0.45
#: Wanted lines nearer to an end than this share of a cell would split off a layer of nothing.
SHRED = 0.1
#: A ray per this share of a cell.
FINER = 0.5
#: Rays along two of the three axes must agree.
VOTES = 2
#: Sides of six on which a space is shut in.
SHUT_IN = 5
#: Cells along each axis.
Span = tuple[slice, ...]
#: Seen from these sides each axis points away.
_SIDES = (Side.LEFT, Side.FRONT, Side.BOTTOM)


@dataclass(frozen=True)
class Lattice:
    """Planes across each axis [m], ascending; cell i lies between planes i and i + 1."""

    lines: tuple[FloatArray, ...]

    @classmethod
    def over(cls, bounds: FloatArray, cells: int, planes: list[list[float]]) -> Lattice:
        """Return even cells over a box, with some planes exactly where they are wanted.

        The longest side of the box [m], shape [2, 3], has so many cells; planes are given across
        each axis [m].
        """
        size = bounds[1] - bounds[0]
        step = float(size.max()) / cells
        lines = []
        for axis in range(3):
            count = max(int(np.ceil(size[axis] / step)), 2)
            even = np.linspace(bounds[0, axis] - 1e-4, bounds[1, axis] + 1e-4, count + 1)
            wanted = np.unique(np.round(planes[axis], 6))
            shred = SHRED * step
            wanted = wanted[(wanted > even[0] + shred) & (wanted < even[-1] - shred)]
            off = np.abs(even[:, None] - wanted[None]).min(axis=1, initial=np.inf)
            off[[0, -1]] = np.inf
            lines.append(np.sort(np.concatenate([even[off >= CROWDED * step], wanted])))
        return cls(tuple(lines))

    @property
    def shape(self) -> tuple[int, ...]:
        """Return the cells along each axis."""
        return tuple(len(each) - 1 for each in self.lines)

    @cached_property
    def step(self) -> float:
        """Return the length of most cells' sides [m]."""
        return float(max(np.median(np.diff(line)) for line in self.lines))

    @property
    def middles(self) -> tuple[FloatArray, ...]:
        """Return the coordinates of the cells' centres along each axis [m]."""
        return tuple((each[1:] + each[:-1]) / 2.0 for each in self.lines)

    @cached_property
    def volumes(self) -> FloatArray:
        """Return the volume of every cell [m3], shape [nx, ny, nz]."""
        x, y, z = (np.diff(each) for each in self.lines)
        return np.asarray(x[:, None, None] * y[None, :, None] * z[None, None, :])

    def span(self, box: Box) -> Span:
        """Return the cells whose centres lie in a box."""
        return tuple(
            slice(*np.searchsorted(middle, [box.low[axis], box.high[axis]]))
            for axis, middle in enumerate(self.middles)
        )

    def below(self, planes: FloatArray, span: Span, margin: float = 0.0) -> BoolArray:
        """Return which cells of a span have their centres below all of some planes.

        Those of one column lie between two heights: columns are looked at, not cells.

        Args:
            planes: outward unit normals and offsets, shape [n, 4]; ``normal . x + offset`` [m] is
                the height above one.
            span: of cells.
            margin: what their heights must stay under [m].

        Returns:
            Shape as of the span.
        """
        middles = [middle[part] for middle, part in zip(self.middles, span, strict=True)]
        axis = int(np.argmax([len(each) for each in middles]))
        first, second = (other for other in range(3) if other != axis)
        over = (
            planes[:, first, None, None] * middles[first][:, None]
            + planes[:, second, None, None] * middles[second]
            + (planes[:, 3, None, None] - margin)
        )
        slope = planes[:, axis]
        with np.errstate(divide="ignore", invalid="ignore"):
            ends = -over / slope[:, None, None]
        low = ends[slope < 0.0].max(axis=0, initial=-np.inf)[..., None]
        high = ends[slope > 0.0].min(axis=0, initial=np.inf)[..., None]
        beside = (over[slope == 0.0] < 0.0).all(axis=0)[..., None]
        inside = beside & (middles[axis] > low) & (middles[axis] < high)
        return np.asarray(np.moveaxis(inside, -1, axis))

    def centers(self, cells: npt.NDArray[np.int64]) -> FloatArray:
        """Return the centres [m] of cells given by their indices, shape [n, 3]."""
        return np.column_stack([self.middles[axis][cells[:, axis]] for axis in range(3)])


def enclosed(mesh: Mesh, lattice: Lattice) -> BoolArray:
    """Return the cells whose centres a one-piece mesh encloses, shape [nx, ny, nz].

    Along each axis a ray counts how often it entered less how often it left; two of three axes
    decide, so that a hole of the surface fills or empties only the cells behind it.
    """
    votes = np.zeros(lattice.shape, dtype=np.int8)
    for axis, side in enumerate(_SIDES):
        votes += _wound(mesh, lattice, axis, side)
    return np.asarray(votes >= VOTES)


def marked(lattice: Lattice, points: FloatArray) -> BoolArray:
    """Return the cells in which any of some points lies, shape [nx, ny, nz]."""
    cells = np.stack(
        [
            np.clip(np.searchsorted(line, points[:, axis]) - 1, 0, len(line) - 2)
            for axis, line in enumerate(lattice.lines)
        ]
    )
    found = np.zeros(lattice.shape, dtype=bool)
    found[tuple(cells)] = True
    return found


def closed_up(whole: BoolArray) -> BoolArray:
    """Return the cells of a mesh or shut in by it: met in at least five of six directions."""
    met = np.zeros(whole.shape, dtype=np.int8)
    for axis in range(3):
        met += np.logical_or.accumulate(whole, axis=axis)
        met += np.flip(np.logical_or.accumulate(np.flip(whole, axis), axis=axis), axis)
    return np.asarray(whole | (met >= SHUT_IN))


def _wound(mesh: Mesh, lattice: Lattice, axis: int, side: Side) -> BoolArray:
    """Return whether rays along one axis are inside at the cells' centres, shape [nx, ny, nz]."""
    longest = float(mesh.extents.max())
    step = min(float(np.median(np.diff(each))) for each in lattice.lines) * FINER
    raster = Raster.around(mesh, side, int(np.clip(longest / step, 64, 400)))
    crossed = crossings(mesh, raster)
    middles = list(lattice.middles)
    along = middles[axis]
    middles[axis] = np.zeros(1)
    place = np.searchsorted(along, crossed.depth + raster.near)
    count = np.zeros((raster.rows * raster.columns, len(along) + 1), dtype=np.int16)
    np.add.at(count, (crossed.pixel, place), np.where(crossed.inward, 1, -1).astype(np.int16))
    inside = (np.cumsum(count, axis=1)[:, :-1] > 0).reshape(raster.rows, raster.columns, -1)
    columns = np.stack(np.meshgrid(*middles, indexing="ij"), axis=-1).squeeze(axis)
    at = raster.nearest(columns.reshape(-1, 3) @ side.frame.T)
    return np.moveaxis(inside[at].reshape(*columns.shape[:2], -1), -1, axis)
