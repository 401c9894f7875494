"""What a reader of descriptions returns: meshes posed by part, and joints, in the root frame."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...mesh import FloatArray, Mesh, concatenate
from ..annotation import AnnotatedJoint, Annotation


@dataclass(frozen=True)
class Imported:
    """A description with every joint at its zero.

    Attributes:
        pieces: part id and mesh, root frame [m], z up, in the order of the file.
        part_names: indexed by part id.
        joints: in the file's own frame and units.
        digests: SHA-256 of everything that was read, in the order of first use.
        notes: departures, one sentence each.
        source: ``urdf``, ``mjcf`` or ``usd``.
        licenses: as the mesh files state them, each once.
        dropped_degenerate, dropped_non_finite: faces that the mesh files had and ``pieces`` do not.
        frame: from the file's own frame to the root frame, shape [4, 4].
    """

    pieces: tuple[tuple[int, Mesh], ...]
    part_names: tuple[str, ...]
    joints: tuple[AnnotatedJoint, ...]
    digests: tuple[str, ...]
    notes: tuple[str, ...]
    source: str
    licenses: tuple[str, ...] = ()
    dropped_degenerate: int = 0
    dropped_non_finite: int = 0
    frame: FloatArray = field(default_factory=lambda: np.eye(4))

    @property
    def mesh(self) -> Mesh:
        """Return all pieces as one mesh; there is at least one."""
        return concatenate([mesh for _, mesh in self.pieces])

    @property
    def annotation(self) -> Annotation:
        """Return the parts of the faces of :attr:`mesh`, and the joints."""
        parts = [np.full(len(mesh.faces), part) for part, mesh in self.pieces]
        return Annotation(np.concatenate(parts), self.part_names, self.joints, self.source)


def rigid_groups(count: int, welds: list[tuple[int, int]]) -> list[int]:
    """Return for each of ``count`` parts the smallest id among the parts it is welded to."""
    group = list(range(count))
    for a, b in welds:
        low, high = sorted((group[a], group[b]))
        if low != high:
            group = [low if g == high else g for g in group]
    return group


def fixed(name: str, parent: int, child: int) -> AnnotatedJoint:
    """Return a joint that holds one part to another."""
    up = np.array([0.0, 0.0, 1.0])
    return AnnotatedJoint(name, "fixed", parent, child, up, np.zeros(3), None, None)
