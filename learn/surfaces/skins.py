"""Skins as today's image-to-3D tools give them: fine, simplified, with seams engraved."""

import numpy as np
from scipy.spatial import cKDTree

from asset_factory.factory.articulation import Articulation

from .fused import skin, without_parts
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

    Args:
        articulation: any with a surface.
        seed: of everything that varies.
        cells: along the longest side; drawn by default.
        engraved: how likely its seams are engraved.

    Returns:
        The same parts and joints over the skin of the outside, but for parts that nothing is seen
        of.

    Raises:
        ValueError: what would have to be left out holds something that is seen, or is all that
            moves.
    """
    rng = np.random.default_rng([seed, 0x5C1])
    original = Labelled.of(articulation)
    finest = float(np.exp(rng.uniform(*np.log(CELLS))))
    chosen = round(finest) if cells is None else cells
    area = float(original.areas.sum())
    wanted = DENSITY * area / (original.longest / chosen) ** 2
    count = int(min(wanted, MOST_POINTS))
    # A thick crowd of parts has more surface than points can cover at that fineness.
    chosen = int(chosen * np.sqrt(count / wanted))

    shares = (np.arange(count) + rng.random(count)) / count
    points, below = original.sampled(shares, rng)
    groove = int(rng.integers(DEPTHS[0], DEPTHS[1] + 1)) if rng.random() < engraved else 0
    bumps = float(rng.choice([0.0, 0.1, 0.3]))
    vertices, faces, nearest = skin(
        points,
        original.part[below],
        chosen,
        float(rng.uniform(*REACH)),
        rng,
        groove=groove,
        bumps=bumps,
    )
    label = original.label[below[nearest]]
    if rng.random() < SIMPLIFIED:
        most = int(np.exp(rng.uniform(*np.log(FACES))))
        vertices, faces, label = _simplified(vertices, faces, label, most)

    hidden = set(np.setdiff1d(original.part, label[:, 0]).tolist())
    made = Labelled(vertices, faces, label).articulation(articulation, "a skin of one piece")
    return without_parts(made, hidden) if hidden else made


def _simplified(
    vertices: np.ndarray, faces: np.ndarray, label: np.ndarray, most: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Simplify to about ``most`` faces, each labelled as the face nearest to its middle."""
    if len(faces) <= most:
        return vertices, faces, label
    import fast_simplification

    fewer, kept = fast_simplification.simplify(
        np.asarray(vertices, dtype=np.float32), np.asarray(faces, dtype=np.int32), target_count=most
    )
    kept = np.asarray(kept, dtype=np.int64)
    fewer = np.asarray(fewer, dtype=np.float64)
    before = vertices[faces].mean(axis=1)
    _, nearest = cKDTree(before).query(fewer[kept].mean(axis=1))
    return fewer, kept, label[nearest]
