"""How a mesh was made: by a modeller, or by an image-to-3D tool."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.components import connected_components
from ..mesh import Mesh
from ..models.particulate.surface import Surface

#: One piece is one surface, or one with so much of the area and crumbs of at most so much.
LARGEST = 0.9
CRUMB = 0.05


@dataclass(frozen=True)
class MeshOrigin:
    """How a mesh was made.

    Attributes:
        one_piece: whether it is one surface, but for crumbs.
        reconstructed: whether that bends a little everywhere, as no modeller has it.
    """

    one_piece: bool
    reconstructed: bool

    @classmethod
    def of(cls, mesh: Mesh) -> MeshOrigin:
        """Tell how any mesh was made."""
        surface = Surface.of(mesh.vertices, mesh.faces)
        areas = np.bincount(connected_components(mesh), weights=surface.areas)
        whole = float(areas.sum())
        if not whole > 0.0:
            return cls(one_piece=False, reconstructed=False)
        areas = np.sort(areas)
        alone = areas[-1] >= LARGEST * whole and (areas[:-1] <= CRUMB * whole).all()
        return cls(bool(alone), surface.reconstructed)

    @property
    def is_shell(self) -> bool:
        """Return whether its pieces do not say where parts end, so that seams must."""
        return self.one_piece or self.reconstructed

    @property
    def is_generated(self) -> bool:
        """Return whether it is what image-to-3D tools give: network and rules see rubbish in it."""
        return self.one_piece and self.reconstructed
