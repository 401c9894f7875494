"""The ``<geometry>`` of a URDF visual as a mesh in its own frame."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path

import numpy as np

from asset_factory.sim_checks.read.urdf_elements import LENIENT, UrdfGeometry

from ...config import IntakeConfig
from ...errors import InputRejected
from ...mesh import Material, Mesh
from ..limits import require_at_most
from ..loading import Visual, load_visual
from ..reads import ReadLog
from . import primitives
from .xml_source import find_reference

#: The material of a shape that says nothing about its looks.
PLAIN = Material("default")
#: A mesh file with nothing to see costs its shape, not the whole object.
NOTHING_TO_SEE = ("empty", "zero_size")
#: Objects of a hundred mesh files would otherwise repeat themselves a hundred times.
FEW_NOTES = 3
_PRIMITIVES: dict[str, Callable[..., Mesh]] = {
    "box": lambda *edges: primitives.box(edges, PLAIN),
    "sphere": lambda radius: primitives.ellipsoid([radius] * 3, PLAIN),
    "cylinder": lambda radius, length: primitives.cylinder(radius, length, PLAIN),
    "capsule": lambda radius, length: primitives.capsule(radius, length, PLAIN),
}


class GeometryReader:
    """Reads shapes of one description, every mesh file in or below its folder once."""

    def __init__(self, folder: Path, config: IntakeConfig, log: ReadLog) -> None:
        self._folder = folder
        self._log = log
        self._config = config
        self._bytes = 0
        self._visuals: dict[Path, Visual | None] = {}
        self._left_out: list[str] = []
        self._said: list[str] = []

    @property
    def notes(self) -> list[str]:
        """Return a sentence for each omission; of mesh files' notes only the first few."""
        more = len(self._said) - FEW_NOTES
        tail = [f"{more} more notes of this kind on other mesh files"] if more > 0 else []
        return [*self._left_out, *self._said[:FEW_NOTES], *tail]

    @property
    def visuals(self) -> tuple[Visual, ...]:
        """Return the content of each mesh file, in the order of first use."""
        return tuple(visual for visual in self._visuals.values() if visual is not None)

    def read(self, shape: ET.Element, where: str) -> Mesh | None:
        """Return what a ``<visual>`` or ``<collision>`` shows [m]; ``None`` if nothing.

        Raises:
            DescriptionError: its numbers cannot be read.
            InputRejected: see :func:`find_reference`, and whatever is wrong with a mesh file.
        """
        geometry = LENIENT.geometry(shape, where)
        if geometry is None:
            self._left_out.append(f"{where}: a shape without geometry is left out")
            return None
        if geometry.kind == "mesh":
            return self._mesh(geometry, where)
        return _PRIMITIVES[geometry.kind](*geometry.size)

    def _mesh(self, geometry: UrdfGeometry, where: str) -> Mesh | None:
        path = find_reference(geometry.file, self._folder, where, self._log)
        scale = geometry.scale
        if not scale.all():
            raise InputRejected(
                "unreadable", f"{where}: <mesh scale> must have no zero, not {scale.tolist()}"
            )
        if path not in self._visuals:
            self._visuals[path] = self._load(path, where)
        visual = self._visuals[path]
        if visual is None:
            return None
        return (
            visual.mesh if (scale == 1.0).all() else visual.mesh.transformed(np.diag([*scale, 1.0]))
        )

    def _load(self, path: Path, where: str) -> Visual | None:
        self._bytes += path.stat().st_size
        require_at_most("all mesh files together", self._bytes, self._config.max_bytes, "bytes")
        try:
            visual = load_visual(path, self._folder, self._config, self._log)
        except InputRejected as error:
            if error.code not in NOTHING_TO_SEE:
                raise
            self._left_out.append(
                f"{where}: {path.name} has nothing to see and is left out: {error.message}"
            )
            return None
        self._said += [f"{path.name}: {note}" for note in visual.notes]
        return visual
