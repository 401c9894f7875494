"""An object as an image-to-3D tool would give it: one watertight, bumpy skin, gaps fused, inside lost."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ...articulation import Articulation, Part
from ...mesh import FloatArray, IntArray, Material, Mesh, Texture
from .contour import contour
from .looks import png
from .seams import cut_along_labels

#: Half of the widest gap that is fused; the skin lies this far outside the original [m].
FUSE_M = 0.0025
#: Standard deviation of the bumps [m].
BUMP_M = 0.0006
#: Field values are kept in steps of this [m]: a last bit of rounding must not change the triangles.
FIELD_STEP_M = 2.0**-24
MAX_FACES = 12000
#: The grid goes beyond the object by, and the field is known up to, this many cells.
MARGIN_CELLS, REACH_CELLS = 5.0, 4.0


def generated_like(articulation: Articulation, seed: int, resolution: int = 160) -> Articulation:
    """One closed surface around the whole object, with the original's parts and joints as labels.

    Args:
        articulation: made of closed convex solids, e.g. by ``make_object``.
        seed: of the bumps.
        resolution: cells along the longest side of the bounding box.

    Returns:
        An articulation over a single-component, watertight mesh of at most about ``MAX_FACES``
        faces (before seams are cut), coloured by a palette texture; joints are unchanged, and each
        face belongs to the part that is nearest.

    Raises:
        ValueError: ``resolution`` is too coarse: some part got no face.
    """
    solids = _solids(articulation)
    low, cell, field = _field(articulation, solids, seed, resolution)
    vertices, faces = contour(field, low, cell)
    vertices, faces = _decimated(vertices, faces, cell)
    groups = [[s for s in solids if s.part == i] for i in range(len(articulation.parts))]

    def distances(points: FloatArray) -> FloatArray:
        return np.stack([_distance(points, group) for group in groups], axis=1)

    vertices, faces, label = cut_along_labels(vertices, faces, distances)
    missing = [part.name for i, part in enumerate(articulation.parts) if not (label == i).any()]
    if missing:
        raise ValueError(
            f"generated_like: no face for {missing} at resolution {resolution}, want a finer one"
        )
    mesh = _coloured(vertices, faces, articulation, solids)
    parts = tuple(
        Part(part.name, np.flatnonzero(label == i)) for i, part in enumerate(articulation.parts)
    )
    return Articulation(
        mesh, parts, articulation.joints, "procedural", ("fused as by an image-to-3D tool",)
    )


@dataclass(frozen=True)
class _Solid:
    """A convex solid: its part, its material, its box [m], its planes (unit normal, offset), shape [plane_count, 4]."""

    part: int
    material: int
    low: FloatArray
    high: FloatArray
    planes: FloatArray


def _solids(articulation: Articulation) -> list[_Solid]:
    mesh = articulation.mesh
    edges = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]]])
    graph = coo_matrix((np.ones(len(edges)), edges.T), shape=(len(mesh.vertices),) * 2)
    component = connected_components(graph, directed=False)[1][mesh.faces[:, 0]]
    owner = np.zeros(len(mesh.faces), dtype=np.int64)
    for index, part in enumerate(articulation.parts):
        owner[part.faces] = index
    solids: list[_Solid] = []
    for value in np.unique(component):
        chosen = np.flatnonzero(component == value)
        corners = mesh.vertices[mesh.faces[chosen]]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        planes = np.column_stack([normal, np.einsum("ij,ij->i", normal, corners[:, 0])])
        planes = planes[np.unique(np.round(planes, 6), axis=0, return_index=True)[1]]
        low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
        solids.append(
            _Solid(int(owner[chosen[0]]), int(mesh.face_material[chosen[0]]), low, high, planes)
        )
    return solids


def _distance(points: FloatArray, solids: list[_Solid]) -> FloatArray:
    """Euclidean distance to a union of boxes and upright prisms, negative inside [m], shape [point_count].

    A looser distance would tie along edges, and seams between flush parts would follow every bump.
    """
    best = np.full(len(points), np.inf)
    for solid in solids:
        np.minimum(best, _distance_to(points, solid.planes), out=best)
    return best


def _distance_to(points: FloatArray, planes: FloatArray) -> FloatArray:
    above = points @ planes[:, :3].T - planes[:, 3]
    straight = np.abs(planes[:, :3]).argmax(axis=1)
    oblique = np.abs(planes[:, :3]).max(axis=1) < 1.0 - 1e-9
    sweep = int(np.abs(planes[oblique, :3]).sum(axis=0).argmin()) if oblique.any() else 0
    axial = [
        above[:, ~oblique & (straight == axis)].max(axis=1, initial=-np.inf) for axis in range(3)
    ]
    first, second = (np.maximum(axial[(sweep + i) % 3], 0.0) for i in (1, 2))
    across = np.maximum(np.hypot(first, second), above[:, oblique].max(axis=1, initial=0.0))
    outside = np.hypot(np.maximum(axial[sweep], 0.0), across)
    return np.asarray(np.where(outside > 0.0, outside, above.max(axis=1)))


def _field(
    articulation: Articulation, solids: list[_Solid], seed: int, resolution: int
) -> tuple[FloatArray, float, FloatArray]:
    """Lowest corner [m], cell size [m], and signed distance to the skin at the corners of a grid [m]."""
    bounds = articulation.mesh.bounds
    cell = float((bounds[1] - bounds[0]).max()) / resolution
    low = bounds[0] - MARGIN_CELLS * cell
    shape = np.ceil((bounds[1] + MARGIN_CELLS * cell - low) / cell).astype(int) + 1
    axes = [low[i] + cell * np.arange(shape[i]) for i in range(3)]
    field = np.full(shape, REACH_CELLS * cell)
    for solid in solids:
        _carve(field, axes, solid, REACH_CELLS * cell)
    inside = ndimage.binary_fill_holes(field < 0.0)
    field = np.where(inside & (field > 0.0), -cell, field)
    field = ndimage.gaussian_filter(np.maximum(field, -REACH_CELLS * cell), 0.5)
    near = np.argwhere(np.abs(field) < (REACH_CELLS - 1.0) * cell)
    field[tuple(near.T)] += _bumps(low + cell * near, np.random.default_rng(seed))
    return low, cell, np.round(field / FIELD_STEP_M) * FIELD_STEP_M


def _carve(field: FloatArray, axes: list[FloatArray], solid: _Solid, reach: float) -> None:
    """Lower the field to the distance from one solid's skin, in place, as far as it reaches."""
    box = tuple(
        slice(
            int(np.searchsorted(axes[i], solid.low[i] - reach)),
            int(np.searchsorted(axes[i], solid.high[i] + reach)),
        )
        for i in range(3)
    )
    x, y, z = np.ix_(*(axes[i][box[i]] for i in range(3)))
    distance = np.full(field[box].shape, -np.inf)
    for plane in solid.planes:
        np.maximum(distance, plane[0] * x + plane[1] * y + plane[2] * z - plane[3], out=distance)
    np.minimum(field[box], distance - FUSE_M, out=field[box])


def _bumps(points: FloatArray, rng: np.random.Generator, waves: int = 10) -> FloatArray:
    """Smooth noise [m], shape [point_count]: plane waves of 6 to 25 cm."""
    directions = rng.normal(size=(waves, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    numbers = 2.0 * np.pi / rng.uniform(0.06, 0.25, waves)
    phases = rng.uniform(0.0, 2.0 * np.pi, waves)
    total = np.zeros(len(points))
    for direction, number, phase in zip(directions, numbers, phases, strict=True):
        total += np.sin(points @ (direction * number) + phase)
    return np.asarray(BUMP_M * total / np.sqrt(waves / 2.0))


def _decimated(vertices: FloatArray, faces: IntArray, cell: float) -> tuple[FloatArray, IntArray]:
    """The largest body, simplified to at most MAX_FACES triangles, still a manifold."""
    import manifold3d

    body = manifold3d.Manifold(manifold3d.Mesh64(vertices, faces.astype(np.uint64)))
    if body.status() != manifold3d.Error.NoError:
        raise ValueError(f"generated_like: the contour is no manifold: {body.status()}")
    tolerance = 0.02 * cell
    body = max(body.simplify(tolerance).decompose(), key=lambda piece: piece.volume())
    while body.num_tri() > MAX_FACES:
        body = body.simplify(tolerance)
        tolerance *= 1.3
    mesh = body.to_mesh64()
    return np.array(mesh.vert_properties[:, :3]), np.array(mesh.tri_verts, dtype=np.int64)


def _coloured(
    vertices: FloatArray, faces: IntArray, articulation: Articulation, solids: list[_Solid]
) -> Mesh:
    """Every face takes the colour of the nearest solid, through a palette image."""
    materials = articulation.mesh.materials
    centers = vertices[faces].mean(axis=1)
    distance = np.stack(
        [_distance(centers, [s for s in solids if s.material == i]) for i in range(len(materials))]
    )
    nearest = distance.argmin(axis=0)
    colors = np.array([(0.5, 0.36, 0.22) if m.texture else m.color[:3] for m in materials])
    srgb = np.round(255.0 * np.clip(colors, 0.0, 1.0) ** (1.0 / 2.2)).astype(np.uint8)
    image = np.repeat(srgb[None], 2, axis=0)
    uv = np.stack([(nearest + 0.5) / len(materials), np.full(len(faces), 0.5)], axis=1)
    palette = Material("baked", (1.0, 1.0, 1.0, 1.0), Texture(png(image), ".png"))
    return Mesh(
        vertices=vertices,
        faces=faces,
        corner_uv=np.repeat(uv[:, None], 3, axis=1),
        corner_normals=None,
        face_material=np.zeros(len(faces), dtype=np.int64),
        materials=(palette,),
    )
