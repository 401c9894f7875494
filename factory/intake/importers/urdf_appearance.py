"""The ``<material>`` of a URDF visual: global ones by name, local ones in place."""

import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import numpy as np

from asset_factory.sim_checks.read.urdf_elements import LENIENT

from ...config import IntakeConfig
from ...mesh import Material, Mesh, Texture
from ..files import InputFiles
from ..images import load_texture
from ..reads import ReadLog
from .xml_source import find_reference


class Palette:
    """The materials that a file defines for all its links."""

    def __init__(self, robot: ET.Element, folder: Path, config: IntakeConfig, log: ReadLog) -> None:
        self._folder = folder
        self._files = InputFiles(folder, config, log)
        self._global = {element.get("name", ""): element for element in robot.findall("material")}
        # A local definition may be referred to by name further down the file, as ROS's parser
        # allows.
        for element in robot.iterfind("link/visual/material"):
            if len(element):
                self._global.setdefault(element.get("name", ""), element)
        self._textures: dict[Path, Texture | None] = {}

    @property
    def digest(self) -> str:
        """Return the SHA-256 of the textures read so far, in the order of first use."""
        return self._files.digest

    def material(self, shape: ET.Element, where: str) -> Material | None:
        """Return what a shape's ``<material>`` says; ``None`` if none, or an undefined one."""
        element = shape.find("material")
        if element is None:
            return None
        name = element.get("name", "")
        if not len(element):
            element = self._global.get(name, element)
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
        path = find_reference(reference, self._folder, where, self._files.log)
        if path not in self._textures:
            self._textures[path] = load_texture(self._files.read(path), path.name, self._files)
        return self._textures[path]


def painted(mesh: Mesh, shape: ET.Element, palette: Palette, where: str) -> Mesh:
    """Return a mesh in the colours of its shape's ``<material>``, unless its file has its own."""
    says_itself = (
        len(mesh.materials) > 1
        or mesh.materials[0].texture is not None
        or not is_plain(mesh.materials[0])
    )
    material = None if says_itself else palette.material(shape, where)
    if material is None:
        return mesh
    if mesh.corner_uv is None:
        material = replace(material, texture=None)
    return replace(mesh, materials=(material,))


def is_plain(material: Material) -> bool:
    """Return whether a mesh file left the looks open: the default colour and no image."""
    return material.texture is None and material.color == Material("default").color
