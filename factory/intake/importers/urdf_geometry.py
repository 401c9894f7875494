"""The ``<geometry>`` of a URDF visual as a mesh in its own frame."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np

from ...config import IntakeConfig
from ...errors import InputRejected
from ...mesh import Material, Mesh
from ..limits import require_at_most
from ..loading import Visual, load_visual
from . import primitives
from .xml_source import find_reference, numbers

#: The material of a shape that says nothing about its looks.
PLAIN = Material("default")
#: A mesh file with nothing to see costs its shape, not the whole object.
NOTHING_TO_SEE = ("empty", "zero_size")
#: Objects of a hundred mesh files would otherwise repeat themselves a hundred times.
FEW_NOTES = 3


class GeometryReader:
    """Reads shapes of one description, every mesh file once.

    Args:
        folder: everything lies in or below it.
        config: limits.
    """

    def __init__(self, folder: Path, config: IntakeConfig) -> None:
        self._folder = folder
        self._config = config
        self._bytes = 0
        self._visuals: dict[Path, Visual | None] = {}
        self._left_out: list[str] = []
        self._said: list[str] = []

    @property
    def notes(self) -> list[str]:
        """What was left out, one sentence each; of what the mesh files say only the first few."""
        more = len(self._said) - FEW_NOTES
        tail = [f"{more} more notes of this kind on other mesh files"] if more > 0 else []
        return [*self._left_out, *self._said[:FEW_NOTES], *tail]

    @property
    def digests(self) -> tuple[str, ...]:
        """SHA-256 of each mesh file with all that it refers to, in the order of first use."""
        return tuple(visual.digest for visual in self._visuals.values() if visual is not None)

    @property
    def licenses(self) -> tuple[str, ...]:
        """Return what the mesh files say of their licenses, each once."""
        said = (visual.license for visual in self._visuals.values() if visual is not None)
        return tuple(dict.fromkeys(license for license in said if license))

    @property
    def dropped_degenerate(self) -> int:
        """Return the faces without area that the mesh files had."""
        return sum(
            visual.dropped_degenerate for visual in self._visuals.values() if visual is not None
        )

    @property
    def dropped_non_finite(self) -> int:
        """Return the faces with a NaN or infinite corner that the mesh files had."""
        return sum(
            visual.dropped_non_finite for visual in self._visuals.values() if visual is not None
        )

    def read(self, shape: ET.Element, where: str) -> Mesh | None:
        """The geometry of a ``<visual>`` or ``<collision>`` [m]; ``None`` if nothing is visible.

        Raises:
            InputRejected: see :func:`find_reference`, and whatever is wrong with a mesh file.
        """
        geometry = shape.find("geometry")
        element = None if geometry is None or not len(geometry) else geometry[0]
        if element is None:
            self._left_out.append(f"{where}: a shape without geometry is left out")
            return None
        if element.tag == "mesh":
            return self._mesh(element, where)
        return _primitive(element, where)

    def _mesh(self, element: ET.Element, where: str) -> Mesh | None:
        path = find_reference(element.get("filename", ""), self._folder, where)
        scale = numbers(element.get("scale"), 3, (1.0, 1.0, 1.0), f"{where}: <mesh scale>")
        if not scale.all():
            raise InputRejected(
                "unreadable", f"{where}: <mesh scale> is {scale.tolist()}, want no zero"
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
            visual = load_visual(path, self._folder, self._config)
        except InputRejected as error:
            if error.code not in NOTHING_TO_SEE:
                raise
            self._left_out.append(
                f"{where}: {path.name} has nothing to see and is left out: {error.message}"
            )
            return None
        self._said += [f"{path.name}: {note}" for note in visual.notes]
        return visual


def _primitive(element: ET.Element, where: str) -> Mesh:
    def sizes(attribute: str, count: int) -> list[float]:
        said = f"{where}: <{element.tag} {attribute}>"
        values = numbers(element.get(attribute), count, (0.0,) * count, said)
        if not (values > 0.0).all():
            raise InputRejected(
                "unreadable", f"{said} is {element.get(attribute)!r}, want {count} positive numbers"
            )
        return [float(value) for value in values]

    def size(attribute: str) -> float:
        return sizes(attribute, 1)[0]

    if element.tag == "box":
        return primitives.box(sizes("size", 3), PLAIN)
    if element.tag == "sphere":
        return primitives.ellipsoid(sizes("radius", 1) * 3, PLAIN)
    if element.tag == "cylinder":
        return primitives.cylinder(size("radius"), size("length"), PLAIN)
    if element.tag == "capsule":
        return primitives.capsule(size("radius"), size("length"), PLAIN)
    raise InputRejected(
        "unreadable", f"{where}: <{element.tag}> is no geometry; want mesh, box, cylinder or sphere"
    )
