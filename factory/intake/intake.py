"""What intake hands on: a mesh, and everything that was assumed or changed on the way."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..mesh import FloatArray, IntArray, Mesh, read_only
from .annotation import Annotation
from .stated import Stated


@dataclass(frozen=True)
class Provenance:
    """A mesh's origin and the changes to it; ends in the manifest.

    Attributes:
        input: file name of the input (not its path).
        digest: SHA-256 over the input file and the files it refers to.
        category: of the object, e.g. ``fridge``; ``None`` if unknown.
        up: the input's up axis, e.g. ``y``.
        up_source: who said so: ``option``, ``sidecar``, ``format``, ``default``; ``sides``: only
            so do they show what opens.
        scale: factor from input units to metres.
        scale_source: ``option``, ``sidecar``, ``category``, ``format``, ``guess`` (no category) or
            ``as_is``.
        density: [kg/m3] from the sidecar, else ``None``.
        license: from the sidecar or the file, else ``None``.
        dropped_degenerate: faces without area that were dropped.
        dropped_non_finite: faces with a NaN or infinite corner that were dropped.
        notes: assumptions, one sentence each.
    """

    input: str
    digest: str
    category: str | None = None
    up: str = "z"
    up_source: str = "default"
    scale: float = 1.0
    scale_source: str = "as_is"
    density: float | None = None
    license: str | None = None
    dropped_degenerate: int = 0
    dropped_non_finite: int = 0
    notes: tuple[str, ...] = field(default=())


@dataclass(frozen=True)
class Intake:
    """A loaded input.

    Attributes:
        name: safe file stem, e.g. ``kitchen_cabinet``.
        mesh: metres, z up.
        source_faces: for each face of ``mesh`` its index in the input's own face order, shape
            [face_count].
        transform: input frame to object frame (rotation and uniform scale), shape [4, 4].
        provenance: see :class:`Provenance`.
        annotation: parts and joints that came with the input, in the input's frame; ``None`` for a
            plain mesh.
        annotation_path: an annotation file named by the sidecar, not yet understood.
        annotation_data: its content, as it was when the rest was read; ``None``: it is read when it
            is wanted.
        stated: which parts open, said by somebody beside the mesh; ``None`` if nobody did.
    """

    name: str
    mesh: Mesh
    source_faces: IntArray
    transform: FloatArray
    provenance: Provenance
    annotation: Annotation | None = None
    annotation_path: Path | None = None
    annotation_data: bytes | None = None
    stated: Stated | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "source_faces", read_only(self.source_faces, np.int64))
        object.__setattr__(self, "transform", read_only(self.transform))
