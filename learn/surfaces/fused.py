"""What image-to-3D gives: one bumpy skin around an object, gaps closed, inside lost."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import numpy.typing as npt
from scipy import ndimage
from scipy.spatial import cKDTree

from asset_factory.factory.articulation import Articulation
from asset_factory.factory.mesh import BoolArray, FloatArray, IntArray

from .labelled import Labelled

#: Points on the original surface, from which the skin and its labels come; more for a finer skin.
POINTS = 24000
#: Cells along the longest side, lowest and highest; fewer if those made too many triangles.
RESOLUTION = (40, 80)
MOST_FACES = 14000
#: The skin lies this many cells outside the surface; twice that is the widest gap it closes.
REACH = (0.35, 0.8)
MARGIN = 4
#: More than any part's number.
NOBODY = 10_000
#: A grid point and all 26 around it.
AROUND = np.ones((3, 3, 3), dtype=bool)


def fused_like(articulation: Articulation, seed: int) -> Articulation:
    """Return one closed surface around the whole object, labelled by the nearest part.

    Seams run along triangles of the skin, and vertices may be shared by more than two sheets where
    surfaces touch. Parts and joints are the same, but for parts that nothing is seen of.

    Raises:
        ValueError: what would be left out holds something that is seen, or is all that moves.
    """
    rng = np.random.default_rng([seed, 0xF5])
    cells = _cells(articulation.mesh.extents, rng)
    original = Labelled.of(articulation)
    reach = float(rng.uniform(*REACH))
    for finer in (1.0, 1.6):
        # Too few points a cell would leave holes, through which the outside gets in.
        count = round(POINTS * finer**2)
        # Evenly spread over the area: chance would leave holes, too.
        shares = (np.arange(count) + rng.random(count)) / count
        points, below, _ = original.sampled(shares, rng)
        owner = original.part[below]
        vertices, faces, nearest = skin(points, owner, round(finer * cells), reach, rng)
        label = original.label[below[nearest]]
        if np.isin(original.part, label[:, 0]).all():
            break
    fused = Labelled(vertices, faces, label)
    return with_skin(articulation, fused, "fused as by an image-to-3D tool")


def _cells(extents: FloatArray, rng: np.random.Generator) -> int:
    """Return how many along the longest side."""
    x, y, z = extents / extents.max()
    # A cell on the box becomes two triangles, and objects of any shape have more than their box.
    most = np.sqrt(MOST_FACES / (2.5 * 2.0 * (x * y + y * z + z * x)))
    return int(min(rng.integers(RESOLUTION[0], RESOLUTION[1] + 1), max(most, RESOLUTION[0] / 2)))


def skin(
    points: FloatArray,
    owner: IntArray,
    cells: int,
    reach: float,
    rng: np.random.Generator,
    *,
    groove: int = 0,
    bumps: float = 0.25,
) -> tuple[FloatArray, IntArray, IntArray]:
    """Return vertices [m] and faces ``reach`` cells outside, and a point near each face.

    Of ``points`` on the surface [m], several lie in every cell that it passes; ``cells`` are along
    the longest side. The skin is engraved ``groove`` cells deep where parts, the owners of points,
    border on one another; ``bumps`` are so high in units of ``reach``.
    """
    low = points.min(axis=0)
    high = points.max(axis=0)
    cell = float((high - low).max()) / cells
    corner = low - MARGIN * cell
    shape = np.ceil((high - corner) / cell).astype(int) + MARGIN + 1
    nearby = tuple(np.rint((points - corner) / cell).astype(np.int64).T)
    surface = np.zeros(shape, dtype=bool)
    surface[nearby] = True
    solid = _filled(surface)
    if groove:
        part = np.full(shape, -1, dtype=np.int64)
        part[nearby] = owner
        solid = _without_contacts(_engraved(solid, part, groove))
    vertices, faces = _nets(solid)
    vertices = corner + cell * vertices
    # Drawn onto the level set around the points, which the grid knows only by the cell.
    distance, rows = cKDTree(points).query(vertices)
    nearest = np.asarray(rows, dtype=np.int64)
    wanted = cell * reach * (1.0 + bumps * _bumps(vertices, rng, 6.0 * cell))
    away = (vertices - points[nearest]) / np.maximum(distance, 1e-9)[:, None]
    drawn = points[nearest] + away * np.minimum(wanted, distance)[:, None]
    # Of the points nearest to a face's corners the one that is nearest to its middle.
    near = nearest[faces]
    middle = vertices[faces].mean(axis=1)
    choice = np.square(points[near] - middle[:, None]).sum(axis=2).argmin(axis=1)
    return _smoothed(drawn, faces, 0.5), faces, near[np.arange(len(faces)), choice]


def _filled(occupied: BoolArray) -> BoolArray:
    """Fill everything that cannot be reached from outside; small holes are closed."""
    thick = ndimage.binary_dilation(occupied, AROUND)
    outside: npt.NDArray[np.int32] = np.zeros(thick.shape, dtype=np.int32)
    ndimage.label(~thick, output=outside)
    inside = outside != outside[0, 0, 0]
    # The dilation is taken back where it closed no gap.
    return _without_contacts(np.asarray(ndimage.binary_erosion(inside, AROUND) | occupied))


def _engraved(solid: BoolArray, part: IntArray, depth: int) -> BoolArray:
    """Return the solid without its outer ``depth`` cells where two parts, not -1, are near."""
    high = ndimage.maximum_filter(part, size=3)
    low = ndimage.minimum_filter(np.where(part >= 0, part, NOBODY), size=3)
    border = (high >= 0) & (low < NOBODY) & (low != high)
    outer = solid & ~ndimage.binary_erosion(solid, iterations=depth)
    return np.asarray(solid & ~(border & outer))


def _without_contacts(solid: BoolArray) -> BoolArray:
    """Fill where two grid points touch only diagonally in a plane of the grid.

    Four sheets would meet in an edge there.
    """
    grid = solid.copy()
    for _ in range(3):
        filled = 0
        for axis, other in ((0, 1), (1, 2), (0, 2)):
            turned = np.moveaxis(grid, (axis, other), (0, 1))
            a = turned[:-1, :-1]
            b = turned[1:, 1:]
            c = turned[1:, :-1]
            d = turned[:-1, 1:]
            one = a & b & ~c & ~d
            two = ~a & ~b & c & d
            c |= one
            a |= two
            filled += int(one.sum()) + int(two.sum())
        if not filled:
            break
    return grid


def _nets(solid: BoolArray) -> tuple[FloatArray, IntArray]:
    """Return surface nets: a vertex per mixed cell, a quad across each edge that changes.

    Vertices in grid steps, shape [vertex_count, 3]; triangles that look away from the solid.
    S. F. Gibson, Constrained elastic surface nets, MICCAI 1998.
    """
    corners = [solid[ends] for ends in product((slice(-1), slice(1, None)), repeat=3)]
    mixed = np.any(corners, axis=0) & ~np.all(corners, axis=0)
    number = np.full(mixed.shape, -1, dtype=np.int64)
    number[mixed] = np.arange(int(mixed.sum()))
    vertices = np.argwhere(mixed) + 0.5
    quads = []
    for axis in range(3):
        changes = np.diff(solid.astype(np.int8), axis=axis)
        at = np.argwhere(changes)
        u, v = np.eye(3, dtype=np.int64)[[(axis + 1) % 3, (axis + 2) % 3]]
        around = np.stack([at - u - v, at - v, at, at - u], axis=1)
        found = number[tuple(np.moveaxis(around, -1, 0))]
        # Counter-clockwise about the axis looks along it; solid ahead means it must look back.
        quads.append(np.where((changes[tuple(at.T)] > 0)[:, None], found[:, ::-1], found))
    quad = np.concatenate(quads)
    triangles = np.concatenate([quad[:, [0, 1, 2]], quad[:, [0, 2, 3]]])
    return np.asarray(vertices, dtype=np.float64), np.asarray(triangles, dtype=np.int64)


def _smoothed(vertices: FloatArray, faces: IntArray, share: float) -> FloatArray:
    """Return every vertex moved towards the mean of its neighbours by ``share`` of the way."""
    ends = faces[:, [0, 1, 2, 1, 2, 0]].reshape(-1)
    others = faces[:, [1, 2, 0, 0, 1, 2]].reshape(-1)
    count = np.bincount(ends, minlength=len(vertices))[:, None]
    total = np.stack(
        [np.bincount(ends, vertices[others, k], minlength=len(vertices)) for k in range(3)], axis=1
    )
    return np.asarray(vertices + share * (total / np.maximum(count, 1) - vertices))


def _bumps(points: FloatArray, rng: np.random.Generator, length: float) -> FloatArray:
    """Smooth noise of about unit size, waves 1 to 3 ``length`` long [m], shape [point_count]."""
    waves = 6
    directions = rng.normal(size=(3, waves))
    lengths = rng.uniform(length, 3.0 * length, waves)
    directions *= 2.0 * np.pi / (np.linalg.norm(directions, axis=0) * lengths)
    phases = rng.uniform(0.0, 2.0 * np.pi, waves)
    return np.asarray(np.sin(points @ directions + phases).sum(axis=1) / np.sqrt(waves / 2))


def with_skin(articulation: Articulation, skin: Labelled, character: str) -> Articulation:
    """Return the object with other faces and a note, without the parts that none of them shows.

    With them goes every carrier that is left without anything to carry.

    Raises:
        ValueError: a part that stays hangs on one that should go, or nothing would be left to move.
    """
    made = skin.articulation(articulation, character)
    seen = set(skin.part.tolist())
    gone = [i for i, part in enumerate(articulation.parts) if len(part.faces) and i not in seen]
    if not gone:
        return made
    leaving = set(gone)
    for joint in reversed(articulation.joints):
        children = {other.child for other in articulation.joints if other.parent == joint.child}
        if children and children <= leaving and joint.child not in seen:
            leaving.add(joint.child)
    kept = [index for index in range(len(articulation.parts)) if index not in leaving]
    number = {old: new for new, old in enumerate(kept)}
    joints = [joint for joint in articulation.joints if joint.child in number]
    lost = [articulation.parts[joint.parent].name for joint in joints if joint.parent not in number]
    if lost or 0 in leaving or not any(joint.movable for joint in joints):
        names = [articulation.parts[index].name for index in gone]
        raise ValueError(f"want to drop {names}, but the rest needs them")
    parts = tuple(made.parts[index] for index in kept)
    hung = tuple(replace(j, parent=number[j.parent], child=number[j.child]) for j in joints)
    return replace(made, parts=parts, joints=hung)
