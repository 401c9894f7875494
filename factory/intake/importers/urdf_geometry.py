"""The ``<geometry>`` of a URDF visual as a mesh in its own frame, and its ``<material>``."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import numpy as np

from asset_factory.sim_checks.read.urdf import PRIMITIVES
from asset_factory.sim_checks.read.urdf_elements import LENIENT, UrdfGeometry

from ...config import IntakeConfig
from ...errors import InputRejected
from ...mesh import Material, Mesh, Texture
from ..files import InputFiles
from ..images import load_texture
from ..limits import require_at_most
from ..loading import Visual, load_visual
from ..reads import ReadLog
from .xml_source import find_reference

#: The material of a shape that says nothing about its looks.
PLAIN = Material("default")
#: A mesh file with nothing to see costs its shape, not the whole object.
NOTHING_TO_SEE = ("empty", "zero_size")
#: Objects of a hundred mesh files would otherwise repeat themselves a hundred times.
FEW_NOTES = 3


class ShapeReader:
    """Reads shapes of one description, every mesh and texture in or below its folder once."""

    def __init__(self, robot: ET.Element, folder: Path, config: IntakeConfig, log: ReadLog) -> None:
        self._folder = folder
        self._log = log
        self._config = config
        self._bytes = 0
        self._visuals: dict[Path, Visual | None] = {}
        self._left_out: list[str] = []
        self._said: list[str] = []
        self._files = InputFiles(folder, config, log)
        self._textures: dict[Path, Texture | None] = {}
        self._materials = {each.get("name", ""): each for each in robot.findall("material")}
        # A local definition may be referred to by name further down the file, as ROS's parser
        # allows.
        for element in robot.iterfind("link/visual/material"):
            if len(element):
                self._materials.setdefault(element.get("name", ""), element)

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

    @property
    def digests(self) -> tuple[str, ...]:
        """Return the SHA-256 of each mesh file, and of all textures, in the order of first use."""
        return (*(visual.digest for visual in self.visuals), self._files.digest)

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
        return Mesh.from_triangles(*PRIMITIVES[geometry.kind](*geometry.size), PLAIN)

    def _mesh(self, geometry: UrdfGeometry, where: str) -> Mesh | None:
        path = find_reference(geometry.file, self._folder, where, self._log)
        scale = geometry.scale
        if not scale.all():
            why = f"<mesh scale> must have no zero, not {scale.tolist()}"
            raise InputRejected("unreadable", f"{where}: {why}")
        if path not in self._visuals:
            self._visuals[path] = self._load(path, where)
        visual = self._visuals[path]
        if visual is None:
            return None
        mesh = visual.mesh
        return mesh if (scale == 1.0).all() else mesh.transformed(np.diag([*scale, 1.0]))

    def _load(self, path: Path, where: str) -> Visual | None:
        self._bytes += path.stat().st_size
        require_at_most("all mesh files together", self._bytes, self._config.max_bytes, "bytes")
        try:
            visual = load_visual(path, self._folder, self._config, self._log)
        except InputRejected as error:
            if error.code not in NOTHING_TO_SEE:
                raise
            nothing = f"{path.name} has nothing to see and is left out"
            self._left_out.append(f"{where}: {nothing}: {error.message}")
            return None
        self._said += [f"{path.name}: {note}" for note in visual.notes]
        return visual

    def painted(self, mesh: Mesh, shape: ET.Element, where: str) -> Mesh:
        """Return a mesh in the colours of its shape's ``<material>``, unless its file has some."""
        says_itself = len(mesh.materials) > 1 or not is_plain(mesh.materials[0])
        material = None if says_itself else self._material(shape, where)
        if material is None:
            return mesh
        if mesh.corner_uv is None:
            material = replace(material, texture=None)
        return replace(mesh, materials=(material,))

    def _material(self, shape: ET.Element, where: str) -> Material | None:
        """Return what a shape's ``<material>`` says; ``None`` if none, or an undefined one."""
        element = shape.find("material")
        if element is None:
            return None
        name = element.get("name", "")
        if not len(element):
            element = self._materials.get(name, element)
        color = element.find("color")
        texture = element.find("texture")
        if color is None and texture is None:
            return None
        rgba = np.ones(4)
        if color is not None:
            rgba = LENIENT.vector(color, "rgba", where, "1 1 1 1", count=4)
        red, green, blue, alpha = np.clip(rgba, 0.0, 1.0).tolist()
        image = None if texture is None else self._texture(texture.get("filename", ""), where)
        return Material(name or "material", (red, green, blue, alpha), image)

    def _texture(self, reference: str, where: str) -> Texture | None:
        if not reference:
            return None
        path = find_reference(reference, self._folder, where, self._log)
        if path not in self._textures:
            self._textures[path] = load_texture(self._files.read(path), path.name, self._files)
        return self._textures[path]


def is_plain(material: Material) -> bool:
    """Return whether a mesh file left the looks open: the default colour and no image."""
    return material.texture is None and material.color == Material("default").color
