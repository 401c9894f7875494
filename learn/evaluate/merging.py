"""An articulated object as a plain mesh: one surface that keeps no trace of its parts."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.articulation import Articulation, Part
from asset_factory.factory.geometry.clean import clean
from asset_factory.factory.geometry.posing import face_parts
from asset_factory.factory.geometry.soup import plain_soup


def merged(articulation: Articulation, rng: np.random.Generator) -> Articulation:
    """Return the same parts and joints over a mesh whose order, seams and looks hide the parts.

    Faces are shuffled, vertices are numbered as those faces use them and welded by position across
    parts, as for any mesh file that is read; materials, texture coordinates and normals are gone.
    Faces without area are too.

    Raises:
        InputRejected: no face has any area.
    """
    order = rng.permutation(len(articulation.mesh.faces))
    corners = articulation.mesh.vertices[articulation.mesh.faces[order]]
    cleaned = clean(plain_soup(corners), articulation.articulator)
    owner = face_parts(articulation)[order][cleaned.source_faces]
    parts = tuple(
        Part(part.name, np.flatnonzero(owner == i)) for i, part in enumerate(articulation.parts)
    )
    return Articulation(
        cleaned.mesh, parts, articulation.joints, articulation.articulator, articulation.notes
    )
