"""Open shells and sheets without thickness, as game assets have them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .divided import facing
from .labelled import Labelled, some


def opened(mesh: Labelled, rng: np.random.Generator, share: float = 0.5) -> Labelled:
    """Pieces without the faces on one or two sides of their boxes: a box becomes five quads, or four."""
    sides = np.where(
        some(rng, mesh.piece_count, share)[:, None], rng.random((mesh.piece_count, 6)) < 0.25, False
    )
    return mesh.without(sides[mesh.piece, facing(mesh)])


def without_sides(mesh: Labelled, rng: np.random.Generator) -> Labelled:
    """The whole object without its back, its underside, or both: nobody looks there."""
    low, high = mesh.corners.min(axis=(0, 1)), mesh.corners.max(axis=(0, 1))
    margin = 0.01 * float((high - low).max())
    corners, side = mesh.corners, facing(mesh)
    back = (side == 4) & (corners[:, :, 1].min(axis=1) > high[1] - margin)
    under = (side == 2) & (corners[:, :, 2].max(axis=1) < low[2] + margin)
    which = int(rng.integers(3))
    return mesh.without((back & (which != 1)) | (under & (which != 0)))


def flattened(
    mesh: Labelled, rng: np.random.Generator, share: float = 0.4, thickest: float = 0.03
) -> Labelled:
    """Thin pieces as a single sheet, the larger side of the two; the edges in between are dropped.

    Args:
        mesh: any.
        rng: source of chance.
        share: of the thin pieces.
        thickest: of pieces that count as thin [m]; less for a small object.
    """
    low, high = mesh.boxes()
    extents = high - low
    thin = extents.argmin(axis=1)
    chosen = (extents.min(axis=1) < min(thickest, 0.06 * mesh.longest)) & (
        np.sort(extents, axis=1)[:, 1] > 3.0 * extents.min(axis=1)
    )
    chosen &= some(rng, mesh.piece_count, share)
    keep_upper = rng.random(mesh.piece_count) < 0.5
    # A front is seen from the front.
    keep_upper[thin == 1] = False
    side = facing(mesh)
    wanted = np.where(keep_upper, thin + 3, thin)[mesh.piece]
    return mesh.without(chosen[mesh.piece] & (side != wanted))


def doubled(mesh: Labelled, rng: np.random.Generator, share: float = 1.0) -> Labelled:
    """Every face a second time with its winding reversed; on the same vertices, or on others in the same places."""
    chosen = some(rng, mesh.piece_count, share)[mesh.piece]
    if not chosen.any():
        return mesh
    apart = len(mesh.vertices) if rng.random() < 0.5 else 0
    return replace(
        mesh,
        vertices=np.concatenate([mesh.vertices, mesh.vertices]) if apart else mesh.vertices,
        faces=np.concatenate([mesh.faces, mesh.faces[chosen][:, ::-1] + apart]),
        part=np.concatenate([mesh.part, mesh.part[chosen]]),
        piece=np.concatenate([mesh.piece, mesh.piece[chosen]]),
        material=np.concatenate([mesh.material, mesh.material[chosen]]),
    )


def flipped(mesh: Labelled, rng: np.random.Generator, share: float = 0.3) -> Labelled:
    """Pieces turned inside out."""
    chosen = some(rng, mesh.piece_count, share)[mesh.piece]
    return replace(mesh, faces=np.where(chosen[:, None], mesh.faces[:, ::-1], mesh.faces))
