"""Skins as today's image-to-3D tools give them: fine, simplified, with seams engraved."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from asset_factory.factory.articulation import Articulation
from asset_factory.factory.geometry.components import connected_components
from asset_factory.factory.intake.images import encode_png
from asset_factory.factory.mesh import FloatArray, IntArray, Material, Mesh, Texture
from asset_factory.factory.views.view import painted

from .fused import NOBODY, skin, with_skin
from .labelled import Labelled

#: Cells along the longest side, lowest and highest; drawn evenly by their logarithm.
CELLS = (96, 256)
#: Points in a cell that the surface passes; fewer leave holes, through which the outside gets in.
DENSITY = 5.0
MOST_POINTS = 900_000
#: How far the skin lies outside the surface, in cells.
REACH = (0.3, 0.6)
#: Share of skins whose seams are engraved, and how deep [cells]; those of the others are as wide as
#: the object's own gaps, which mostly close.
ENGRAVED = 0.75
DEPTHS = (1, 2)
#: Share of skins that are simplified, and to how many faces.
SIMPLIFIED = 0.75
FACES = (6_000, 60_000)


def skin_like(
    articulation: Articulation, seed: int, cells: int | None = None, engraved: float = ENGRAVED
) -> Articulation:
    """Return one closed skin around the whole object, as large generative models give it.

    Parts and joints are the same, but for parts that nothing is seen of. ``cells`` are along the
    longest side, drawn by default; ``engraved`` is how likely the seams are engraved.

    Raises:
        ValueError: what would be left out holds something that is seen, or is all that moves.
    """
    rng = np.random.default_rng([seed, 0x5C1])
    original = Labelled.of(articulation)
    vertices, faces, below, _ = _skinned(original, rng, cells, engraved)
    skin = Labelled(vertices, faces, original.label[below])
    return with_skin(articulation, skin, "a skin of one piece")


def coloured_skin(mesh: Mesh, seed: int) -> Mesh:
    """Return one closed skin around a mesh, in its bounding box and under its colours.

    Seams between the mesh's own pieces are engraved as :func:`skin_like` engraves those of parts.
    """
    rng = np.random.default_rng([seed, 0xC01])
    piece = connected_components(mesh) % NOBODY
    label = np.stack([piece, piece, mesh.face_material], axis=1)
    original = Labelled(mesh.vertices, mesh.faces, label)
    vertices, faces, below, weights = _skinned(original, rng, None, ENGRAVED)
    low = vertices.min(axis=0)
    share = (vertices - low) / (vertices.max(axis=0) - low)
    placed = mesh.vertices.min(axis=0) + share * mesh.extents
    return _coloured(placed, faces, painted(mesh, below, weights))


def _coloured(vertices: FloatArray, faces: IntArray, colors: FloatArray) -> Mesh:
    """Return a mesh whose texture holds a pixel for each face, by colours (sRGB) in [0, 1]."""
    from PIL import Image

    side = int(np.ceil(np.sqrt(len(faces))))
    pixels = np.zeros((side * side, 3), np.uint8)
    pixels[: len(faces)] = np.rint(255.0 * colors)
    image = encode_png(Image.fromarray(pixels.reshape(side, side, 3)))
    row, column = np.divmod(np.arange(len(faces)), side)
    middle = np.stack([(column + 0.5) / side, 1.0 - (row + 0.5) / side], axis=1)
    uv = np.broadcast_to(middle[:, None], (len(faces), 3, 2))
    material = Material("skin", (1.0, 1.0, 1.0, 1.0), Texture(image, ".png"))
    return Mesh(vertices, faces, uv, None, np.zeros(len(faces), np.int64), (material,))


def _skinned(
    original: Labelled, rng: np.random.Generator, cells: int | None, engraved: float
) -> tuple[FloatArray, IntArray, IntArray, FloatArray]:
    """Return vertices [m] and faces; the original face that each shows, and where in it."""
    finest = float(np.exp(rng.uniform(*np.log(CELLS))))
    chosen = round(finest) if cells is None else cells
    area = float(original.areas.sum())
    wanted = DENSITY * area / (original.longest / chosen) ** 2
    count = int(min(wanted, MOST_POINTS))
    # A thick crowd of parts has more surface than points can cover at that fineness.
    chosen = int(chosen * np.sqrt(count / wanted))
    shares = (np.arange(count) + rng.random(count)) / count
    points, below, weights = original.sampled(shares, rng)
    groove = int(rng.integers(DEPTHS[0], DEPTHS[1] + 1)) if rng.random() < engraved else 0
    bumps = float(rng.choice([0.0, 0.1, 0.3]))
    reach = float(rng.uniform(*REACH))
    owner = original.part[below]
    vertices, faces, nearest = skin(points, owner, chosen, reach, rng, groove=groove, bumps=bumps)
    if rng.random() < SIMPLIFIED:
        most = int(np.exp(rng.uniform(*np.log(FACES))))
        vertices, faces, nearest = _simplified(vertices, faces, nearest, most)
    return vertices, faces, below[nearest], weights[nearest]


def _simplified(
    vertices: FloatArray, faces: IntArray, shown: IntArray, most: int
) -> tuple[FloatArray, IntArray, IntArray]:
    """Simplify to about ``most`` faces; each shows what the face nearest to its middle did."""
    if len(faces) <= most:
        return vertices, faces, shown
    import fast_simplification

    rough = vertices.astype(np.float32), faces.astype(np.int32)
    fewer, kept = fast_simplification.simplify(*rough, target_count=most)
    kept = np.asarray(kept, dtype=np.int64)
    fewer = np.asarray(fewer, dtype=np.float64)
    before = vertices[faces].mean(axis=1)
    _, nearest = cKDTree(before).query(fewer[kept].mean(axis=1))
    return fewer, kept, shown[nearest]
